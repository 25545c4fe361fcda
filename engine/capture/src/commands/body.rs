//! `toile capture body`: the silhouettes that several cameras saw of a person become a body and its measures.

use std::path::PathBuf;

use glam::{DVec3, Vec3};
use serde::Serialize;
use toile_assets::export::ply;
use toile_base::body::Sex;
use toile_capture::body::{
    JointPoint, SilhouetteBody, SilhouetteOptions, SilhouetteView, joint_points, measure, overlay_png,
};
use toile_cli::arguments::{Printing, one_of};
use toile_cli::document::in_mm;
use toile_cli::document::{DefinedMeasure, Document, MeasuredLength};
use toile_cli::exit::AppError;
use toile_cli::output::{Inputs, OutputFolder};
use toile_cli::terminal;
use toile_sensors::calibration;
use toile_sensors::masks::{MaskSequence, read_masks};
use toile_sensors::source::openpose::keypoints_of;
use toile_track::fit::measuring::MEASURES;
use toile_track::measures::definition;

use super::body_frames::{self, MotionReport};

/// Measure a person by their silhouettes in several calibrated cameras.
///
/// Reads one mask a camera (white, or opaque, is the person) or, with --background, pictures with and without the person. Where the
/// person stands, faces and holds their arms is found from the visual hull, or from --joints; then pose and shape of the parametric
/// body are fitted until its outlines are those that were seen. Prints eleven measures, each with its standard deviation. A sequence
/// of masks is followed: the person is measured in the first frame, and the body moved to the silhouettes of the others.
#[derive(Debug, Clone, PartialEq, clap::Args)]
#[command(
    after_help = "Example: four masks, and the body as a mesh\n  toile capture body masks --calibration cameras.toml --out fitted\n\
                  Example: pictures before a known background, the sex known\n  toile capture body shots --background empty \
                  --calibration cameras.toml --sex female\nExample: a person who moves, a folder of masks for each camera\n  \
                  toile capture body masks --calibration cameras.toml --rate 30 --out moved"
)]
pub struct BodyCaptureArgs {
    /// Folder with one PNG or JPEG for each camera, in the order of the cameras' names; or with a folder of numbered ones for each
    #[arg(value_name = "DIR")]
    pub folder: PathBuf,
    /// Calibration: a TOML file of Pose2Sim, a YAML file of OpenCV, or a folder of those, one a camera
    #[arg(long, value_name = "F")]
    pub calibration: PathBuf,
    /// Folder with the same pictures without the person: whatever differs is the person
    #[arg(long, value_name = "DIR")]
    pub background: Option<PathBuf>,
    /// Folder of OpenPose keypoints (BODY_25B) with a calibration in the same world: its first frame with a person starts the fit
    #[arg(long, value_name = "DIR")]
    pub joints: Option<PathBuf>,
    /// The person's sex, if it is known: female or male
    #[arg(long, value_name = "S", value_parser = one_of(Sex::ALL, Sex::name))]
    pub sex: Option<Sex>,
    /// Upward axis of the cameras' world: x, y, z, -x, -y or -z (default: found from the cameras)
    #[arg(long, value_name = "A", value_parser = axis, allow_hyphen_values = true)]
    pub up: Option<DVec3>,
    /// Frames a second of a sequence
    #[arg(long, value_name = "HZ", value_parser = clap::value_parser!(u32).range(1..=1_000), default_value = "30")]
    pub rate: u32,
    /// Folder for the body as it stands (body.ply, in the cameras' world) and silhouettes.png; of a sequence joints.trc (y up),
    /// motion.glb and last.png
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
    /// The frames after the first, where masks are a sequence.
    #[serde(skip_serializing_if = "Option::is_none")]
    motion: Option<MotionReport>,
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
    let (folder, background) = (&args.folder, args.background.as_deref());
    let sequence = MaskSequence::is_in(folder).then(|| MaskSequence::open(folder, background, &rig.cameras));
    let sequence = sequence.transpose().map_err(AppError::input)?;
    let masks = match &sequence {
        Some(sequence) => sequence.begin(),
        None => read_masks(folder, background, &rig.cameras),
    };
    let masks = masks.map_err(AppError::input)?;
    let joints = joints(args, sequence.as_ref())?;
    let views: Vec<SilhouetteView> =
        rig.cameras.iter().zip(&masks).map(|(camera, mask)| SilhouetteView { camera, mask }).collect();
    let options = SilhouetteOptions { sex: args.sex, up: args.up, joints: joints.first().cloned().unwrap_or_default() };
    let found = measure(&views, &options).map_err(AppError::input)?;
    if let Some(out) = &mut out {
        write(out, &views, &found)?;
    }
    let words_of = args.printing.words();
    let pace = (args.rate, &words_of);
    let motion = sequence.map(|s| body_frames::follow(&found, &rig.cameras, &s, &joints, pace, out.as_mut()));
    let motion = motion.transpose()?;
    let files = out.map(OutputFolder::commit).transpose()?.unwrap_or_default();
    let document = document(&found, views.len(), motion, files);
    if args.printing.json {
        return terminal::print_json(&Document::new("capture-body", document));
    }
    terminal::print(&words(&document))
}

/// The joints of each frame, or of the one moment; none where no keypoints are given.
fn joints(args: &BodyCaptureArgs, sequence: Option<&MaskSequence>) -> Result<Vec<Vec<JointPoint>>, AppError> {
    let Some(folder) = &args.joints else { return Ok(Vec::new()) };
    let recording = keypoints_of(folder).map_err(AppError::input)?;
    let all = match sequence {
        Some(masks) => body_frames::joints_of(&recording.frames, masks, folder)?,
        None => recording.frames.iter().flatten().take(1).map(|f| joint_points(&f.points)).collect(),
    };
    if all.first().is_none_or(Vec::is_empty) || !recording.is_25b {
        return Err(AppError::input(format!(
            "{}: no frame shows joints of BODY_25B to two cameras; leave --joints out, or run OpenPose with BODY_25B",
            folder.display()
        )));
    }
    Ok(all)
}

fn write(out: &mut OutputFolder, views: &[SilhouetteView], found: &SilhouetteBody) -> Result<(), AppError> {
    let triangles = &found.body.body.mesh.triangles;
    let positions: Vec<Vec3> = found.standing.iter().map(|p| p.as_vec3()).collect();
    out.write("body.ply", &ply(&positions, triangles.iter().map(|t| &t[..])))?;
    let png = overlay_png(views, &found.standing, triangles).map_err(AppError::internal)?;
    out.write("silhouettes.png", &png)?;
    Ok(())
}

fn document(found: &SilhouetteBody, cameras: usize, motion: Option<MotionReport>, files: Vec<PathBuf>) -> BodyDocument {
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
        motion,
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
    if let Some(motion) = &d.motion {
        text += &body_frames::words(motion);
    }
    for note in &d.notes {
        text += &format!("  {note}\n");
    }
    for file in &d.files {
        text += &format!("  {}\n", file.display());
    }
    text
}
