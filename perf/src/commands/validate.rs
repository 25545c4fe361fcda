//! `toile validate`: the cloth against exact solutions.

use clap::builder::PossibleValuesParser;
use toile_assets::put_line;
use toile_cli::arguments::{Printing, count};
use toile_cli::document::Document;
use toile_cli::exit::AppError;
use toile_cli::terminal::{self, Paint, Tone};
use toile_perf::validate::Level;
use toile_perf::validate::case::ValidationRow;
use toile_perf::validate::run::{self, NAMES, ValidationOptions, ValidationReport};

use super::bench::backend;
use crate::commands::arguments::BackendArg;

/// Compare the cloth with exact solutions: each with its error and the time of a step.
///
/// Runs cases whose answer is known: strips that bend, columns that buckle, strings, pendulums, waves, friction. Each is run
/// as garments are, in each quality, and with so many substeps that more change nothing. Targets are for the quality fine; a
/// missed one is reported with its cause, and ends with exit code 3. docs/validate.md describes each case.
#[derive(Debug, Clone, PartialEq, clap::Args)]
#[command(
    after_help = "Example: see how right the cantilever is as garments are stepped\n  toile validate cantilever \
                        --quality fine"
)]
pub struct ValidateArgs {
    /// The one case to run (default: all)
    #[arg(value_name = "CASE", value_parser = PossibleValuesParser::new(NAMES))]
    pub case: Option<String>,
    /// Settings to report: one of them, or all
    #[arg(long, value_name = "Q", value_parser = PossibleValuesParser::new(levels()), default_value = ALL_LEVELS)]
    pub quality: String,
    /// Only rows of the table with this parameter, such as 'Gamma 10' (default: all)
    #[arg(long, value_name = "P")]
    pub parameter: Option<String>,
    /// Run one in K cases of each name: a quick look
    #[arg(long, value_name = "K", value_parser = count(1..=1_000), default_value = "1")]
    pub every: usize,
    /// Threads that run cases side by side, 1 or 2 (default: 2, or as many cores as there are)
    #[arg(long, value_name = "T", value_parser = count(1..=2))]
    pub threads: Option<usize>,
    #[command(flatten)]
    backend: BackendArg,
    #[command(flatten)]
    printing: Printing,
}

/// The word for every quality.
const ALL_LEVELS: &str = "all";

fn levels() -> Vec<&'static str> {
    Level::ALL.iter().map(|level| level.name()).chain([ALL_LEVELS]).collect()
}

impl ValidateArgs {
    /// Options of the run.
    fn options(&self) -> ValidationOptions {
        let wanted = |level: &Level| self.quality == ALL_LEVELS || level.name() == self.quality;
        ValidationOptions {
            case: self.case.clone(),
            parameter: self.parameter.clone(),
            levels: Level::ALL.into_iter().filter(wanted).collect(),
            threads: self.threads.unwrap_or(ValidationOptions::default().threads),
            every: self.every,
            backend: self.backend.choice,
        }
    }
}

/// Runs `toile validate`.
///
/// # Errors
/// [`AppError::Threshold`] where a target was missed, after the table; a closed stdout.
pub fn run(args: &ValidateArgs) -> Result<(), AppError> {
    let words = args.printing.words();
    let bar = words.bar(0, "validating");
    let progress = |all: usize| {
        bar.set_length(all as u64);
        bar.inc(1);
    };
    let report = run::run(&args.options(), &progress).map_err(AppError::internal)?;
    bar.finish_and_clear();
    backend::print_fallback(&report.stepped_by);
    let [passed, gated] = report.passed;
    if args.printing.json {
        terminal::print_json(&Document::new("validate", report))?;
    } else {
        terminal::print(&table(&report, Paint::for_stdout()))?;
    }
    if passed < gated {
        let missed = gated - passed;
        return Err(AppError::Threshold(format!(
            "{missed} of {gated} targets were missed; the table's last column says why"
        )));
    }
    Ok(())
}

