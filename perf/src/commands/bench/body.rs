//! `toile bench body`: bodies built to the measures of real people.

use std::fmt::Write;
use std::path::PathBuf;

use serde::Serialize;
use toile_cli::arguments::{Printing, count};
use toile_cli::document::Document;
use toile_cli::exit::AppError;
use toile_cli::terminal::{self, Paint, Tone};
use toile_perf::ansur::{self, BodyStudy, MeasureErrors, Survey};

/// Most people of a file that are built: more than any survey has.
const MAX_PEOPLE: u64 = 100_000;

/// Build bodies to the measures of real people, and report their errors, their time and their flaws.
///
/// Draws random people of ANSUR II, builds each one's body from stature, neck, chest, waist at the navel, buttocks, crotch
/// height, sleeve and shoulder breadth, and reads the result off the mesh. Limits are those of ISO 20685: 4 mm for heights,
/// breadths and the neck, 9 mm for large girths. A measure out of its limit, or a body that is rough or folded, makes the exit
/// code 3; so do bodies that take longer than 20 ms.
#[derive(Debug, Clone, PartialEq, clap::Args)]
#[command(
    after_help = "Example: see how well fifty women are met\n  toile bench body --ansur ANSUR_II_FEMALE.csv --people 50"
)]
pub struct BodyBenchArgs {
    /// A file of ANSUR II, such as ANSUR_II_FEMALE.csv; repeat it for the other sex
    #[arg(long = "ansur", value_name = "FILE", required = true)]
    files: Vec<PathBuf>,
    /// People drawn from each file
    #[arg(long, value_name = "N", value_parser = count(1..=MAX_PEOPLE), default_value = "500")]
    people: usize,
    /// Which people are drawn
    #[arg(long, value_name = "S", default_value = "1")]
    seed: u64,
    #[command(flatten)]
    printing: Printing,
}

/// The report as JSON has it.
#[derive(Debug, Serialize)]
struct BodyBenchReport {
    /// The seed by which people were drawn.
    seed: u64,
    /// One study a file.
    studies: Vec<BodyStudy>,
}

/// Runs `toile bench body`.
///
/// # Errors
/// [`AppError::Input`] for a file that is no survey; [`AppError::Threshold`] where a limit was missed, after the table.
pub fn run(args: &BodyBenchArgs) -> Result<(), AppError> {
    let words = args.printing.words();
    let mut studies = Vec::new();
    for file in &args.files {
        let survey = Survey::read(file).map_err(AppError::input)?;
        let bar = words.bar(args.people.min(survey.people()) as u64, "building bodies");
        studies.push(ansur::study(&survey, args.people, args.seed, &|| bar.inc(1)).map_err(AppError::input)?);
        bar.finish_and_clear();
    }
    let missed: Vec<&str> = studies.iter().filter(|s| !s.passes() || !s.is_quick()).map(|s| s.people).collect();
    let verdict = match missed[..] {
        [] => Ok(()),
        _ => Err(AppError::Threshold(format!(
            "the {} miss a limit; the table says which measure, how many bodies look wrong, or how long they take",
            missed.join(" and the ")
        ))),
    };
    if args.printing.json {
        terminal::print_json(&Document::new("bench-body", BodyBenchReport { seed: args.seed, studies }))?;
    } else {
        let tables: Vec<String> = studies.iter().map(|s| table(s, Paint::for_stdout())).collect();
        terminal::print(&tables.join("\n"))?;
    }
    verdict
}

/// One study as people read it.
fn table(study: &BodyStudy, paint: Paint) -> String {
    let mut text = String::new();
    let title = format!("{} of {} {} of the survey", study.drawn, study.of, study.people);
    let _ = writeln!(text, "{}", paint.tone(&title, Tone::Strong));
    let _ = writeln!(
        text,
        "{:<34} {:>8} {:>9} {:>9} {:>9} {:>9} {:>8}",
        "measure (mm)", "limit", "bias", "mean", "95 %", "max", "within"
    );
    for row in &study.measures {
        let _ = writeln!(text, "{}", row_text(row, paint));
    }
    let (ms, rough, bent) = (study.calibration_ms, study.roughness, study.unevenness);
    let _ = writeln!(
        text,
        "a body takes {:.2} ms (median), {:.2} ms (99 %), {:.2} ms (max), in {:.0} steps (median), {:.0} at most",
        ms.median, ms.p99, ms.max, study.steps.median, study.steps.max
    );
    let _ = writeln!(
        text,
        "roughness over the base body's ({:.4}): {:.3} (median), {:.3} (95 %), {:.3} (max); bent by {:.4} of an edge, \
         {:.4} at most",
        study.base_roughness, rough.median, rough.p95, rough.max, bent.median, bent.max
    );
    let wrong = format!(
        "{} too rough (over {:.2}), {} folded, {} not to be met together: {:.1} % look wrong; of {}, parts touch",
        study.rough,
        ansur::TOO_ROUGH,
        study.folded,
        study.unreachable,
        study.wrong * 100.0,
        study.touching
    );
    let _ = writeln!(text, "{}", paint.tone(&wrong, if study.wrong == 0.0 { Tone::Good } else { Tone::Warn }));
    text
}

fn row_text(row: &MeasureErrors, paint: Paint) -> String {
    let within = row.within.map_or_else(|| "-".into(), |w| format!("{:.1} %", w * 100.0));
    let limit = row.limit_mm.map_or_else(|| "follows".into(), |l| format!("{l:.0}"));
    let line = format!(
        "{:<34} {limit:>8} {:>9.3} {:>9.3} {:>9.3} {:>9.3} {within:>8}",
        row.measure, row.bias_mm, row.mean_mm, row.p95_mm, row.max_mm
    );
    match row.within {
        Some(w) if w < 1.0 => paint.tone(&line, Tone::Warn).into_owned(),
        _ => line,
    }
}
