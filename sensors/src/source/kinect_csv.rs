//! Kinect joints as text, a line a frame: the time, then x, y, z (m, camera space) and the state (0 not tracked,
//! 1 inferred, 2 tracked) of each joint.
//!
//! The count of numbers says which of two kinds it is. Kinect v2 as the LabanotationSuite records it: 25 joints, commas,
//! one more at the end, time in ticks of 100 ns. Kinect v1 as the MSRC-12 recordings have it: 20 joints, spaces or
//! commas, time in ticks, microseconds or milliseconds, whichever comes nearest to the sensor's 30 frames a second.

use glam::Vec3;

use super::joint_map::{Format, JointMap};
use super::kinect2::turned;
use super::{align, tidy};
use crate::error::{FilePlace, ReaderFault};
use crate::limits::MAX_JOINT_FRAMES;
use crate::session::{Session, too_many};
use toile_base::frame::{Joints, TrackedJoint};
use toile_base::limits::MAX_COORDINATE;

/// Most joints of a line.
const MOST_JOINTS: usize = Format::Kinect25.points();

const MOST_NUMBERS: usize = 1 + 4 * MOST_JOINTS;

/// Confidence of each tracking state: inferred lies below the gate of 0.5, for the sensor has not seen it.
const STATE_CONFIDENCE: [f32; 3] = [0.0, 0.4, 1.0];

/// Units of time that a Kinect v1 file may count in (ns): ticks, microseconds, milliseconds.
const UNITS_NS: [u64; 3] = [100, 1_000, 1_000_000];

/// Period of a Kinect (ns).
const PERIOD_NS: f64 = 1e9 / 30.0;

const CURE: &str = "record it again, or delete that line";

pub(super) fn read(bytes: &[u8]) -> Result<Session, ReaderFault> {
    let text = std::str::from_utf8(bytes).map_err(|e| {
        ReaderFault::new(FilePlace::Byte(e.valid_up_to() as u64), "not text", "give the file as recorded")
    })?;
    let lines = text.trim_start_matches('\u{feff}').lines().enumerate().filter(|(_, line)| !line.trim().is_empty());
    let mut frames = Vec::new();
    let mut kind: Option<(Format, JointMap)> = None;
    for (i, line) in lines {
        if frames.len() == MAX_JOINT_FRAMES {
            return Err(too_many(frames.len() + 1));
        }
        let (format, map) = kind.get_or_insert_with(|| {
            let format = format_of(line);
            (format, JointMap::of(format))
        });
        frames.push(
            frame(line, *format, map).map_err(|problem| ReaderFault::new(FilePlace::Line(i + 1), problem, CURE))?,
        );
    }
    let mut notes = Vec::new();
    let unit = match kind {
        Some((Format::Kinect20, _)) => unit_ns(&frames, &mut notes),
        _ => UNITS_NS[0],
    };
    for (i, frame) in frames.iter_mut().enumerate() {
        let beyond = || ReaderFault::new(FilePlace::Frame(i), "the time is beyond any clock", CURE);
        frame.time_ns = frame.time_ns.checked_mul(unit).ok_or_else(beyond)?;
    }
    let mut joints = tidy::tidy(frames, &mut notes)?;
    align::to_world(&mut joints, &mut notes)?;
    Ok(Session { joints, notes, raw_scale_known: true, ..Session::default() })
}

/// What a line is, by its count of numbers; taken for the newer sensor's where it is neither's.
fn format_of(line: &str) -> Format {
    if fields(line).count() == 1 + 4 * Format::Kinect20.points() { Format::Kinect20 } else { Format::Kinect25 }
}

/// The fields of a line, parted by commas, or by spaces where it has no comma.
fn fields(line: &str) -> impl Iterator<Item = &str> {
    let line = line.trim().trim_end_matches(',');
    let comma = line.contains(',');
    line.split(move |c: char| if comma { c == ',' } else { c.is_whitespace() })
        .map(str::trim)
        .filter(move |field| comma || !field.is_empty())
}

