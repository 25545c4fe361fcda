//! `toile bench measure`: synthetic people are measured, and compared with their true measures.

use std::fmt::Write;
use std::path::PathBuf;

use clap::builder::PossibleValuesParser;
use serde::Serialize;
use toile_perf::ansur::Survey;
use toile_perf::measuring::{self, Family, MeasuringAgreement, MeasuringOptions, MeasuringStudy, Sensor};

use crate::arguments::{Printing, count};
use crate::exit::AppError;
use crate::report::Document;
use crate::terminal::{self, Paint, Tone};

/// Most people of a file that are measured: more than any survey has.
const MAX_PEOPLE: u64 = 100_000;

/// Most frames of one person: ten seconds.
const MAX_FRAMES: u64 = 300;

/// The word for every camera.
const BOTH: &str = "both";

/// Measure synthetic people before synthetic cameras, and report the errors of both ways of measuring.
///
/// Draws random people of ANSUR II, gives each a shape of their own, renders a second of them swaying before a Kinect v1 at 2
/// to 3 m and before a camera like the Azure Kinect at 2 to 2.5 m, and measures them by the body fit and by sections and
/// proportions. Limits are those of ISO 20685 for the mean error; it is synthetic agreement, not accuracy on people. An
/// interval beyond its limit makes the exit code 3.
#[derive(Debug, Clone, PartialEq, clap::Args)]
#[command(
    after_help = "Example: ten women before the better camera\n  toile bench measure --ansur ANSUR_II_FEMALE.csv \
                        --people 10 --sensor azure"
)]
pub struct MeasureBenchArgs {
    /// A file of ANSUR II, such as ANSUR_II_FEMALE.csv; repeat it for the other sex
    #[arg(long = "ansur", value_name = "FILE", required = true)]
    files: Vec<PathBuf>,
    /// A folder of MakeHuman's base mesh hm08: people of that family are measured too
    #[arg(long, value_name = "FOLDER")]
    makehuman: Option<PathBuf>,
    /// People drawn from each file, and of each family
    #[arg(long, value_name = "N", value_parser = count(2..=MAX_PEOPLE), default_value = "100")]
    people: usize,
    /// Frames that each is measured from, at 30 Hz
    #[arg(long, value_name = "F", value_parser = count(1..=MAX_FRAMES), default_value = "30")]
    frames: usize,
    /// Camera
    #[arg(long, value_name = "S", value_parser = PossibleValuesParser::new(cameras()), default_value = BOTH)]
    sensor: String,
    /// Which people are drawn, and how they stand
    #[arg(long, value_name = "S", default_value = "1")]
    seed: u64,
    #[command(flatten)]
    printing: Printing,
}

/// The cameras that there are.
const SENSORS: [Sensor; 2] = [Sensor::Kinect, Sensor::Azure];

fn cameras() -> Vec<&'static str> {
    SENSORS.map(Sensor::name).into_iter().chain([BOTH]).collect()
}

impl MeasureBenchArgs {
    /// The cameras that people are measured by.
    fn sensors(&self) -> impl Iterator<Item = Sensor> {
        SENSORS.into_iter().filter(|s| self.sensor == BOTH || self.sensor == s.name())
    }
}

/// The report as JSON has it.
#[derive(Debug, Serialize)]
struct MeasureBenchReport {
    /// The seed by which people were drawn.
    seed: u64,
    /// One study a camera.
    studies: Vec<MeasuringStudy>,
}

