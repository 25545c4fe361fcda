//! `toile capture flow`: a mesh known in the first frame, followed through the pictures of several cameras.

use std::path::PathBuf;

use clap::value_parser;
use serde::Serialize;
use toile_capture::flow::{FlowSettings, Reference, Springs};
use toile_capture::recording::{FlowJob, FlowSummary, read_mesh};
use toile_cli::arguments::{Printing, count, one_of};
use toile_cli::document::Document;
use toile_cli::exit::AppError;
use toile_cli::terminal;
use toile_sensors::calibration;
use toile_sensors::pictures::PictureSequence;

/// Follow a mesh through the pictures of several cameras.
///
/// The mesh is known in the first frame. In each next one it is deformed so that what every triangle looked like is seen again in
/// all cameras; triangles that fewer than two cameras see are carried by springs, folds and inertia. Writes a PLY file a frame as it
/// goes, and the whole motion as GLB; the same command goes on where it was stopped. docs/capture.md describes the method.
#[derive(Debug, Clone, PartialEq, clap::Args)]
#[command(
    after_help = "Example: a cloth that was filmed by four cameras\n  toile capture flow pictures --calibration cameras.toml --mesh \
                  cloth.obj --out captured\nExample: cameras calibrated with OpenCV, a file each\n  toile capture flow pictures \
                  --calibration yaml-folder --mesh cloth.obj --out captured"
)]
pub struct FlowArgs {
    /// Folder with a folder of numbered PNG or JPEG files for each camera, in the order of the cameras' names
    #[arg(value_name = "PICTURES")]
    pub pictures: PathBuf,
    /// Calibration: a TOML file of Pose2Sim, a YAML file of OpenCV, or a folder of those, one a camera
    #[arg(long, value_name = "F")]
    pub calibration: PathBuf,
    /// Mesh in the first frame, as OBJ, in metres, in the world of the cameras
    #[arg(long, value_name = "F.obj")]
    pub mesh: PathBuf,
    /// Output folder; a run that it holds is gone on with
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
    /// Most frames (default: all)
    #[arg(long, value_name = "N", value_parser = count(1..))]
    pub frames: Option<usize>,
    /// How edges resist: cubic, linear or off
    #[arg(
        long,
        value_name = "S",
        value_parser = one_of([Springs::Cubic, Springs::Linear, Springs::Off], spring_name),
        default_value = "cubic"
    )]
    pub springs: Springs,
    /// Strain at which a cubic spring pulls as a linear one: softer below, stiffer above
    #[arg(long, value_name = "T", value_parser = strain, default_value = "0.02")]
    pub threshold: f64,
    /// What pictures are compared with: first, the frame in which a triangle was first seen, or previous, the frame before
    #[arg(
        long,
        value_name = "R",
        value_parser = one_of([Reference::First, Reference::Previous], reference_name),
        default_value = "first"
    )]
    pub reference: Reference,
    /// Values a pixel: 1, its luminance, or 3
    #[arg(long, value_name = "N", value_parser = channels, default_value = "1")]
    pub channels: usize,
    /// Levels of the pictures, each half the size of the one before: more for faster motion
    #[arg(long, value_name = "N", value_parser = count(1..=7), default_value = "4")]
    pub levels: usize,
    /// Frames a second, where the calibration does not say
    #[arg(long, value_name = "HZ", value_parser = value_parser!(u32).range(1..=1000), default_value = "60")]
    pub rate: u32,
    /// Go on although the cameras' pictures seem to be out of step
    #[arg(long)]
    pub unsynchronised: bool,
    #[command(flatten)]
    printing: Printing,
}

const fn spring_name(springs: Springs) -> &'static str {
    match springs {
        Springs::Off => "off",
        Springs::Linear => "linear",
        Springs::Cubic => "cubic",
    }
}

const fn reference_name(reference: Reference) -> &'static str {
    match reference {
        Reference::Previous => "previous",
        Reference::First => "first",
    }
}

fn strain(text: &str) -> Result<f64, String> {
    let value: f64 = text.parse().map_err(|_| "it is no number".to_owned())?;
    if (0.001..=1.0).contains(&value) { Ok(value) } else { Err("it is not between 0.001 and 1".to_owned()) }
}

fn channels(text: &str) -> Result<usize, String> {
    match text {
        "1" => Ok(1),
        "3" => Ok(3),
        _ => Err("it is 1 or 3".to_owned()),
    }
}

/// The report as JSON has it.
#[derive(Debug, Serialize)]
struct FlowDocument {
    #[serde(flatten)]
    summary: FlowSummary,
}

/// Runs `toile capture flow`.
///
/// # Errors
/// Bad input, as one sentence: a calibration, pictures, cameras out of step, a mesh that does not fit the first frame; a folder that
/// cannot be written.
pub fn run(args: &FlowArgs) -> Result<(), AppError> {
    let rig = calibration::open(&args.calibration).map_err(AppError::input)?;
    let sequence = PictureSequence::open(&args.pictures, rig.cameras.len()).map_err(AppError::input)?;
    let surface = read_mesh(&args.mesh).map_err(AppError::input)?;
    let settings = FlowSettings {
        springs: args.springs,
        threshold: args.threshold,
        reference: args.reference,
        channels: args.channels,
        levels: args.levels,
        ..FlowSettings::default()
    };
    let job = FlowJob {
        surface,
        rig,
        sequence,
        out: args.out.clone(),
        settings,
        frames: args.frames,
        rate: f64::from(args.rate),
        unsynchronised: args.unsynchronised,
    };
    let bar = args.printing.words().bar(0, "frames");
    let summary = job.run(|p| {
        bar.set_length(p.of as u64);
        bar.set_position(p.done as u64);
    });
    bar.finish_and_clear();
    let summary = summary.map_err(AppError::input)?;
    if args.printing.json {
        return terminal::print_json(&Document::new("capture-flow", FlowDocument { summary }));
    }
    terminal::print(&words(&summary, args))
}

fn words(s: &FlowSummary, args: &FlowArgs) -> String {
    let again = if s.resumed > 0 { format!(", {} of them by an earlier run", s.resumed) } else { String::new() };
    format!(
        "{} frames{again}: {} vertices by {} cameras, in {}\n  first frame: triangles correlate {:.2} between cameras, differ by \
         {:.1} of 255\n  residual {:.1} of 255, at least {:.0} % of the triangles placed by cameras, strain at most {:.1} %\n  {:.1} ms \
         an iteration\n",
        s.frames,
        s.vertices,
        s.cameras,
        args.out.display(),
        s.first.agreement,
        s.first.residual,
        s.residual,
        100.0 * s.least_placed,
        100.0 * s.strain,
        1e3 * s.seconds_per_iteration
    )
}
