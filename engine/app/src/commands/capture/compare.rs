//! `toile capture compare`: a captured motion beside another of the same mesh.

use std::path::PathBuf;

use serde::Serialize;
use toile_capture::compare::{Comparison, compare, read_motion};

use crate::arguments::Printing;
use crate::exit::AppError;
use crate::report::Document;
use crate::terminal;

/// Lay a captured motion beside another of the same mesh.
///
/// Reads two folders of PLY files, a frame each, as `toile capture flow` and `toile run --dump --format ply` write them, and gives
/// the mean distance of a vertex from its counterpart in each frame.
#[derive(Debug, Clone, PartialEq, clap::Args)]
#[command(
    after_help = "Example: a capture beside the simulation of the same scene\n  toile capture compare captured simulated"
)]
pub struct CompareArgs {
    /// Folder of PLY files
    #[arg(value_name = "CAPTURED")]
    pub captured: PathBuf,
    /// The other folder
    #[arg(value_name = "OTHER")]
    pub other: PathBuf,
    #[command(flatten)]
    printing: Printing,
}

/// The report as JSON has it.
#[derive(Debug, Serialize)]
struct CompareDocument {
    frames: usize,
    vertices: usize,
    error_mm: DistanceReport,
    over_time_mm: Vec<f64>,
}

/// A distance in its summary.
#[derive(Debug, Serialize)]
struct DistanceReport {
    mean: f64,
    p95: f64,
    max: f64,
}

/// Runs `toile capture compare`.
///
/// # Errors
/// Folders that cannot be read, or motions of two meshes.
pub fn run(args: &CompareArgs) -> Result<(), AppError> {
    let motion = |folder: &PathBuf| read_motion(folder).map_err(AppError::input);
    let found = compare(&motion(&args.captured)?, &motion(&args.other)?).map_err(AppError::input)?;
    let Comparison { frames, vertices, mean_mm, p95_mm, max_mm, over_time_mm } = found;
    if args.printing.json {
        let error_mm = DistanceReport { mean: mean_mm, p95: p95_mm, max: max_mm };
        return terminal::print_json(&Document::new(
            "capture-compare",
            CompareDocument { frames, vertices, error_mm, over_time_mm },
        ));
    }
    let (first, last) = (over_time_mm[0], over_time_mm[frames - 1]);
    terminal::print(&format!(
        "{frames} frames of {vertices} vertices: mean {mean_mm:.3} mm, 95 % within {p95_mm:.3}, largest {max_mm:.3}\n  first frame \
         {first:.3} mm, last {last:.3}\n"
    ))
}
