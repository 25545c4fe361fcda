//! Azure Kinect body tracking (k4abt), 32 joints: the JSON of Microsoft's offline processor, or one such frame a line.
//!
//! A file is one object with `frames`, or JSON lines each of which is a frame: `timestamp_usec` and `bodies`, each with a
//! `body_id` and `joint_positions` (mm, camera space: x right, y down, z forward). The tool writes no confidence, which
//! is then [derived](crate::filter::gate::derive_confidence); `joint_confidence_levels` (0 out of range, 1 predicted,
//! 2 seen, 3 certain) are taken where a recorder adds them.

use glam::Vec3;
use serde::Deserialize;

use super::joint_map::{Format, JointMap};
use super::{align, tidy};
use crate::error::{FilePlace, ReaderFault};
use crate::filter::gate::derive_confidence;
use crate::limits::MAX_JOINT_FRAMES;
use crate::session::{Session, too_many};
use toile_base::frame::TrackedJoint;
use toile_base::limits::MAX_COORDINATE;

const POINTS: usize = Format::Azure32.points();

/// Confidence of each of the tracker's levels: what it predicts it has not seen, and lies below the gate of 0.5.
const LEVEL_CONFIDENCE: [f32; 4] = [0.0, 0.4, 1.0, 1.0];

const CURE: &str = "write it again with k4abt's offline processor";

/// The file, or a line of it.
#[derive(Deserialize)]
struct Record {
    #[serde(default)]
    frames: Option<Vec<AzureFrame>>,
    #[serde(default)]
    timestamp_usec: Option<u64>,
    #[serde(default)]
    bodies: Vec<AzureBody>,
}

#[derive(Deserialize)]
struct AzureFrame {
    timestamp_usec: u64,
    #[serde(default)]
    bodies: Vec<AzureBody>,
}

#[derive(Deserialize)]
struct AzureBody {
    #[serde(default)]
    body_id: u32,
    joint_positions: Vec<[f32; 3]>,
    #[serde(default)]
    joint_confidence_levels: Option<Vec<u8>>,
}

/// Whether the begin of a JSON file shows this kind.
pub(super) fn recognises(head: &[u8]) -> bool {
    let has = |key: &[u8]| head.windows(key.len()).any(|w| w == key);
    has(b"\"bone_list\"") || has(b"\"timestamp_usec\"") || has(b"\"joint_positions\"") || has(b"\"k4abt_sdk_version\"")
}

pub(super) fn read(bytes: &[u8]) -> Result<Session, ReaderFault> {
    let frames = parse(bytes)?;
    let main = tidy::most_frequent(frames.iter().flat_map(|f| f.bodies.iter().map(|b| b.body_id)));
    let map = JointMap::of(Format::Azure32);
    let (mut joints, mut empty, mut levels) = (Vec::with_capacity(frames.len()), 0, true);
    for (i, frame) in frames.iter().enumerate() {
        let Some(body) = frame.bodies.iter().find(|b| Some(b.body_id) == main) else {
            empty += 1;
            continue;
        };
        let at = |problem| ReaderFault::new(FilePlace::Frame(i), problem, CURE);
        let ns =
            frame.timestamp_usec.checked_mul(1_000).ok_or_else(|| at("the time is beyond any clock".to_owned()))?;
        joints.push(map.joints(ns, &points(body).map_err(at)?));
        levels &= body.joint_confidence_levels.is_some();
    }
    let mut notes = Vec::new();
    if empty > 0 {
        notes.push(format!(
            "{empty} of {} frames do not show the person who is seen most and were left out",
            frames.len()
        ));
    }
    let mut joints = tidy::tidy(joints, &mut notes)?;
    if !levels {
        derive_confidence(&mut joints, &mut notes);
    }
    align::to_world(&mut joints, &mut notes)?;
    Ok(Session { joints, notes, raw_scale_known: true, ..Session::default() })
}

