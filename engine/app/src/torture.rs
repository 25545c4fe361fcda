//! `toile torture`: the hard cases, and whether the cloth bears them.

use std::fmt::Write;
use std::time::Instant;

use serde::Serialize;
use toile_perf::torture::{self, Report, Summary};

use crate::backend;
use crate::cli::TortureArgs;
use crate::exit::AppError;
use crate::report::Document;
use crate::terminal::{self, Paint, Tone, Words};

/// The report as JSON has it.
#[derive(Debug, Serialize)]
struct Body {
    /// What the cases came to.
    #[serde(flatten)]
    report: Report,
    /// Time that it took (s).
    wall_s: f64,
}

/// Runs `toile torture`.
///
/// # Errors
/// [`AppError::Threshold`] where a case fails, after the report; a stdout that cannot be written.
pub fn run(args: &TortureArgs) -> Result<(), AppError> {
    let words = Words::new(args.quiet || args.json);
    let begun = Instant::now();
    let mut told = |s: &Summary| words.say(&format!("{}: {} of {} seeds", s.name, s.passed, s.seeds));
    let report = torture::run(&args.options, &mut told).map_err(AppError::internal)?;
    backend::say(&report.stepped_by);
    let wall_s = begun.elapsed().as_secs_f64();
    let failed: Vec<&str> = report.failed().map(|s| s.name).collect();
    let verdict = match failed[..] {
        [] => Ok(()),
        _ => Err(AppError::Threshold(format!(
            "{} of {} cases failed ({}); run one seed of one again with `toile torture CASE --seed S`",
            failed.len(),
            report.summary.len(),
            failed.join(", ")
        ))),
    };
    if args.json {
        terminal::print_json(&Document::new("torture", Body { report, wall_s }))?;
    } else {
        terminal::print(&table(&report, wall_s, Paint::for_stdout()))?;
    }
    verdict
}

/// The report as people read it: one row a case.
fn table(report: &Report, wall_s: f64, paint: Paint) -> String {
    let mut text = format!(
        "{:<18} {:>9} {:>9} {:>8} {:>8} {:>10}  {}\n",
        "case", "passed", "no number", "m/s", "back s", "off mm", "worst seed"
    );
    for s in &report.summary {
        let tone = if s.passed == s.seeds { Tone::Good } else { Tone::Warn };
        let passed = format!("{:>9}", format!("{}/{}", s.passed, s.seeds));
        let (back, off) = (figure(s.recovered_s.map(f64::from), 2), figure(s.hausdorff_mm, 3));
        let _ = writeln!(
            text,
            "{:<18} {} {:>9} {:>8.2} {back:>8} {off:>10}  {}: {}",
            s.name,
            paint.tone(&passed, tone),
            s.nonfinite,
            s.max_speed,
            s.worst_seed,
            s.cause
        );
    }
    let seeds: usize = report.summary.iter().map(|s| s.seeds).sum();
    let _ = writeln!(text, "\n{seeds} runs in quality {}, {wall_s:.0} s", report.quality);
    text
}

/// A figure, or a dash where there is none.
fn figure(value: Option<f64>, digits: usize) -> String {
    value.map_or_else(|| "-".into(), |v| format!("{v:.digits$}"))
}
