//! `toile bench webcam`: joints by a webcam, against the truth and the body fitted to depth.

use std::path::PathBuf;

use clap::value_parser;
use toile_perf::webcam::{self, WebcamError};
use toile_pose::files;

use crate::exit::AppError;
use crate::output::{Inputs, OutputFile};
use crate::report::Document;
use crate::terminal::{self, Words};

/// Measure joints by a webcam: degrees from the truth, beside those of depth, and the time of a picture.
///
/// Draws people of several sizes who move before a webcam and a depth camera at one place, finds their joints by the pose network, lite and
/// full, and by the body fitted to depth, and reports the angle between each limb and its truth. Needs the network that `toile doctor` names.
#[derive(Debug, Clone, PartialEq, Eq, clap::Args)]
#[command(after_help = "Example: the table of docs/webcam.md\n  toile bench webcam --people 4")]
pub struct WebcamBenchArgs {
    /// People
    #[arg(long, value_name = "N", value_parser = value_parser!(u8).range(1..=6), default_value = "2")]
    people: u8,
    /// Write the first one's pictures too, as a webcam sends them, for webcam-file:F; the name has to end in _640x480.yuyv
    #[arg(long, value_name = "F")]
    pictures: Option<PathBuf>,
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
    let out = args.pictures.as_deref().map(|file| OutputFile::prepare(file, Inputs::default())).transpose()?;
    let mut bytes = Vec::new();
    let mut keep = |picture: &[u8]| {
        if out.is_some() {
            bytes.extend_from_slice(picture);
        }
    };
    let table = webcam::run(&files::folder(), args.people.into(), &mut |who| words.print_line(who), &mut keep);
    let table = table.map_err(|error| match error {
        WebcamError::Pose(error) => AppError::Device(error.to_string()),
        WebcamError::Body(error) => AppError::internal(error),
    })?;
    if let Some(out) = out {
        out.write(&bytes)?;
    }
    if args.json {
        return terminal::print_json(&Document::new("bench-webcam", table));
    }
    terminal::print(&table.markdown())
}
