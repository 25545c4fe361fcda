//! `toile bench measure`: synthetic people measured, and held against what the tape reads on them.

use std::fmt::Write;

use serde::Serialize;
use toile_perf::ansur::Survey;
use toile_perf::measuring::{self, Agreement, Options, Study};

use crate::cli::MeasuringArgs;
use crate::exit::AppError;
use crate::report::Document;
use crate::terminal::{self, Paint, Tone, Words};

/// The report as JSON has it.
#[derive(Debug, Serialize)]
struct Report {
    /// The seed by which people were drawn.
    seed: u64,
    /// One study a camera.
    studies: Vec<Study>,
}

/// Runs `toile bench measure`.
///
/// # Errors
/// [`AppError::Input`] for a file that is no survey; [`AppError::Threshold`] where the body fit misses a limit, after
/// the tables.
pub fn bench(args: &MeasuringArgs) -> Result<(), AppError> {
    let words = Words::new(args.quiet || args.json);
    let surveys: Vec<Survey> =
        args.files.iter().map(|f| Survey::read(f)).collect::<Result<_, _>>().map_err(AppError::input)?;
    let mut studies = Vec::new();
    for &sensor in &args.sensors {
        let people: usize = surveys.iter().map(|s| args.people.min(s.people())).sum();
        let bar = words.bar(people as u64, "measuring people");
        let options = Options { people: args.people, frames: args.frames, seed: args.seed, sensor };
        studies.push(measuring::study(&surveys, &options, &|_| bar.inc(1)).map_err(AppError::input)?);
        bar.finish_and_clear();
    }
    let missed: Vec<String> = studies.iter().flat_map(missed).collect();
    let text: Vec<String> = studies.iter().map(|s| table(s, Paint::for_stdout())).collect();
    if args.json {
        terminal::print_json(&Document::new("bench-measure", Report { seed: args.seed, studies }))?;
    } else {
        terminal::print(&text.join("\n"))?;
    }
    match missed[..] {
        [] => Ok(()),
        _ => Err(AppError::Threshold(format!("the body fit misses the limit of ISO 20685: {}", missed.join(", ")))),
    }
}

/// Measures whose interval is not inside the limit.
fn missed(study: &Study) -> Vec<String> {
    study.fit.iter().filter(|a| !a.pass).map(|a| format!("{} ({})", a.measure, study.sensor)).collect()
}

/// One study as people read it.
fn table(study: &Study, paint: Paint) -> String {
    let mut text = String::new();
    let title = format!("{}: {} people, {} frames each", study.sensor, study.people, study.frames);
    let _ = writeln!(text, "{}", paint.tone(&title, Tone::Strong));
    for (way, rows) in [("body fit", &study.fit), ("sections and proportions", &study.sections)] {
        let _ = writeln!(
            text,
            "{:<26} {:>6} {:>6} {:>7} {:>17} {:>7} {:>7} {:>7} {:>7} {:>6}",
            format!("{way} (mm)"),
            "taken",
            "limit",
            "bias",
            "95 % interval",
            "mean",
            "%",
            "95 %",
            "sigma",
            "in 2s"
        );
        for row in rows {
            let _ = writeln!(text, "{}", told(row, paint));
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

fn told(a: &Agreement, paint: Paint) -> String {
    let interval = format!("{:+.1} .. {:+.1}", a.interval_mm[0], a.interval_mm[1]);
    let line = format!(
        "  {:<24} {:>6} {:>6.0} {:>+7.1} {:>17} {:>7.1} {:>7.2} {:>7.1} {:>7.1} {:>5.0}%",
        a.measure,
        a.taken,
        a.limit_mm,
        a.bias_mm,
        interval,
        a.mean_absolute_mm,
        a.mean_absolute_percent,
        a.p95_mm,
        a.sigma_mm,
        a.within_two_sigma * 100.0
    );
    paint.tone(&line, if a.pass { Tone::Good } else { Tone::Warn }).into_owned()
}
