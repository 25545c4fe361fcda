//! `toile capture compare`: a captured motion beside another of the same mesh.

use std::path::{Path, PathBuf};

use clap::value_parser;
use glam::Vec3;
use serde::Serialize;
use toile_capture::compare::{Comparison, compare, read_motion};
use toile_capture::recover::{Recovered, recover};
use toile_cli::arguments::Printing;
use toile_cli::document::Document;
use toile_cli::exit::AppError;
use toile_cli::terminal;

use super::fabric_scene::FabricScene;

/// Lay a captured motion beside another of the same mesh, or find the fabric that moves as it does.
///
/// Reads folders of PLY files, a frame each, as `toile capture flow` and `toile run --dump` write them, and gives the mean distance of
/// a vertex from its counterpart in each frame. With --scene, the scene is simulated instead, and the stretch, shear, bending and
/// damping of its garment are found that bring it nearest to what was captured.
#[derive(Debug, Clone, PartialEq, clap::Args)]
#[command(
    after_help = "Example: a capture beside the simulation of the same scene\n  toile capture compare captured simulated\nExample: the \
                  fabric of what was captured, at 60 frames a second\n  toile capture compare captured --scene cloth.toml --rate 60"
)]
pub struct CompareArgs {
    /// Folder of PLY files
    #[arg(value_name = "CAPTURED")]
    pub captured: PathBuf,
    /// The other folder
    #[arg(value_name = "OTHER", required_unless_present = "scene", conflicts_with = "scene")]
    pub other: Option<PathBuf>,
    /// Scene file whose only garment is the captured mesh, its vertices in the same order, at its start in the first frame
    #[arg(long, value_name = "F.toml")]
    pub scene: Option<PathBuf>,
    /// Frames a second of what was captured; the scene's steps a second are a multiple of it
    #[arg(long, value_name = "HZ", value_parser = value_parser!(u32).range(1..=1000), default_value = "60")]
    pub rate: u32,
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
    let captured = motion(&args.captured)?;
    let other = match (&args.scene, &args.other) {
        (Some(scene), _) => return recovered(args, scene, &captured),
        (None, Some(other)) => motion(other)?,
        (None, None) => return Err(AppError::Usage("give another folder, or --scene".to_owned())),
    };
    let found = compare(&captured, &other).map_err(AppError::input)?;
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

/// The report of the values that were found, as JSON has it.
#[derive(Debug, Serialize)]
struct RecoveredDocument {
    frames: usize,
    /// Mean distance with the scene's own values, and with those that were found (mm).
    error_mm: [f64; 2],
    simulations: usize,
    values: Vec<ValueReport>,
}

/// One value of the fabric.
#[derive(Debug, Serialize)]
struct ValueReport {
    name: &'static str,
    /// What the scene says.
    start: f64,
    value: f64,
    /// Standard deviation, as a part of the value.
    sigma: f64,
}

fn recovered(args: &CompareArgs, path: &Path, captured: &[Vec<Vec3>]) -> Result<(), AppError> {
    let scene = FabricScene::read(path, args.rate)?;
    let vertices = scene.check(captured)?;
    let words = args.printing.words();
    words.print_line(&format!("simulating {} frames of {vertices} vertices", captured.len()));
    let start = scene.start();
    let Recovered { values, sigma, error_mm, simulations } =
        recover(start, captured, |values, frames| scene.simulate(values, frames))?;
    let rows = FabricScene::NAMES.iter().enumerate();
    let values: Vec<ValueReport> =
        rows.map(|(k, name)| ValueReport { name, start: start[k], value: values[k], sigma: sigma[k] }).collect();
    if args.printing.json {
        let frames = captured.len();
        return terminal::print_json(&Document::new(
            "capture-compare",
            RecoveredDocument { frames, error_mm, simulations, values },
        ));
    }
    let [before, after] = error_mm;
    let mut text = format!(
        "mean distance {before:.3} mm with the scene's values, {after:.3} mm with these, after {simulations} simulations\n"
    );
    for v in &values {
        text += &format!(
            "  {:<14} {:>10.3} +- {:.1} %  (the scene has {:.3})\n",
            v.name,
            v.value,
            100.0 * v.sigma,
            v.start
        );
    }
    terminal::print(&text)
}
