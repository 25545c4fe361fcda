//! `toile bench capture`: a moving cloth before virtual cameras, followed, against where it was.

use std::path::PathBuf;

use serde::Serialize;
use toile_cli::arguments::{Printing, count};
use toile_cli::document::Document;
use toile_cli::exit::AppError;
use toile_cli::output::OutputFolder;
use toile_cli::terminal;
use toile_perf::capture::flow::{self, FABRIC_GOAL, FlowCase, FlowRow, GOALS};
use toile_perf::capture::sheet::Sheet;

/// Follow a cloth whose motion is known before virtual cameras, and say how far off it is found.
///
/// A cloth of 900 vertices hangs in the wind, stepped by the engine, with a print on it; 2, 4 and 8 cameras see it at 2 px a
/// millimetre, with blur and noise, some with a shadow that moves and an arm that passes before it. The benchmark's skirt of 4,096
/// vertices walks with 8 cameras around it. Each row is one way to follow them: the mean distance of a vertex, the drift (last
/// ten frames over the first ten), the time of an iteration; of one row the fabric that moves as what was followed. A row that misses
/// its goal makes the exit code 3.
#[derive(Debug, Clone, PartialEq, clap::Args)]
#[command(
    after_help = "Example: the table and the contact sheets of docs/capture.md, an hour, half of it the walking skirt\n  toile bench capture --pictures sheets"
)]
pub struct CaptureBenchArgs {
    /// Frames of each row
    #[arg(long, value_name = "N", value_parser = count(12..=600), default_value = "120")]
    pub frames: usize,
    /// Rows whose name holds this word (default: all)
    #[arg(long, value_name = "WORD")]
    pub row: Option<String>,
    /// Rows of so many cameras: 2, 4 or 8 (default: all)
    #[arg(long, value_name = "N", value_parser = count(2..=8))]
    pub cameras: Option<usize>,
    /// Folder for contact sheets
    #[arg(long, value_name = "DIR")]
    pub pictures: Option<PathBuf>,
    #[command(flatten)]
    printing: Printing,
}

/// The report as JSON has it.
#[derive(Debug, Serialize)]
struct CaptureDocument {
    rows: Vec<FlowRow>,
}

/// Runs `toile bench capture`.
///
/// # Errors
/// [`AppError::Threshold`] where a row misses its goal, after the report; a folder or a stdout that cannot be written.
pub fn run(args: &CaptureBenchArgs) -> Result<(), AppError> {
    let words = args.printing.words();
    let mut folder = args.pictures.as_deref().map(OutputFolder::prepare).transpose()?;
    let mut rows = Vec::new();
    let wanted = |case: &FlowCase| {
        args.row.as_deref().is_none_or(|word| case.name.contains(word))
            && args.cameras.is_none_or(|n| n == case.cameras)
    };
    for case in flow::cases().iter().filter(|c| wanted(c)) {
        let mut sheet = Sheet::new(args.frames);
        let row = flow::run(case, args.frames, |moment| sheet.see(&moment)).map_err(AppError::internal)?;
        words.print_line(&line(&row));
        if let Some(folder) = &mut folder {
            let name = format!("{}-{}.png", case.name.replace([' ', ','], "-"), case.cameras);
            folder.write(&name, &sheet.png(&row).map_err(AppError::internal)?)?;
        }
        rows.push(row);
    }
    if let Some(folder) = folder {
        folder.commit()?;
    }
    let missed: Vec<String> = rows
        .iter()
        .filter(|r| r.met == Some(false))
        .map(|r| format!("{} with {} cameras", r.name, r.cameras))
        .collect();
    if args.printing.json {
        terminal::print_json(&Document::new("bench-capture", CaptureDocument { rows }))?;
    } else {
        terminal::print(&table(&rows))?;
    }
    if missed.is_empty() {
        return Ok(());
    }
    Err(AppError::Threshold(format!(
        "{} rows missed their goal: {}; docs/capture.md says why",
        missed.len(),
        missed.join("; ")
    )))
}

fn line(row: &FlowRow) -> String {
    format!("{}, {} cameras: {:.3} mm", row.name, row.cameras, row.error_mm.mean)
}

fn table(rows: &[FlowRow]) -> String {
    let [mean, arm, drift, seconds] = GOALS;
    let mut text = String::from(
        "| followed | cameras | mean, 95 %, largest (mm) | seen by two: share, mean, 95 % | drift | placed, least | iterations a frame | ms an iteration | goal |\n\
         |---|---|---|---|---|---|---|---|---|\n",
    );
    for r in rows {
        let goal = r.met.map_or("", |met| if met { "met" } else { "**missed**" });
        text += &format!(
            "| {} | {} | {:.3}, {:.3}, {:.2} | {:.0} %, {:.3}, {:.3} | {:.2} | {:.0} % | {:.0} | {:.1} | {goal} |\n",
            r.name,
            r.cameras,
            r.error_mm.mean,
            r.error_mm.p95,
            r.error_mm.max,
            100.0 * r.seen,
            r.seen_mm.mean,
            r.seen_mm.p95,
            r.drift,
            100.0 * r.least_placed,
            r.iterations,
            1e3 * r.seconds_per_iteration
        );
    }
    for f in rows.iter().filter_map(|r| r.fabric) {
        let part = |k: usize| 100.0 * (f.found[k] / f.truth[k] - 1.0);
        text += &format!(
            "\nThe fabric of what was followed by 4 cameras: stretch {:+.1} %, shear {:+.1} %, bending {:+.1} %, damping {:+.1} % off; it \
             lies {:.3} mm from the simulation of it\n",
            part(0),
            part(1),
            part(2),
            part(3),
            f.error_mm[1]
        );
    }
    text += &format!(
        "\nGoals: {mean} mm and a drift of {drift} without the arm, {arm} mm with it, {:.0} ms an iteration of the \
         hanging cloth, {:.0} % of each value of the fabric\n",
        1e3 * seconds,
        100.0 * FABRIC_GOAL
    );
    text
}
