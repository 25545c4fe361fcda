//! `toile capture body`: the silhouettes that several cameras saw of a person become a body and its measures.

use std::path::PathBuf;

use glam::{DVec3, Vec3};
use serde::Serialize;
use toile_assets::body::Sex;
use toile_assets::export::ply;
use toile_capture::body::{SilhouetteBody, SilhouetteOptions, SilhouetteView, joint_points, measure, overlay_png};
use toile_sensors::calibration;
use toile_sensors::masks::read_masks;
use toile_sensors::source::openpose::keypoints_of;
use toile_track::fit::measuring::MEASURES;
use toile_track::measures::definition;

use crate::arguments::{Printing, one_of};
use crate::exit::AppError;
use crate::output::{Inputs, OutputFolder};
use crate::report::measures::in_mm;
use crate::report::{DefinedMeasure, Document, MeasuredLength};
use crate::terminal;

/// Measure a person by their silhouettes in several calibrated cameras.
///
/// Reads one mask a camera (white, or opaque, is the person) or, with --background, pictures with and without the person. Where the
/// person stands, faces and holds their arms is found from the visual hull, or from --joints; then pose and shape of the parametric
/// body are fitted until its outlines are those that were seen. Prints eleven measures, each with its standard deviation.
#[derive(Debug, Clone, PartialEq, clap::Args)]
#[command(
    after_help = "Example: four masks, and the body as a mesh\n  toile capture body masks --calibration cameras.toml --out fitted\n\
                  Example: pictures before a known background, the sex known\n  toile capture body shots --background empty \
                  --calibration cameras.toml --sex female"
)]
pub struct BodyCaptureArgs {
    /// Folder with one PNG or JPEG for each camera, in the order of the cameras' names
    #[arg(value_name = "DIR")]
    pub folder: PathBuf,
    /// Calibration: a TOML file of Pose2Sim, a YAML file of OpenCV, or a folder of those, one a camera
    #[arg(long, value_name = "F")]
    pub calibration: PathBuf,
    /// Folder with the same pictures without the person: whatever differs is the person
    #[arg(long, value_name = "DIR")]
    pub background: Option<PathBuf>,
    /// Folder of OpenPose keypoints (BODY_25B) with a calibration in the same world: its first frame with anybody starts the fit
    #[arg(long, value_name = "DIR")]
    pub joints: Option<PathBuf>,
    /// The person's sex, if it is known: female or male
    #[arg(long, value_name = "S", value_parser = one_of(Sex::ALL, Sex::name))]
    pub sex: Option<Sex>,
    /// Upward axis of the cameras' world: x, y, z, -x, -y or -z (default: found from the cameras)
    #[arg(long, value_name = "A", value_parser = axis, allow_hyphen_values = true)]
    pub up: Option<DVec3>,
    /// Folder for the body as it stands (body.ply, in the cameras' world) and silhouettes.png
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    #[command(flatten)]
    printing: Printing,
}

fn axis(text: &str) -> Result<DVec3, String> {
    let (sign, name) = text.strip_prefix('-').map_or((1.0, text), |rest| (-1.0, rest));
    let along = match name {
        "x" => DVec3::X,
        "y" => DVec3::Y,
        "z" => DVec3::Z,
        _ => return Err("it is x, y or z, with or without a minus".to_owned()),
    };
    Ok(along * sign)
}

/// The report as JSON has it.
#[derive(Debug, Serialize)]
struct BodyDocument {
    cameras: usize,
    /// The eleven measures.
    measures: Vec<DefinedMeasure>,
    /// Probability that the body is a woman's, 0 to 1.
    woman: f32,
    /// What body and silhouettes have in common over what either covers.
    overlap: f64,
    /// Root mean square distance of the body's rim from the outlines (mm).
    off_mm: f64,
    /// Stretches of outline that it was fitted to.
    stretches: usize,
    /// Height of the visual hull (m).
    hull_height: f64,
    /// Volume of the visual hull (l).
    hull_litres: f64,
    notes: Vec<String>,
    files: Vec<PathBuf>,
}

