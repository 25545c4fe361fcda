//! `toile capture pose`: joints of several cameras become a skeleton whose bones keep their lengths.

use std::path::PathBuf;

use serde::Serialize;
use toile_assets::file::{self, FileKind};
use toile_capture::pose::{PoseMotion, distances, fit, marker_name, read_trc, write_trc};
use toile_cli::arguments::Printing;
use toile_cli::document::Document;
use toile_cli::exit::AppError;
use toile_cli::output::{Inputs, OutputFile};
use toile_cli::terminal;
use toile_sensors::source::openpose::keypoints_of;

/// Largest file of markers.
const MARKERS: FileKind = FileKind { name: "a TRC file", max_bytes: 256 << 20, cure: "give fewer frames" };

/// Fit a skeleton to the keypoints of several calibrated cameras.
///
/// Reads a folder of OpenPose keypoints (BODY_25B) with the cameras' calibration, finds the person whom most cameras see, and fits a
/// skeleton whose bones keep their lengths, frame after frame, without a start by hand. Writes its joints as TRC.
#[derive(Debug, Clone, PartialEq, clap::Args)]
#[command(
    after_help = "Example: a recording of four cameras, beside the joints that others triangulated\n  toile capture pose recording \
                  --out joints.trc --truth theirs.trc"
)]
pub struct PoseArgs {
    /// Folder with a calibration (TOML) and a folder of OpenPose JSON for each camera
    #[arg(value_name = "DIR")]
    pub folder: PathBuf,
    /// File of joints to write
    #[arg(long, value_name = "F.trc")]
    pub out: Option<PathBuf>,
    /// Joints to compare with, of the same names
    #[arg(long, value_name = "F.trc")]
    pub truth: Option<PathBuf>,
    #[command(flatten)]
    printing: Printing,
}

/// The report as JSON has it.
#[derive(Debug, Serialize)]
struct PoseDocument {
    frames: usize,
    /// Frames in which two cameras saw the person.
    found: usize,
    cameras: usize,
    /// Mean distance of the keypoints from where the skeleton is seen (px).
    residual: f64,
    bones: Vec<BoneReport>,
    /// Distance from the joints that were given, where some were (mm).
    #[serde(skip_serializing_if = "Option::is_none")]
    error_mm: Option<JointDistance>,
    files: Vec<PathBuf>,
}

/// One bone.
#[derive(Debug, Serialize)]
struct BoneReport {
    from: &'static str,
    to: &'static str,
    length_mm: f64,
}

/// Distances of joints in their summary.
#[derive(Debug, Serialize)]
struct JointDistance {
    mean: f64,
    median: f64,
    p95: f64,
    max: f64,
    joints: usize,
}

/// Runs `toile capture pose`.
///
/// # Errors
/// Bad input as one sentence, a file that cannot be written.
pub fn run(args: &PoseArgs) -> Result<(), AppError> {
    let out = args.out.as_deref().map(|path| OutputFile::prepare(path, Inputs::new(args.truth.iter()))).transpose()?;
    let recording = keypoints_of(&args.folder).map_err(AppError::input)?;
    let motion = fit(&recording).map_err(AppError::input)?;
    let error_mm = match &args.truth {
        Some(path) => {
            let text = file::read_text(path, &MARKERS).map_err(AppError::input)?;
            let truth = read_trc(&path.display().to_string(), &text).map_err(AppError::input)?;
            Some(summary(&distances(&motion, &truth)).ok_or_else(|| {
                AppError::input(format!(
                    "{}: it has no joints of the names that are fitted; give one of Pose2Sim",
                    path.display()
                ))
            })?)
        }
        None => None,
    };
    let name =
        args.out.as_deref().and_then(|p| p.file_name()).map_or_else(String::new, |n| n.to_string_lossy().into_owned());
    let files = out.map(|out| out.write(write_trc(&name, &motion).as_bytes())).transpose()?.unwrap_or_default();
    let document = PoseDocument {
        frames: motion.frames.len(),
        found: motion.frames.iter().flatten().count(),
        cameras: recording.rig.cameras.len(),
        residual: motion.residual_px,
        bones: bones(&motion),
        error_mm,
        files,
    };
    if args.printing.json {
        return terminal::print_json(&Document::new("capture-pose", document));
    }
    terminal::print(&words(&document))
}

fn bones(motion: &PoseMotion) -> Vec<BoneReport> {
    let rows = motion.bones.iter().zip(&motion.lengths);
    rows.map(|([a, b], l)| BoneReport { from: marker_name(*a), to: marker_name(*b), length_mm: l * 1e3 }).collect()
}

/// The summary of sorted distances; nothing where there are none.
fn summary(sorted: &[f64]) -> Option<JointDistance> {
    let max = *sorted.last()?;
    let at = |share: f64| sorted[((sorted.len() - 1) as f64 * share) as usize];
    let mean = sorted.iter().sum::<f64>() / sorted.len() as f64;
    Some(JointDistance { mean, median: at(0.5), p95: at(0.95), max, joints: sorted.len() })
}

fn words(d: &PoseDocument) -> String {
    let mut text = format!(
        "{} of {} frames by {} cameras; keypoints lie {:.1} px from the skeleton\n",
        d.found, d.frames, d.cameras, d.residual
    );
    if let Some(e) = &d.error_mm {
        text += &format!(
            "  from the joints given: mean {:.1} mm, median {:.1}, 95 % within {:.1}, over {} joints\n",
            e.mean, e.median, e.p95, e.joints
        );
    }
    for b in &d.bones {
        text += &format!("  {:>9} - {:<9} {:>6.1} mm in every frame\n", b.from, b.to, b.length_mm);
    }
    text
}
