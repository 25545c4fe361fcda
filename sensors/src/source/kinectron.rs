//! Kinectron recordings (JSON): a list of bodies, each with 25 joints in Kinect v2 camera space and hand states.
//!
//! The format has no confidence: it is derived by [`crate::filter::gate::derive_confidence`], and a hand whose state
//! is unknown or not tracked is not believed.

use glam::Vec3;
use serde::Deserialize;
use toile_base::skeleton::Joint;

use super::joint_map::{Format, JointMap};
use super::kinect2::{KINECT_JOINTS, turned};
use super::{align, tidy};
use crate::error::{FilePlace, ReaderFault};
use crate::filter::gate::derive_confidence;
use crate::limits::MAX_JOINT_FRAMES;
use crate::session::{Session, too_many};
use toile_base::frame::{HandState, Joints, TrackedJoint};
use toile_base::limits::MAX_COORDINATE;

/// Confidence of a hand that the sensor itself has lost.
const UNKNOWN_HAND_CONFIDENCE: f32 = 0.4;

const CURE: &str = "record it again with Kinectron";

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct KinectronBody {
    #[serde(default = "yes")]
    tracked: bool,
    #[serde(default)]
    tracking_id: serde_json::Value,
    #[serde(default)]
    left_hand_state: Option<u32>,
    #[serde(default)]
    right_hand_state: Option<u32>,
    joints: Vec<CameraJoint>,
    #[serde(rename = "record_timestamp")]
    timestamp_ms: f64,
}

fn yes() -> bool {
    true
}

#[derive(Deserialize)]
struct CameraJoint {
    #[serde(rename = "cameraX")]
    x: f32,
    #[serde(rename = "cameraY")]
    y: f32,
    #[serde(rename = "cameraZ")]
    z: f32,
}

pub(super) fn read(bytes: &[u8]) -> Result<Session, ReaderFault> {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let bodies: Vec<KinectronBody> = serde_json::from_slice(bytes).map_err(|e| {
        let problem = format!("not a Kinectron recording: {e}");
        ReaderFault::new(FilePlace::Line(e.line()), problem, CURE)
    })?;
    if bodies.len() > MAX_JOINT_FRAMES {
        return Err(too_many(bodies.len()));
    }
    let mut notes = Vec::new();
    let main = tidy::most_frequent(bodies.iter().filter(|b| b.tracked).map(|b| &b.tracking_id));
    let map = JointMap::of(Format::Kinect25);
    let mut frames = Vec::with_capacity(bodies.len());
    let mut others = 0;
    for (i, body) in bodies.iter().enumerate() {
        if !body.tracked || Some(&body.tracking_id) != main {
            others += 1;
            continue;
        }
        frames.push(frame(body, &map).map_err(|problem| ReaderFault::new(FilePlace::Frame(i), problem, CURE))?);
    }
    if others > 0 {
        notes.push(format!("{others} frames are untracked or of another person and were left out"));
    }
    let mut joints = tidy::tidy(frames, &mut notes)?;
    derive_confidence(&mut joints, &mut notes);
    align::to_world(&mut joints, &mut notes)?;
    Ok(Session { joints, notes, raw_scale_known: true, ..Session::default() })
}

fn frame(body: &KinectronBody, map: &JointMap) -> Result<Joints, String> {
    if body.joints.len() != KINECT_JOINTS {
        return Err(format!("{} joints where a Kinect v2 body has {KINECT_JOINTS}", body.joints.len()));
    }
    let ms = body.timestamp_ms;
    if !ms.is_finite() || !(0.0..1e15).contains(&ms) {
        return Err(format!("the time stamp {ms} is not in milliseconds"));
    }
    let mut points = [TrackedJoint::default(); KINECT_JOINTS];
    for (kinect, (point, CameraJoint { x, y, z })) in points.iter_mut().zip(&body.joints).enumerate() {
        let camera = Vec3::new(*x, *y, *z);
        if !camera.is_finite() || camera.abs().max_element() > MAX_COORDINATE {
            return Err(format!("joint {kinect} lies at ({x}, {y}, {z}), which is no place in metres"));
        }
        *point = TrackedJoint { position: turned(camera), confidence: 1.0 };
    }
    let mut joints = map.joints((ms * 1e6) as u64, &points);
    let hands = [(Joint::LeftHand, body.left_hand_state), (Joint::RightHand, body.right_hand_state)];
    for (side, (joint, state)) in hands.into_iter().enumerate() {
        if matches!(state, Some(0 | 1)) {
            joints.at_mut(joint).confidence = UNKNOWN_HAND_CONFIDENCE;
        }
        joints.hands[side] = hand_state(state);
    }
    Ok(joints)
}

/// Kinect v2's hand states: 0 unknown, 1 not tracked, 2 open, 3 closed, 4 lasso (two fingers out).
fn hand_state(state: Option<u32>) -> HandState {
    match state {
        Some(2) => HandState::Open,
        Some(3) => HandState::Closed,
        _ => HandState::Unknown,
    }
}