/// Runs `toile capture body`.
///
/// # Errors
/// Bad input as one sentence: a calibration, masks, silhouettes that meet nowhere or that no body fits; a folder that cannot be written.
pub fn run(args: &BodyCaptureArgs) -> Result<(), AppError> {
    let mut out = args.out.as_deref().map(OutputFolder::prepare).transpose()?;
    out = out.map(|out| out.sparing(Inputs::new([&args.calibration])));
    let rig = calibration::open(&args.calibration).map_err(AppError::input)?;
    let masks = read_masks(&args.folder, args.background.as_deref(), &rig.cameras).map_err(AppError::input)?;
    let joints = match &args.joints {
        Some(folder) => {
            let recording = keypoints_of(folder).map_err(AppError::input)?;
            let first = recording.frames.iter().flatten().next();
            let points = first.map(|f| joint_points(&f.points)).unwrap_or_default();
            if points.is_empty() || !recording.is_25b {
                return Err(AppError::input(format!(
                    "{}: no frame shows joints of BODY_25B to two cameras; leave --joints out, or run OpenPose with BODY_25B",
                    folder.display()
                )));
            }
            points
        }
        None => Vec::new(),
    };
    let views: Vec<SilhouetteView> =
        rig.cameras.iter().zip(&masks).map(|(camera, mask)| SilhouetteView { camera, mask }).collect();
    let found = measure(&views, &SilhouetteOptions { sex: args.sex, up: args.up, joints }).map_err(AppError::input)?;
    let mut files = Vec::new();
    if let Some(mut out) = out {
        write(&mut out, &views, &found)?;
        files = out.commit()?;
    }
    let document = document(&found, views.len(), files);
    if args.printing.json {
        return terminal::print_json(&Document::new("capture-body", document));
    }
    terminal::print(&words(&document))
}

fn write(out: &mut OutputFolder, views: &[SilhouetteView], found: &SilhouetteBody) -> Result<(), AppError> {
    let triangles = &found.body.body.mesh.triangles;
    let positions: Vec<Vec3> = found.standing.iter().map(|p| p.as_vec3()).collect();
    out.write("body.ply", &ply(&positions, triangles.iter().map(|t| &t[..])))?;
    let png = overlay_png(views, &found.standing, triangles).map_err(AppError::internal)?;
    out.write("silhouettes.png", &png)?;
    Ok(())
}

fn document(found: &SilhouetteBody, cameras: usize, files: Vec<PathBuf>) -> BodyDocument {
    let defined = |(m, e): (&(&'static str, _, _), &toile_track::estimate::Estimate)| {
        let MeasuredLength { value, sigma } = in_mm(*e);
        DefinedMeasure { name: m.0, definition: definition(m.0), value, sigma }
    };
    BodyDocument {
        cameras,
        measures: MEASURES.iter().zip(&found.measures).map(defined).collect(),
        woman: found.woman,
        overlap: found.agreement,
        off_mm: 1e3 * found.off,
        stretches: found.stretches,
        hull_height: found.hull[0],
        hull_litres: 1e3 * found.hull[1],
        notes: found.notes.clone(),
        files,
    }
}

fn words(d: &BodyDocument) -> String {
    let mut text = format!(
        "A body by {} silhouettes: they share {:.1} % of what either covers, its rim lies {:.1} mm from {} stretches of outline\n",
        d.cameras,
        100.0 * d.overlap,
        d.off_mm,
        d.stretches
    );
    for m in &d.measures {
        text += &format!("  {:<17} {:>7.1} mm  +- {:.1}\n", m.name.replace('_', " "), m.value, m.sigma);
    }
    text += &format!("  a woman's with a probability of {:.2}\n", d.woman);
    for note in &d.notes {
        text += &format!("  {note}\n");
    }
    for file in &d.files {
        text += &format!("  {}\n", file.display());
    }
    text
}