/// Runs `toile bench measure`.
///
/// # Errors
/// [`AppError::Input`] for a file that is no survey; [`AppError::Threshold`] where the body fit misses a limit, after
/// the tables.
pub fn run(args: &MeasureBenchArgs) -> Result<(), AppError> {
    let words = args.printing.words();
    let surveys: Vec<Survey> =
        args.files.iter().map(|f| Survey::read(f)).collect::<Result<_, _>>().map_err(AppError::input)?;
    let mut studies = Vec::new();
    let families = [Family::Survey].into_iter().chain(args.makehuman.clone().map(Family::Makehuman));
    for (family, sensor) in families.flat_map(|family| args.sensors().map(move |sensor| (family.clone(), sensor))) {
        let people: usize = surveys.iter().map(|s| args.people.min(s.people())).sum();
        let bar = words.bar(people as u64, "measuring people");
        let options = MeasuringOptions { family, people: args.people, frames: args.frames, seed: args.seed, sensor };
        studies.push(measuring::study(&surveys, &options, &|_| bar.inc(1)).map_err(AppError::input)?);
        bar.finish_and_clear();
    }
    let missed: Vec<String> = studies.iter().flat_map(missed).collect();
    let text: Vec<String> = studies.iter().map(|s| table(s, Paint::for_stdout())).collect();
    if args.printing.json {
        terminal::print_json(&Document::new("bench-measure", MeasureBenchReport { seed: args.seed, studies }))?;
    } else {
        terminal::print(&text.join("\n"))?;
    }
    match missed[..] {
        [] => Ok(()),
        _ => Err(AppError::Threshold(format!("the body fit misses the limit of ISO 20685: {}", missed.join(", ")))),
    }
}

/// Measures whose interval is not inside the limit.
fn missed(study: &MeasuringStudy) -> Vec<String> {
    study
        .fit
        .iter()
        .filter(|a| !a.pass)
        .map(|a| format!("{} ({}, {})", a.measure, study.family, study.sensor))
        .collect()
}

/// One study as people read it.
fn table(study: &MeasuringStudy, paint: Paint) -> String {
    let mut text = String::new();
    let title = format!("{}, {}: {} people, {} frames each", study.family, study.sensor, study.people, study.frames);
    let _ = writeln!(text, "{}", paint.tone(&title, Tone::Strong));
    for (way, rows) in [
        ("body fit", &study.fit),
        ("outline both ways", &study.both_ways),
        ("sections and proportions", &study.sections),
    ] {
        let _ = writeln!(
            text,
            "{:<26} {:>6} {:>6} {:>7} {:>17} {:>7} {:>7} {:>7} {:>7} {:>6} {:>6}",
            format!("{way} (mm)"),
            "taken",
            "limit",
            "bias",
            "95 % interval",
            "mean",
            "%",
            "95 %",
            "sigma",
            "in 1s",
            "in 2s"
        );
        for row in rows {
            let _ = writeln!(text, "{}", row_text(row, paint));
        }
    }
    let _ = writeln!(
        text,
        "no body was found in {} of {}; the sex taken for likelier was right in {:.1} %",
        study.lost,
        study.people,
        study.sex_right * 100.0
    );
    let f = &study.following;
    let _ = writeln!(
        text,
        "following: {:.1} ms a frame (median), {:.1} ms (95 %): picture {:.1}, matches {:.1}, equations {:.1}, solution {:.1} \
         ms; {:.0} ms to find somebody; surface {:.1} mm and joints {:.0} mm off",
        f.frame_ms[0],
        f.frame_ms[1],
        f.stages_ms[0],
        f.stages_ms[1],
        f.stages_ms[2],
        f.stages_ms[3],
        f.start_ms,
        f.off_mm,
        f.joints_mm
    );
    text
}

fn row_text(a: &MeasuringAgreement, paint: Paint) -> String {
    let interval = format!("{:+.1} .. {:+.1}", a.interval_mm[0], a.interval_mm[1]);
    let line = format!(
        "  {:<24} {:>6} {:>6.0} {:>+7.1} {:>17} {:>7.1} {:>7.2} {:>7.1} {:>7.1} {:>5.0}% {:>5.0}%",
        a.measure,
        a.taken,
        a.limit_mm,
        a.bias_mm,
        interval,
        a.mean_absolute_mm,
        a.mean_absolute_percent,
        a.p95_mm,
        a.sigma_mm,
        a.within_one_sigma * 100.0,
        a.within_two_sigma * 100.0
    );
    paint.tone(&line, if a.pass { Tone::Good } else { Tone::Warn }).into_owned()
}
