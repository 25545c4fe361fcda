//! `toile doctor`: checks this machine, and names the exact cure for each missing part.

mod cameras;
mod check;
mod processor;
mod rights;
mod surroundings;

use std::path::{Path, PathBuf};
use toile_assets::put_line;

use serde::Serialize;
use toile_cli::document::Document;
use toile_cli::exit::AppError;
use toile_cli::terminal::{self, Paint, Tone};

/// Report what this machine has, and the exact cure for what is missing.
#[derive(Debug, Clone, PartialEq, clap::Args)]
#[command(after_help = "Example: see why a kiosk misses its deadline\n  toile doctor")]
pub struct DoctorArgs {
    /// Output folder whose writing is tried
    #[arg(long, value_name = "DIR", default_value = "out")]
    pub out: PathBuf,
    /// Print one JSON object, and nothing else, on stdout
    #[arg(long)]
    pub json: bool,
}

pub use check::{Check, Status};
pub(crate) use rights::may_lock_all;

/// The body of `toile doctor --json`.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct DoctorReport {
    /// Everything that was looked at.
    pub checks: Vec<Check>,
    /// The GPU adapters, where GPU support is built in.
    pub adapters: Vec<AdapterReport>,
    /// Whether GPU support is built in.
    pub gpu_built_in: bool,
    /// Whether `toile try-on` can run here: of all checks, the output folder alone decides that.
    pub ready: bool,
}

/// One GPU adapter.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct AdapterReport {
    /// The device's own name.
    pub name: String,
    /// The interface it is reached by.
    pub backend: String,
    /// `discrete`, `integrated`, `virtual`, `software` or `other`.
    pub kind: &'static str,
    /// The driver's name and version.
    pub driver: String,
}

/// Runs `toile doctor`.
///
/// # Errors
/// Only where stdout cannot be written: what is missing is a finding, not an error.
pub fn run(args: &DoctorArgs) -> Result<(), AppError> {
    let document = Document::new("doctor", examine(&args.out));
    if args.json {
        terminal::print_json(&document)
    } else {
        terminal::print(&table(&document.body, Paint::for_stdout()))
    }
}

fn examine(out: &Path) -> DoctorReport {
    let adapters = toile_gpu::adapters();
    let folder = surroundings::output_folder(out);
    let ready = folder.status == Status::Ok;
    let checks = vec![
        processor::cpu(),
        processor::cores(),
        processor::lanes(),
        processor::memory(),
        processor::governor(),
        processor::clock_source(),
        processor::clock_cost(),
        rights::priority(),
        rights::placement(),
        rights::locked_memory(),
        rights::kernel(),
        surroundings::gpu(&adapters),
        surroundings::display(),
        folder,
        surroundings::ffmpeg(),
    ];
    let checks: Vec<Check> = checks
        .into_iter()
        .chain(cameras::cameras())
        .chain([cameras::webcams(), cameras::pose_network(), cameras::face_network()])
        .collect();
    let adapters = adapters.into_iter();
    let adapters =
        adapters.map(|a| AdapterReport { name: a.name, backend: a.backend, kind: a.kind, driver: a.driver }).collect();
    DoctorReport { checks, adapters, gpu_built_in: toile_gpu::BUILT_IN, ready }
}

fn table(report: &DoctorReport, paint: Paint) -> String {
    let width = report.checks.iter().map(|c| c.name.len()).max().unwrap_or(0);
    let mut text = String::new();
    for check in &report.checks {
        let (word, tone) = match check.status {
            Status::Ok => ("ok     ", Tone::Good),
            Status::Missing => ("missing", Tone::Warn),
            Status::Unknown => ("unknown", Tone::Strong),
        };
        put_line!(text, "{}  {:width$}  {}", paint.tone(word, tone), check.name, check.found);
        if let Some(cure) = &check.cure {
            put_line!(text, "         {:width$}  for {}: {cure}", "", check.needed_for);
        }
    }
    let missing = report.checks.iter().filter(|c| c.status == Status::Missing).count();
    let ready = if report.ready { "`toile try-on` can run here" } else { "`toile try-on` cannot run here yet" };
    put_line!(text, "\n{ready}; missing: {missing}.");
    text
}

#[cfg(test)]
mod tests {
    use super::check::field;
    use super::*;

    #[test]
    fn what_is_missing_has_a_cure_and_what_is_ok_needs_none() {
        for check in examine(&std::env::temp_dir().join("toile-doctor")).checks {
            assert_eq!(check.status == Status::Missing, check.cure.is_some(), "{check:?}");
            assert!(!check.found.is_empty() && !check.found.contains('\n'), "{check:?}");
        }
    }

    #[test]
    fn table_shows_the_cure_below_the_finding() {
        let checks = vec![Check::ok("a", "x", "fine"), Check::missing("bb", "kiosks", "none", "do this")];
        let report = DoctorReport { checks, adapters: Vec::new(), gpu_built_in: false, ready: true };
        let text = table(&report, Paint::none());
        assert!(text.starts_with("ok       a   fine\nmissing  bb  none\n             for kiosks: do this\n"), "{text}");
        assert!(text.ends_with("can run here; missing: 1.\n"), "{text}");
    }

    #[test]
    fn field_reads_the_whole_key() {
        assert_eq!(field("CapEffX:\t1\nCapEff:\t2\n", "CapEff"), Some("2"));
    }
}