/// The table as people read it.
fn table(report: &ValidationReport, paint: Paint) -> String {
    let mut text = String::new();
    let head = format!(
        "{:11} {:24} {:12} {:>5} {:9} {:>4} {:>10} {:>10} {:9} {:>9} {:>9} {:>9}  {}",
        "case",
        "parameter",
        "mesh",
        "links",
        "quality",
        "subs",
        "expected",
        "got",
        "unit",
        "error %",
        "solver %",
        "step us",
        ""
    );
    put_line!(text, "{}", paint.tone(head.trim_end(), Tone::Strong));
    for row in &report.cases {
        put_line!(text, "{}", row_text(row, paint));
    }
    let ([passed, gated], threads, wall) = (report.passed, report.threads, report.wall_s);
    put_line!(text, "\n{passed} of {gated} targets met, {wall:.0} s on {threads} thread(s)");
    text
}

fn row_text(row: &ValidationRow, paint: Paint) -> String {
    let solver = row.solver_error.map_or_else(|| "-".into(), percent);
    let verdict = match (row.pass, &row.cause) {
        (None, _) => "".into(),
        (Some(true), _) => paint.tone("ok", Tone::Good),
        (Some(false), cause) => {
            let cause = cause.as_deref().unwrap_or_default();
            paint
                .tone(&format!("MISSED, {:.1} % allowed: {cause}", row.target.unwrap_or_default()), Tone::Warn)
                .into_owned()
                .into()
        }
    };
    let ValidationRow { name, parameter, mesh, resolution, quality, substeps, unit, step_us, .. } = row;
    let [expected, got] = [row.expected, row.got].map(figure);
    let error = percent(row.error_percent);
    format!(
        "{name:11} {parameter:24} {mesh:12} {resolution:>5} {quality:9} {substeps:>4} {expected:>10} {got:>10} \
         {unit:9} {error:>9} {solver:>9} {step_us:>9.1}  {verdict}"
    )
    .trim_end()
    .to_owned()
}

/// A figure with the digits that fit.
fn figure(x: f64) -> String {
    let digits = if x == 0.0 || !x.is_finite() { 0 } else { (3 - x.abs().log10().floor() as i32).clamp(0, 7) };
    format!("{x:.*}", digits as usize)
}

fn percent(x: f64) -> String {
    let digits = if x.abs() < 10.0 {
        2
    } else if x.abs() < 1_000.0 {
        1
    } else {
        0
    };
    format!("{x:+.digits$}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::commands::arguments::parsed;

    #[test]
    fn a_case_and_a_quality_are_picked_and_unknown_ones_refused() {
        let parsed = |line: &str| parsed::<ValidateArgs>(line);
        let options = parsed("validate cantilever --quality fine --every 6 --threads 1").unwrap().options();
        assert_eq!(options.case.as_deref(), Some("cantilever"));
        assert_eq!((options.levels, options.every, options.threads), (vec![Level::GATED], 6, 1));
        assert!(parsed("validate cantilevr").is_err() && parsed("validate --quality best").is_err());
    }

    fn row() -> ValidationRow {
        ValidationRow {
            name: "cantilever",
            parameter: "Gamma 10".into(),
            quality: "fine",
            mesh: "grid",
            resolution: 24,
            substeps: 6,
            unit: "H/W",
            expected: 1.0668,
            got: 1.1668,
            error_percent: 9.374,
            solver_error: Some(-0.5),
            model_error: Some(9.874),
            step_us: 84.2,
            target: Some(5.0),
            pass: Some(false),
            cause: Some("mesh: it is coarse".into()),
        }
    }

    #[test]
    fn a_row_shows_its_error_beside_its_time_and_why_it_missed() {
        let text = row_text(&row(), Paint::none());
        for part in ["cantilever", "Gamma 10", "1.067", "1.167", "+9.37", "-0.50", "84.2", "MISSED, 5.0 %", "coarse"] {
            assert!(text.contains(part), "{part} is not in {text}");
        }
        let without_target = ValidationRow { pass: None, cause: None, solver_error: None, ..row() };
        assert!(row_text(&without_target, Paint::none()).ends_with("84.2"));
    }

    #[test]
    fn a_missed_target_is_a_failed_threshold() {
        let report = ValidationReport {
            cases: vec![row()],
            passed: [0, 1],
            threads: 2,
            stepped_by: Default::default(),
            wall_s: 3.0,
        };
        assert!(table(&report, Paint::none()).contains("0 of 1 targets met, 3 s on 2 thread(s)"));
        assert_eq!(report.failed().count(), 1);
    }
}
