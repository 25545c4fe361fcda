//! `toile bench webcam`: joints by a webcam, against the truth and the body fitted to depth.

use std::path::{Path, PathBuf};

use clap::value_parser;
use toile_cli::document::Document;
use toile_cli::exit::AppError;
use toile_cli::output::{Inputs, OutputFile};
use toile_cli::terminal::{self, Words};
use toile_perf::webcam::{self, WebcamError};
use toile_pose::files;

/// Measure joints by a webcam: degrees from the truth, beside those of depth, and the time of a picture.
///
/// Draws people of several sizes who move before a webcam and a depth camera at one place, finds their joints by the pose network, lite and
/// full, and by the body fitted to depth, and reports the angle between each limb and its truth. Needs the network that `toile doctor` names.
#[derive(Debug, Clone, PartialEq, Eq, clap::Args)]
#[command(after_help = "Example: the table of docs/webcam.md\n  toile bench webcam")]
pub struct WebcamBenchArgs {
    /// People
    #[arg(long, value_name = "N", value_parser = value_parser!(u8).range(1..=6), default_value = "2")]
    people: u8,
    /// Draw ten seconds of a person at 30 Hz instead, for webcam-file:F; the name has to end in _640x480.yuyv
    #[arg(long, value_name = "F")]
    film: Option<PathBuf>,
    /// Print one JSON object, and nothing else, on stdout
    #[arg(long)]
    json: bool,
}

/// Runs `toile bench webcam`.
///
/// # Errors
/// A network that is not fetched, a file that cannot be written, a closed stdout.
pub fn run(args: &WebcamBenchArgs) -> Result<(), AppError> {
    let words = Words::new(args.json);
    if let Some(file) = &args.film {
        return film(file);
    }
    let table = webcam::run(&files::folder(), args.people.into(), &mut |who| words.print_line(who));
    let table = table.map_err(|error| match error {
        WebcamError::Pose(error) => AppError::Device(error.to_string()),
        WebcamError::Body(error) => AppError::internal(error),
    })?;
    if args.json {
        return terminal::print_json(&Document::new("bench-webcam", table));
    }
    terminal::print(&table.markdown())
}

/// Draws a film.
fn film(file: &Path) -> Result<(), AppError> {
    if !file.to_string_lossy().ends_with("_640x480.yuyv") {
        return Err(AppError::Input(format!("{}: name it so that it ends in _640x480.yuyv", file.display())));
    }
    let out = OutputFile::prepare(file, Inputs::default())?;
    let mut bytes = Vec::new();
    webcam::film(&mut |picture| bytes.extend_from_slice(picture)).map_err(AppError::internal)?;
    out.write(&bytes)?;
    terminal::print(&format!("{}: {} pictures\n", file.display(), bytes.len() / (2 * 640 * 480)))
}
