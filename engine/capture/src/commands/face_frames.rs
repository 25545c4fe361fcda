//! Report of a head that is followed through a sequence.

use std::path::Path;

use serde::Serialize;
use toile_pose::face::{FaceView, TrackedFrame, TrackedHead, TrackedSequence};
use toile_sensors::face_points::MarkedPhotograph;

/// Frames without a head that a line of words names.
const NAMED: usize = 12;

/// A sequence as JSON has it.
#[derive(Debug, Serialize)]
pub(super) struct SequenceReport {
    /// The frame that the search began with, from 0, and how many the head was adapted to.
    first: usize,
    adapted_to: usize,
    /// Frames whose points are those of no head.
    lost: usize,
    frames: Vec<FrameReport>,
}

/// What was found in one frame.
#[derive(Debug, Serialize)]
struct FrameReport {
    picture: String,
    /// Whether its points are those of a head.
    found: bool,
    /// Points that agree with it.
    points: usize,
    /// Root mean square distance of these from where they were marked, of all points where no head is found (px).
    residual_px: Option<f64>,
    #[serde(flatten)]
    head: Option<HeadReport>,
}

/// A head in one frame.
#[derive(Debug, Serialize)]
struct HeadReport {
    /// Turned to the wearer's left, raised, leant to the left shoulder; 0 for a head that faces against the camera's axis (degrees).
    yaw_degrees: f64,
    pitch_degrees: f64,
    roll_degrees: f64,
    /// The middle of the head in the cameras' world (mm).
    place_mm: [f64; 3],
    /// How far each expression is there, 0 to 1.
    jaw_open: f64,
    smile: f64,
    brows_up: f64,
    lids_closed: f64,
}

/// The report of a sequence.
pub(super) fn report(found: &TrackedSequence, views: &[FaceView], marked: &[MarkedPhotograph]) -> SequenceReport {
    let frames = found.frames.iter().zip(views).zip(marked).map(|((frame, view), m)| of_frame(frame, view, &m.picture));
    let lost = found.frames.iter().filter(|f| f.found.is_none()).count();
    SequenceReport { first: found.first, adapted_to: found.kept, lost, frames: frames.collect() }
}

fn of_frame(frame: &TrackedFrame, view: &FaceView, picture: &Path) -> FrameReport {
    let head = |head: TrackedHead| {
        let [yaw_degrees, pitch_degrees, roll_degrees] = head.angles(&view.camera).map(f64::to_degrees);
        let [jaw_open, smile, brows_up, lids_closed] = head.amplitudes;
        let place_mm = (head.place * 1e3).to_array();
        HeadReport { yaw_degrees, pitch_degrees, roll_degrees, place_mm, jaw_open, smile, brows_up, lids_closed }
    };
    FrameReport {
        picture: picture.file_name().unwrap_or_default().to_string_lossy().into_owned(),
        found: frame.found.is_some(),
        points: frame.points,
        residual_px: frame.residual_px.is_finite().then_some(frame.residual_px),
        head: frame.found.map(head),
    }
}

/// The same in words.
pub(super) fn words(report: &SequenceReport) -> String {
    let all = report.frames.len();
    let found: Vec<f64> = report.frames.iter().filter(|f| f.found).filter_map(|f| f.residual_px).collect();
    let mean = found.iter().sum::<f64>() / found.len().max(1) as f64;
    let mut text = format!(
        "  followed through {} of {all} frames, within {mean:.1} px on average; the head is that of {} frame(s) together\n",
        all - report.lost,
        report.adapted_to
    );
    let lost: Vec<String> = (0..all).filter(|k| !report.frames[*k].found).map(|k| k.to_string()).collect();
    if !lost.is_empty() {
        let more = if lost.len() > NAMED { ", ..." } else { "" };
        text += &format!("  no head has the points of frame(s) {}{more}\n", lost[..lost.len().min(NAMED)].join(", "));
    }
    text
}
