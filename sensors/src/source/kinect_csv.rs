//! Kinect v2 joints as the LabanotationSuite records them: a line a frame, 102 fields between commas.
//!
//! Field 0 is the time in ticks of 100 ns; then 25 times x, y, z (m, camera space) and the state (0 not tracked,
//! 1 inferred, 2 tracked), and a comma at the end.

use glam::Vec3;

use super::kinect2::{FROM_KINECT, KINECT_JOINTS, turned};
use super::{align, tidy};
use crate::error::{Fault, Place};
use crate::frame::{Joints, TrackedJoint};
use crate::limits::{MAX_COORDINATE, MAX_JOINT_FRAMES};
use crate::session::{Session, too_many};

const NUMBERS: usize = 1 + 4 * KINECT_JOINTS;

/// Confidence of each tracking state: inferred lies below the gate of 0.5, for the sensor has not seen it.
const STATE_CONFIDENCE: [f32; 3] = [0.0, 0.4, 1.0];

const CURE: &str = "record it again, or delete that line";

pub(super) fn read(bytes: &[u8]) -> Result<Session, Fault> {
    let text = std::str::from_utf8(bytes)
        .map_err(|e| Fault::new(Place::Byte(e.valid_up_to() as u64), "not text", "give the file as recorded"))?;
    let mut frames = Vec::new();
    for (i, line) in text.trim_start_matches('\u{feff}').lines().enumerate() {
        if line.trim().is_empty() {
            continue;
        }
        if frames.len() == MAX_JOINT_FRAMES {
            return Err(too_many(frames.len() + 1));
        }
        frames.push(frame(line).map_err(|problem| Fault::new(Place::Line(i + 1), problem, CURE))?);
    }
    let mut notes = Vec::new();
    let mut joints = tidy::tidy(frames, &mut notes)?;
    align::to_world(&mut joints, &mut notes)?;
    Ok(Session { joints, notes, raw_scale_known: true, ..Session::default() })
}

fn frame(line: &str) -> Result<Joints, String> {
    let mut fields = [""; NUMBERS];
    let mut count = 0;
    for field in line.trim().trim_end_matches(',').split(',') {
        if count < NUMBERS {
            fields[count] = field.trim();
        }
        count += 1;
    }
    if count != NUMBERS {
        return Err(format!("{count} fields where a Kinect v2 frame has {NUMBERS}"));
    }
    let ticks: u64 = fields[0].parse().map_err(|_| format!("the time '{}' is not a tick count", clip(fields[0])))?;
    let time_ns = ticks.checked_mul(100).ok_or("the time is beyond any clock")?;
    let mut joints = Joints::absent(time_ns);
    for (kinect, joint) in FROM_KINECT {
        let at = 1 + 4 * kinect;
        let camera = Vec3::new(number(fields[at])?, number(fields[at + 1])?, number(fields[at + 2])?);
        let confidence = match fields[at + 3] {
            "0" => STATE_CONFIDENCE[0],
            "1" => STATE_CONFIDENCE[1],
            "2" => STATE_CONFIDENCE[2],
            other => return Err(format!("the tracking state '{}' is none of 0, 1, 2", clip(other))),
        };
        *joints.at_mut(joint) = TrackedJoint { position: turned(camera), confidence };
    }
    Ok(joints)
}

fn number(field: &str) -> Result<f32, String> {
    match field.parse::<f32>() {
        Ok(x) if x.is_finite() && x.abs() <= MAX_COORDINATE => Ok(x),
        _ => Err(format!("'{}' is not a coordinate in metres", clip(field))),
    }
}

/// The begin of a field, short enough for a sentence.
fn clip(field: &str) -> &str {
    let end = field.char_indices().nth(20).map_or(field.len(), |(i, _)| i);
    &field[..end]
}

#[cfg(test)]
mod tests {
    use super::*;
    use toile_assets::skeleton::Joint;

    fn line(ticks: &str, x: &str, state: &str) -> String {
        let mut line = format!("{ticks},");
        for _ in 0..KINECT_JOINTS {
            line.push_str(&format!("{x},0.5,2.0,{state},"));
        }
        line
    }

    #[test]
    fn states_become_confidence_and_axes_turn() {
        let joints = frame(&line("10", "-0.25", "1")).unwrap();
        assert_eq!(joints.time_ns, 1000);
        let shoulder = joints.at(Joint::LeftShoulder);
        assert_eq!(shoulder.position, Vec3::new(0.25, 0.5, -2.0));
        assert_eq!(shoulder.confidence, 0.4);
        assert_eq!(joints.at(Joint::LeftClavicle).confidence, 0.0);
    }

    #[test]
    fn wrong_fields_are_named() {
        for (ticks, x, state) in [("10", "nan", "2"), ("10", "inf", "2"), ("10", "1e9", "2"), ("10", "0", "3")] {
            assert!(frame(&line(ticks, x, state)).is_err());
        }
        assert!(frame(&line("-1", "0", "2")).is_err());
        assert!(frame(&line("99999999999999999999", "0", "2")).is_err());
        assert!(frame("1,2,3,").unwrap_err().contains("3 fields"));
    }
}
