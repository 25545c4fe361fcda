//! `toile bench skinning`: a body skinned by linear blending and by dual quaternions.

use toile_cli::arguments::count;
use toile_cli::document::Document;
use toile_cli::exit::AppError;
use toile_cli::terminal::{self, Paint, Words};
use toile_engine::lanes::Width;
use toile_engine::skin::Blend;
use toile_fitting::scene::reference_time;
use toile_perf::skinning::{self, SkinningError, SkinningOptions, SkinningSubject};

use super::skinning_report::{self, SkinningReport};
use crate::commands::arguments::lanes;

/// Most vertices: 4 million, about 1 GB of arrays.
const MAX_VERTS: u64 = 1 << 22;

/// Time the skinning of a body, linear and dual quaternions, against a plain loop and with its error.
///
/// Skins a surface by linear blending and by dual quaternions, positions and unit normals, and reports the time of each, its
/// ratio to a plain scalar loop timed in turn with it, and its largest error against f64. Without --body every vertex has
/// four influences; with it they are those of the shopper's body.
#[derive(Debug, Clone, PartialEq, clap::Args)]
#[command(
    after_help = "Example: the cost of dual quaternions on two threads\n  toile bench skinning --dual --threads 2"
)]
pub struct SkinningArgs {
    /// Vertices to skin (default: 15000, and with --body as many as the body has)
    #[arg(long, value_name = "N", value_parser = count(1..=MAX_VERTS))]
    verts: Option<usize>,
    /// Report the figures of dual quaternions first
    #[arg(long)]
    dual: bool,
    /// Skin the shopper's body with its own weights
    #[arg(long)]
    body: bool,
    /// Threads that skin, 1 or 2
    #[arg(long, value_name = "T", value_parser = count(1..=2), default_value = "1")]
    threads: usize,
    /// Lanes of the kernels (default: the widest of this processor)
    #[arg(long, value_name = "L", value_parser = lanes())]
    lanes: Option<Width>,
    /// cpu, or gpu: skin on a graphics device as well, and report its times and errors beside the processor's
    #[arg(long, value_name = "B", value_parser = ["cpu", "gpu"], default_value = "cpu")]
    backend: String,
    /// With --backend gpu: run every row of the table, surfaces up to a million vertices, and up to 64 bodies
    #[arg(long)]
    table: bool,
    /// Print one JSON object, and nothing else, on stdout
    #[arg(long)]
    json: bool,
}

impl SkinningArgs {
    /// What is measured.
    fn options(&self) -> SkinningOptions {
        SkinningOptions {
            subject: if self.body { SkinningSubject::Body } else { SkinningSubject::Four },
            verts: self.verts.or((!self.body).then_some(reference_time::VERTICES)),
            threads: self.threads,
            lanes: self.lanes,
        }
    }
}

/// Runs `toile bench skinning`.
///
/// # Errors
/// Where this machine cannot do what was asked for, and where stdout cannot be written.
pub fn run(args: &SkinningArgs) -> Result<(), AppError> {
    if args.backend == "gpu" {
        if args.dual || args.threads != 1 {
            let words = "with `--backend gpu` both blends and both numbers of threads are reported; leave `--dual` and `--threads` out";
            return Err(AppError::Usage(words.to_owned()));
        }
        let words = Words::new(args.json);
        let found = skinning::device::run(&args.options(), args.table, &mut |case| words.print_line(case));
        let found = found.map_err(refused)?;
        if args.json {
            return terminal::print_json(&Document::new("bench-skinning-device", found));
        }
        return terminal::print(&found.markdown());
    }
    if args.table {
        return Err(AppError::Usage("`--table` lists sizes for a graphics device; add `--backend gpu`".to_owned()));
    }
    let blend = if args.dual { Blend::Dual } else { Blend::Linear };
    let report = SkinningReport::new(skinning::measure(&args.options()).map_err(refused)?, blend);
    if args.json {
        return terminal::print_json(&Document::new("bench-skinning", report));
    }
    terminal::print(&skinning_report::summary(&report, Paint::for_stdout()))
}

fn refused(error: SkinningError) -> AppError {
    match error {
        SkinningError::NoSuchLanes(_) | SkinningError::WorkerPool(_) | SkinningError::Device(_) => {
            AppError::Device(error.to_string())
        }
        SkinningError::Body(_) | SkinningError::Skin(_) => AppError::internal(error),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::commands::arguments::parsed;

    fn options(line: &str) -> SkinningOptions {
        parsed::<SkinningArgs>(line).unwrap().options()
    }

    #[test]
    fn the_defaults_are_those_of_the_benchmark() {
        assert_eq!(options("skinning"), SkinningOptions::default());
        assert_eq!(options("skinning --body").verts, None);
    }

    #[test]
    fn every_option_arrives() {
        let expected =
            SkinningOptions { subject: SkinningSubject::Body, verts: Some(77), threads: 2, lanes: Some(Width::Four) };
        assert_eq!(options("skinning --verts 77 --body --threads 2 --lanes 4"), expected);
    }
}