/// All frames, of an object that holds them or of lines.
fn parse(bytes: &[u8]) -> Result<Vec<AzureFrame>, ReaderFault> {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let mut frames = Vec::new();
    for record in serde_json::Deserializer::from_slice(bytes).into_iter::<Record>() {
        let record = record.map_err(|e| {
            ReaderFault::new(
                FilePlace::Line(e.line()),
                format!("not a recording of Azure Kinect body tracking: {e}"),
                CURE,
            )
        })?;
        match (record.frames, record.timestamp_usec) {
            (Some(more), _) => frames.extend(more),
            (None, Some(timestamp_usec)) => frames.push(AzureFrame { timestamp_usec, bodies: record.bodies }),
            (None, None) => {
                let problem = "an object that holds neither frames nor a frame's timestamp_usec";
                return Err(ReaderFault::new(FilePlace::Frame(frames.len()), problem, CURE));
            }
        }
        if frames.len() > MAX_JOINT_FRAMES {
            return Err(too_many(frames.len()));
        }
    }
    Ok(frames)
}

/// A body's points in world axes (m): the camera's y and z turned about its x.
fn points(body: &AzureBody) -> Result<[TrackedJoint; POINTS], String> {
    let count = body.joint_positions.len();
    if count != POINTS {
        return Err(format!("{count} joints where an Azure Kinect body has {POINTS}"));
    }
    let levels = body.joint_confidence_levels.as_deref();
    if let Some(levels) = levels.filter(|l| l.len() != POINTS) {
        return Err(format!("{} confidence levels for {POINTS} joints", levels.len()));
    }
    let mut points = [TrackedJoint::default(); POINTS];
    for (k, (point, [x, y, z])) in points.iter_mut().zip(&body.joint_positions).enumerate() {
        let camera = Vec3::new(*x, *y, *z) * 1e-3;
        if !camera.is_finite() || camera.abs().max_element() > MAX_COORDINATE {
            return Err(format!("joint {k} lies at ({x}, {y}, {z}), which is no place in millimetres"));
        }
        let level = levels.map_or(2, |l| l[k]);
        let confidence = LEVEL_CONFIDENCE.get(usize::from(level)).copied();
        let confidence = confidence.ok_or_else(|| format!("the confidence level {level} is not 0, 1, 2 or 3"))?;
        *point = TrackedJoint { position: Vec3::new(camera.x, -camera.y, -camera.z), confidence };
    }
    Ok(points)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn body(x: f32, levels: &str) -> String {
        format!("{{\"body_id\":3,\"joint_positions\":[{}]{levels}}}", vec![format!("[{x},-400,2500]"); 32].join(","))
    }

    fn line(usec: u64, x: f32, levels: &str) -> String {
        format!("{{\"frame_id\":0,\"timestamp_usec\":{usec},\"num_bodies\":1,\"bodies\":[{}]}}", body(x, levels))
    }

    #[test]
    fn an_object_of_frames_and_lines_of_frames_are_the_same() {
        let lines = [line(100, 10.0, ""), line(33_433, 20.0, "")];
        let object = format!("{{\"bone_list\":[],\"frames\":[{}],\"joint_names\":[]}}", lines.join(","));
        for text in [lines.join("\n"), object] {
            let frames = parse(text.as_bytes()).unwrap();
            assert_eq!((frames.len(), frames[1].timestamp_usec), (2, 33_433));
            let points = points(&frames[1].bodies[0]).unwrap();
            assert!(points[31].position.distance(Vec3::new(0.02, 0.4, -2.5)) < 1e-6);
            assert!(recognises(text.as_bytes()));
        }
    }

    #[test]
    fn levels_become_confidence_and_wrong_ones_are_refused() {
        let of = |levels: &str| {
            let frames = parse(line(0, 0.0, levels).as_bytes()).unwrap();
            points(&frames[0].bodies[0]).map(|p| [p[0].confidence, p[1].confidence])
        };
        let with = |first: &str| format!(",\"joint_confidence_levels\":[{first}{}]", ",2".repeat(31));
        assert_eq!(of(&with("1")), Ok([0.4, 1.0]));
        assert_eq!(of(""), Ok([1.0, 1.0]));
        assert!(of(&with("4")).is_err() && of(",\"joint_confidence_levels\":[2]").is_err());
    }

    #[test]
    fn what_is_no_frame_is_refused() {
        for text in ["{}", "{\"frames\":3}", "{\"timestamp_usec\":-1}", "{\"timestamp_usec\":1,\"bodies\":[{}]}"] {
            assert!(parse(text.as_bytes()).is_err(), "{text}");
        }
        assert!(read(line(u64::MAX, 0.0, "").as_bytes()).is_err());
        assert!(read(line(0, 1e9, "").as_bytes()).is_err());
    }
}
