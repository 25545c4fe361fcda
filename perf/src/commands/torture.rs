//! `toile torture`: the hard cases, and whether the cloth recovers.

use std::fmt::Write;
use std::time::Instant;

use clap::builder::PossibleValuesParser;
use clap::value_parser;
use serde::Serialize;
use toile_cli::arguments::{Printing, quality};
use toile_cli::document::Document;
use toile_cli::exit::AppError;
use toile_cli::terminal::{self, Paint, Tone};
use toile_engine::cloth::Quality;
use toile_perf::torture::{self, CASES, CaseSummary, SEEDS, TortureError, TortureOptions, TortureReport};

use super::bench::backend;
use crate::commands::arguments::BackendArg;

/// Most seeds of a case: a day's work.
const MAX_SEEDS: u64 = 100_000;

/// Put the cloth into states that it should never meet, and see whether it comes back.
///
/// Runs the hard cases: cloth that starts inside the body, through itself or in the wrong order, surroundings that jump or
/// crush, extreme ratios and steps, inputs that are NaN or infinite. Required are: nothing that is not finite is ever published,
/// no particle is faster than the limit, the cloth is back within 1 mm of its place of rest in 5 s where it has only one, and no
/// edge passes through a face in the end where cloth keeps out of cloth. A case that fails makes the exit code 3.
/// docs/torture.md describes the cases.
#[derive(Debug, Clone, PartialEq, clap::Args)]
#[command(after_help = "Example: run one seed of a case once more\n  toile torture squeeze --seed 7")]
pub struct TortureArgs {
    /// One case (default: all of them)
    #[arg(value_name = "CASE", value_parser = PossibleValuesParser::new(CASES.map(|case| case.name)))]
    pub case: Option<String>,
    /// Seeds of each case, from 0 on
    #[arg(long, value_name = "N", value_parser = value_parser!(u64).range(1..=MAX_SEEDS), conflicts_with = "seed")]
    pub seeds: Option<u64>,
    /// One seed: what failed, once more
    #[arg(long, value_name = "S", value_parser = value_parser!(u64).range(..u64::MAX))]
    pub seed: Option<u64>,
    /// Settings of the cloth where a case does not choose its own: draft, shop or fine
    #[arg(long, value_name = "Q", value_parser = quality(), default_value = Quality::default().name())]
    pub quality: Quality,
    /// Step by the oracle: exact implicit steps in f64, as long as the engine's, where cloth meets no cloth; 5 to 35 s a seed
    #[arg(long, conflicts_with = "backend")]
    pub oracle: bool,
    #[command(flatten)]
    backend: BackendArg,
    #[command(flatten)]
    printing: Printing,
}

impl TortureArgs {
    /// Which cases and seeds are run, and how.
    fn options(&self) -> TortureOptions {
        let seeds = match self.seed {
            Some(seed) => seed..seed + 1,
            None => 0..self.seeds.unwrap_or(SEEDS),
        };
        TortureOptions {
            case: self.case.clone(),
            seeds,
            quality: self.quality,
            backend: self.backend.choice,
            exact: self.oracle,
        }
    }
}

/// The report as JSON has it.
#[derive(Debug, Serialize)]
struct TortureDocument {
    /// Results of the cases.
    #[serde(flatten)]
    report: TortureReport,
    /// Time that it took (s).
    wall_s: f64,
}

/// Runs `toile torture`.
///
/// # Errors
/// [`AppError::Threshold`] where a case fails, after the report; a stdout that cannot be written.
pub fn run(args: &TortureArgs) -> Result<(), AppError> {
    let words = args.printing.words();
    let begun = Instant::now();
    let mut progress = |s: &CaseSummary| words.print_line(&format!("{}: {} of {} seeds", s.name, s.passed, s.seeds));
    let report = torture::run(&args.options(), &mut progress).map_err(|error| match error {
        TortureError::NotExact(_) => AppError::Usage(error.to_string()),
        _ => AppError::internal(error),
    })?;
    backend::print_fallback(&report.stepped_by);
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
    if args.printing.json {
        terminal::print_json(&Document::new("torture", TortureDocument { report, wall_s }))?;
    } else {
        terminal::print(&table(&report, wall_s, Paint::for_stdout()))?;
    }
    verdict
}

/// The report as people read it: one row a case.
fn table(report: &TortureReport, wall_s: f64, paint: Paint) -> String {
    let mut text = format!(
        "{:<18} {:>9} {:>6} {:>9} {:>8} {:>8} {:>10}  {}\n",
        "case", "passed", "folds", "NaN", "m/s", "back s", "off mm", "worst seed"
    );
    for s in &report.summary {
        let tone = if s.passed == s.seeds { Tone::Good } else { Tone::Warn };
        let passed = format!("{:>9}", format!("{}/{}", s.passed, s.seeds));
        let (back, off) = (figure(s.recovered_s.map(f64::from), 2), figure(s.hausdorff_mm, 3));
        let _ = writeln!(
            text,
            "{:<18} {} {:>6} {:>9} {:>8.2} {back:>8} {off:>10}  {}: {}",
            s.name,
            paint.tone(&passed, tone),
            s.folded,
            s.nonfinite,
            s.max_speed,
            s.worst_seed,
            s.cause
        );
    }
    let seeds: usize = report.summary.iter().map(|s| s.seeds).sum();
    let by = if report.oracle { ", its substeps solved exactly by the oracle" } else { "" };
    let _ = writeln!(text, "\n{seeds} runs in quality {}{by}, {wall_s:.0} s", report.quality);
    text
}

/// A figure, or a dash where there is none.
fn figure(value: Option<f64>, digits: usize) -> String {
    value.map_or_else(|| "-".into(), |v| format!("{v:.digits$}"))
}

#[cfg(test)]
mod tests {
    use toile_gpu::backend::Backend;

    use super::*;
    use crate::commands::arguments::parsed;

    fn options(line: &str) -> Result<TortureOptions, clap::Error> {
        Ok(parsed::<TortureArgs>(line)?.options())
    }

    #[test]
    fn all_cases_and_seeds_are_the_default() {
        assert_eq!(options("torture").unwrap(), TortureOptions::default());
    }

    #[test]
    fn one_case_and_one_seed_can_be_named() {
        let (quality, backend) = (Quality::Fine, Backend::Auto);
        let one = TortureOptions { case: Some("squeeze".into()), seeds: 7..8, quality, backend, exact: false };
        assert_eq!(options("torture squeeze --seed 7 --quality fine --backend auto --json -q").unwrap(), one);
        assert_eq!(options("torture --seeds 3").unwrap().seeds, 0..3);
        assert!(options("torture strand --oracle").unwrap().exact);
        for wrong in
            ["torture squeez", "torture --seeds 0", "torture --seed 1 --seeds 2", "torture --oracle --backend cpu"]
        {
            assert!(options(wrong).is_err(), "{wrong}");
        }
    }
}