/// The unit in which the times, as counted in the file, come nearest to 30 frames a second.
fn unit_ns(frames: &[Joints], notes: &mut Vec<String>) -> u64 {
    let mut steps: Vec<u64> = frames.windows(2).filter_map(|w| w[1].time_ns.checked_sub(w[0].time_ns)).collect();
    steps.sort_unstable();
    let step = steps.get(steps.len() / 2).copied().unwrap_or(0).max(1) as f64;
    let off = |unit: u64| (step * unit as f64 / PERIOD_NS).ln().abs();
    let unit = UNITS_NS.into_iter().min_by(|a, b| off(*a).total_cmp(&off(*b))).unwrap_or(UNITS_NS[0]);
    notes.push(format!("times are taken to count {unit} ns, which comes nearest to the sensor's 30 frames a second"));
    unit
}

/// One frame, its time as counted in the file.
fn frame(line: &str, format: Format, map: &JointMap) -> Result<Joints, String> {
    let numbers = 1 + 4 * format.points();
    let mut all = [""; MOST_NUMBERS];
    let mut count = 0;
    for field in fields(line) {
        if count < numbers {
            all[count] = field;
        }
        count += 1;
    }
    if count != numbers {
        return Err(format!("{count} fields where a frame of {} Kinect joints has {numbers}", format.points()));
    }
    let count = all[0].parse().map_err(|_| format!("the time '{}' is not a tick count", clip(all[0])))?;
    let mut points = [TrackedJoint::default(); MOST_JOINTS];
    for (point, at) in points.iter_mut().zip(all[1..numbers].chunks_exact(4)) {
        let camera = Vec3::new(number(at[0])?, number(at[1])?, number(at[2])?);
        let confidence = match at[3] {
            "0" => STATE_CONFIDENCE[0],
            "1" => STATE_CONFIDENCE[1],
            "2" => STATE_CONFIDENCE[2],
            other => return Err(format!("the tracking state '{}' is not 0, 1 or 2", clip(other))),
        };
        *point = TrackedJoint { position: turned(camera), confidence };
    }
    Ok(map.joints(count, &points))
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
    use toile_base::skeleton::Joint;

    fn line(ticks: &str, x: &str, state: &str, joints: usize) -> String {
        let mut line = format!("{ticks},");
        for _ in 0..joints {
            line.push_str(&format!("{x},0.5,2.0,{state},"));
        }
        line
    }

    fn read_one(line: &str) -> Result<Joints, String> {
        let format = format_of(line);
        frame(line, format, &JointMap::of(format))
    }

    #[test]
    fn states_become_confidence_and_axes_turn() {
        let joints = read_one(&line("10", "-0.25", "1", 25)).unwrap();
        assert_eq!(joints.time_ns, 10);
        let shoulder = joints.at(Joint::LeftShoulder);
        assert_eq!(shoulder.position, Vec3::new(0.25, 0.5, -2.0));
        assert_eq!(shoulder.confidence, 0.4);
        assert_eq!(joints.at(Joint::LeftClavicle).confidence, 0.0);
    }

    #[test]
    fn twenty_joints_are_those_of_the_first_sensor_in_either_form() {
        let commas = line("33", "-0.25", "2", 20);
        let spaces = commas.replace(',', " ");
        let joints = read_one(&commas).unwrap();
        assert_eq!(joints, read_one(&spaces).unwrap());
        assert_eq!(joints.at(Joint::RightToe).confidence, 1.0);
        assert_eq!(joints.at(Joint::Neck).confidence, 0.0);
        assert_eq!(joints.at(Joint::Chest).confidence, 1.0);
    }

    #[test]
    fn the_unit_of_time_is_the_one_that_gives_30_frames_a_second() {
        for (step, unit) in [(333_333, 100), (33_333, 1_000), (33, 1_000_000)] {
            let frames: Vec<Joints> = (0..9).map(|i| Joints::absent(i * step)).collect();
            assert_eq!(unit_ns(&frames, &mut Vec::new()), unit);
        }
    }

    #[test]
    fn wrong_fields_are_named() {
        for (ticks, x, state) in [("10", "nan", "2"), ("10", "inf", "2"), ("10", "1e9", "2"), ("10", "0", "3")] {
            assert!(read_one(&line(ticks, x, state, 25)).is_err());
            assert!(read_one(&line(ticks, x, state, 20)).is_err());
        }
        assert!(read_one(&line("-1", "0", "2", 25)).is_err());
        assert!(read_one(&line("99999999999999999999", "0", "2", 25)).is_err());
        assert!(read_one("1,2,3,").unwrap_err().contains("3 fields"));
    }
}
