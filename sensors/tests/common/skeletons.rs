//! Small recordings of skeleton trackers, made here: a person who stands before the camera, 2.5 m away and 1 m below it.

use glam::Vec3;
use toile_base::frame::Joints;
use toile_base::skeleton::Joint;
use toile_sensors::source::joint_map::{Format, JointMap, Source};

use super::samples::standing;

/// Points of a tracker that show these joints, world axes (m); those that are none of ours lie in the chest.
fn points(format: Format, frame: &Joints) -> Vec<Vec3> {
    let map = JointMap::of(format);
    let chest = frame.at(Joint::Chest).position;
    let mut points = vec![chest; format.points()];
    for joint in Joint::ALL {
        let at = frame.at(joint).position;
        match map.source(joint) {
            Some(Source::Point(k) | Source::Beside(k)) => points[k] = at,
            // The ears, and the ends of the hand.
            Some(Source::Middle(a, b)) if matches!(joint, Joint::Head | Joint::LeftHand | Joint::RightHand) => {
                (points[a], points[b]) = (at + Vec3::X * 0.02, at - Vec3::X * 0.02);
            }
            _ => {}
        }
    }
    if format == Format::Azure32 {
        points[4] = chest + Vec3::new(0.03, 0.1, 0.0);
        points[11] = chest + Vec3::new(-0.03, 0.1, 0.0);
    }
    points
}

/// A Kinect v1 recording: spaces, milliseconds.
pub fn kinect_20(frames: u64) -> Vec<u8> {
    let mut text = String::new();
    for i in 0..frames {
        text += &format!("{}", 1000 + i * 33);
        for p in points(Format::Kinect20, &standing(0)) {
            text += &format!(" {} {} {} 2", -p.x, p.y - 1.0, 2.5 - p.z);
        }
        text += "\n";
    }
    text.into_bytes()
}

/// Azure Kinect bodies, a frame a line.
pub fn azure(frames: u64) -> Vec<u8> {
    let mut text = String::new();
    for i in 0..frames {
        let camera = |p: Vec3| format!("[{},{},{}]", 1e3 * p.x, 1e3 * (1.0 - p.y), 1e3 * (2.5 - p.z));
        let all: Vec<String> = points(Format::Azure32, &standing(0)).into_iter().map(camera).collect();
        text += &format!(
            "{{\"timestamp_usec\":{},\"num_bodies\":1,\"bodies\":[{{\"body_id\":1,\"joint_positions\":[{}]}}]}}\n",
            33_333 * i,
            all.join(",")
        );
    }
    text.into_bytes()
}

/// MediaPipe landmarks, a result a line, of a person who jumps by 0.3 m in the last frame.
pub fn mediapipe(frames: u64) -> Vec<u8> {
    let (width, height, focal) = (1280.0, 720.0, 0.87 * 1280.0);
    let mut text = String::new();
    for i in 0..frames {
        let up = if i + 1 == frames { 0.3 } else { 0.0 };
        let points = points(Format::MediaPipe33, &standing(0));
        let hips = (points[23] + points[24]) * 0.5;
        let mut image = Vec::new();
        let mut world = Vec::new();
        for p in points {
            let (x, y, z) = (p.x, 1.0 - p.y - up, 2.5 - p.z);
            let [u, v] = [0.5 + focal * x / z / width, 0.5 + focal * y / z / height];
            image.push(format!("{{\"x\":{u},\"y\":{v},\"z\":0,\"visibility\":0.99}}"));
            let q = p - hips;
            world.push(format!("{{\"x\":{},\"y\":{},\"z\":{},\"visibility\":0.99}}", q.x, -q.y, -q.z));
        }
        text += &format!(
            "{{\"timestampMs\":{},\"landmarks\":[[{}]],\"worldLandmarks\":[[{}]],\"width\":1280,\"height\":720}}\n",
            33 * i,
            image.join(","),
            world.join(",")
        );
    }
    text.into_bytes()
}
