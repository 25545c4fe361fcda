//! A person who moves before several cameras: measured in the first frame, followed through the others.

use std::path::Path;

use glam::Vec3;
use serde::Serialize;
use toile_assets::export::{MAX_GLB_FRAMES, motion_glb};
use toile_base::skeleton::Joint;
use toile_capture::body::{
    BodyFollower, FollowedFrame, JointPoint, SilhouetteBody, SilhouetteView, joint_points, overlay_png,
};
use toile_capture::pose::trc_text;
use toile_cli::exit::AppError;
use toile_cli::output::OutputFolder;
use toile_cli::terminal::Words;
use toile_sensors::calibration::CalibratedCamera;
use toile_sensors::masks::MaskSequence;
use toile_sensors::source::openpose::KeypointFrame;

/// Frames without a body that a line of words names.
const NAMED: usize = 12;

/// A sequence as JSON has it.
#[derive(Debug, Serialize)]
pub(super) struct MotionReport {
    /// Frames a second.
    rate: u32,
    /// Names of the joints, as VRM has them.
    joints: Vec<&'static str>,
    /// Frames after the first in which the body was not found.
    lost: usize,
    /// All after the first.
    frames: Vec<MotionFrame>,
}

/// What was found in one frame.
#[derive(Debug, Serialize)]
struct MotionFrame {
    /// Its number in the pictures' names.
    number: u64,
    /// Whether the body is where the silhouettes are; else it stands where it was last.
    found: bool,
    /// Cameras that saw the person.
    cameras: usize,
    /// What body and silhouettes have in common over what either covers.
    overlap: f64,
    /// Root mean square distance of the body's rim from the outlines (mm).
    off_mm: f64,
    /// Where the joints are, in the cameras' world (m).
    places: Vec<[f64; 3]>,
}

/// Follows a body through the frames after the first, `joints` being those of each frame, and writes `joints.trc`, `motion.glb` and the
/// last frame's silhouettes.
pub(super) fn follow(
    first: &SilhouetteBody,
    cameras: &[CalibratedCamera],
    masks: &MaskSequence,
    joints: &[Vec<JointPoint>],
    (rate, words): (u32, &Words),
    out: Option<&mut OutputFolder>,
) -> Result<MotionReport, AppError> {
    let mut follower = BodyFollower::new(first);
    let bar = words.bar(masks.frames() as u64 - 1, "following");
    let keeps = out.is_some() && masks.frames() <= MAX_GLB_FRAMES;
    let surface = |frame: &FollowedFrame| frame.standing.iter().map(|p| p.as_vec3()).collect::<Vec<Vec3>>();
    let mut surfaces = vec![first.standing.iter().map(|p| p.as_vec3()).collect()];
    let (mut frames, mut last) = (Vec::new(), Vec::new());
    for k in 1..masks.frames() {
        let seen = masks.read(k).map_err(AppError::input)?;
        let pairs = cameras.iter().zip(&seen);
        let views: Vec<SilhouetteView> =
            pairs.filter_map(|(camera, mask)| Some(SilhouetteView { camera, mask: mask.as_ref()? })).collect();
        let frame = follower.next(&views, joints.get(k).map_or(&[], Vec::as_slice));
        if keeps {
            surfaces.push(surface(&frame));
        }
        if k + 1 == masks.frames() && out.is_some() && !views.is_empty() {
            let triangles = &first.body.body.mesh.triangles;
            last = overlay_png(&views, &frame.standing, triangles).map_err(AppError::internal)?;
        }
        frames.push(MotionFrame {
            number: masks.first() + k as u64,
            found: frame.found,
            cameras: views.len(),
            overlap: frame.agreement,
            off_mm: 1e3 * frame.off,
            places: frame.joints.iter().map(|p| p.to_array()).collect(),
        });
        bar.inc(1);
    }
    bar.finish_and_clear();
    let lost = frames.iter().filter(|f| !f.found).count();
    let report = MotionReport { rate, joints: Joint::ALL.map(Joint::vrm).to_vec(), lost, frames };
    if let Some(out) = out {
        out.write("joints.trc", trc(&report, first).as_bytes())?;
        if keeps && let Some(glb) = motion_glb("body", &surfaces, &first.body.body.mesh.triangles, rate as f32) {
            out.write("motion.glb", &glb)?;
        }
        if !last.is_empty() {
            out.write("last.png", &last)?;
        }
    }
    Ok(report)
}

/// The joints of all frames after the first, y up; none where the body was not found.
fn trc(report: &MotionReport, first: &SilhouetteBody) -> String {
    let points = |frame: &MotionFrame| {
        let place = |p: &[f64; 3]| first.upright_place((*p).into());
        frame.found.then(|| frame.places.iter().map(place).collect())
    };
    trc_text("joints.trc", f64::from(report.rate), &report.joints, report.frames.iter().map(points))
}

/// The same in words.
pub(super) fn words(report: &MotionReport) -> String {
    let all = report.frames.len();
    let found: Vec<&MotionFrame> = report.frames.iter().filter(|f| f.found).collect();
    let overlap = found.iter().map(|f| f.overlap).sum::<f64>() / found.len().max(1) as f64;
    let mut text = format!(
        "  followed through {} of {all} frames after the first; body and silhouettes share {:.1} % there\n",
        all - report.lost,
        100.0 * overlap
    );
    let lost: Vec<String> = report.frames.iter().filter(|f| !f.found).map(|f| f.number.to_string()).collect();
    if !lost.is_empty() {
        let more = if lost.len() > NAMED { ", ..." } else { "" };
        text += &format!(
            "  no body is in the silhouettes of frame(s) {}{more}\n",
            lost[..lost.len().min(NAMED)].join(", ")
        );
    }
    text
}

/// The joints that OpenPose found in each frame.
pub(super) fn joints_of(
    frames: &[Option<KeypointFrame>],
    masks: &MaskSequence,
    folder: &Path,
) -> Result<Vec<Vec<JointPoint>>, AppError> {
    if frames.len() < masks.frames() {
        return Err(AppError::input(format!(
            "{}: it has keypoints of {} frames where there are masks of {}; give those of the same frames",
            folder.display(),
            frames.len(),
            masks.frames()
        )));
    }
    let points = |f: &Option<KeypointFrame>| f.as_ref().map(|f| joint_points(&f.points)).unwrap_or_default();
    Ok(frames.iter().map(points).collect())
}
