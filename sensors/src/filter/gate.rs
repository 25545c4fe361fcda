//! The confidence gate of the live filter, and a confidence for formats that have none.

use glam::Vec3;
use toile_base::numeric::statistics::quantile_of;
use toile_base::skeleton::{JOINTS, Joint};

use toile_base::clock::seconds_between;
use toile_base::frame::{Joints, TrackedJoint};
use toile_base::limits::MAX_COORDINATE;

/// Fastest that a joint moves (m/s): a thrown punch reaches 11 m/s, a swiping hand 3 m/s.
pub const MAX_JOINT_SPEED: f32 = 10.0;

/// Jump that is always allowed (m): the noise of a sensor between two frames that are close in time.
pub const FREE_JUMP: f32 = 0.10;

/// Bone lengths off by less than this fraction of the session's median are the sensor's ordinary wobble.
const GOOD_DEVIATION: f32 = 0.15;

/// Bone lengths off by more than this fraction are wrong; confidence falls linearly between, and passes the gate
/// of 0.5 at 0.275.
const BAD_DEVIATION: f32 = 0.40;

/// Joints nearer to their parent than this (m) were put there for want of anything better.
const COINCIDENT: f32 = 0.01;

/// Whether a joint that was last believed at `last` can have come to `now` within `seconds`.
pub fn is_plausible_move(last: Vec3, now: Vec3, seconds: f32) -> bool {
    last.distance(now) <= FREE_JUMP + MAX_JOINT_SPEED * seconds.max(0.0)
}

/// A frame whose joints are in the room: those whose position is NaN, infinite or farther away become absent.
pub fn in_the_room(frame: &Joints) -> Joints {
    let mut out = *frame;
    for joint in &mut out.joints {
        let near = joint.position.is_finite() && joint.position.abs().max_element() <= MAX_COORDINATE;
        if !near || joint.confidence.is_nan() {
            *joint = TrackedJoint::default();
        }
    }
    out
}

/// The nearest ancestor of a joint for which `present` holds.
pub fn anchor(joint: Joint, present: impl Fn(Joint) -> bool) -> Option<Joint> {
    let mut at = joint.parent();
    while let Some(parent) = at {
        if present(parent) {
            return Some(parent);
        }
        at = parent.parent();
    }
    None
}

/// Lowers the confidence of joints that cannot be right, for formats that say nothing about it. The rule, for each joint
/// and frame, the lowest of:
///
/// - the bone to the nearest ancestor deviates from its session median by d: 1 up to d = 0.15, falling linearly to 0 at
///   d = 0.40 (the joint farther from the pelvis is blamed);
/// - the joint lies within 1 cm of that ancestor: 0;
/// - it is [implausibly](is_plausible_move) far both from the frame before and from the frame after (a spike): 0.
///
/// A confidence that the reader has set lower is kept.
pub fn derive_confidence(frames: &mut [Joints], notes: &mut Vec<String>) {
    let medians = median_lengths(frames);
    let spikes: Vec<[bool; JOINTS]> = (0..frames.len()).map(|i| spikes(frames, i)).collect();
    let mut lowered = 0;
    for (frame, spikes) in frames.iter_mut().zip(spikes) {
        let seen = frame.joints;
        for joint in Joint::ALL {
            let derived = if spikes[joint.index()] { 0.0 } else { bone_confidence(&seen, joint, &medians) };
            let tracked = frame.at_mut(joint);
            if derived < tracked.confidence {
                lowered += usize::from(tracked.is_believed() && derived < toile_base::limits::CONFIDENCE_GATE);
                tracked.confidence = derived;
            }
        }
    }
    notes.push(format!(
        "the format has no confidence: it was derived from jumps, bone lengths and hand states, and {lowered} joint \
         positions in {} frames are not believed for their jumps or bones",
        frames.len()
    ));
}

fn bone_confidence(seen: &[TrackedJoint; JOINTS], joint: Joint, medians: &[f32; JOINTS]) -> f32 {
    let median = medians[joint.index()];
    let Some(parent) = anchor(joint, |j| seen[j.index()].confidence > 0.0) else { return 1.0 };
    let length = seen[joint.index()].position.distance(seen[parent.index()].position);
    if median <= COINCIDENT {
        return 1.0;
    }
    if length < COINCIDENT {
        return 0.0;
    }
    let deviation = (length / median - 1.0).abs();
    (1.0 - (deviation - GOOD_DEVIATION) / (BAD_DEVIATION - GOOD_DEVIATION)).clamp(0.0, 1.0)
}

fn median_lengths(frames: &[Joints]) -> [f32; JOINTS] {
    let mut medians = [0.0; JOINTS];
    for joint in Joint::ALL {
        let lengths = frames.iter().filter_map(|f| bone_length(f, joint));
        medians[joint.index()] = quantile_of(lengths, 0.5).unwrap_or(0.0);
    }
    medians
}

fn bone_length(frame: &Joints, joint: Joint) -> Option<f32> {
    let parent = anchor(joint, |j| frame.at(j).confidence > 0.0)?;
    (frame.at(joint).confidence > 0.0).then(|| frame.at(joint).position.distance(frame.at(parent).position))
}

/// Joints of frame `i` that are out of reach of both neighbouring frames.
fn spikes(frames: &[Joints], i: usize) -> [bool; JOINTS] {
    let neighbours = [i.checked_sub(1), Some(i + 1)].map(|n| n.and_then(|n| frames.get(n)));
    let mut out = [false; JOINTS];
    if let [Some(before), Some(after)] = neighbours {
        for (j, spike) in out.iter_mut().enumerate() {
            let far = |other: &Joints| {
                let seconds = seconds_between(other.time_ns, frames[i].time_ns).abs();
                !is_plausible_move(other.joints[j].position, frames[i].joints[j].position, seconds)
            };
            *spike = far(before) && far(after);
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    fn standing(ms: u64) -> Joints {
        let mut f = Joints::absent(ms * 1_000_000);
        for joint in Joint::ALL {
            let i = joint.index() as f32;
            *f.at_mut(joint) = TrackedJoint { position: Vec3::new(0.3 * i, 1.0, 0.0), confidence: 1.0 };
        }
        f
    }

    #[test]
    fn spikes_stretched_bones_and_coincident_joints_are_not_believed() {
        let mut frames: Vec<Joints> = (0..20).map(|i| standing(i * 33)).collect();
        let spike = Joint::LeftWrist;
        frames[5].at_mut(spike).position.y += 2.0;
        let elbow = frames[9].at(Joint::RightElbow).position;
        frames[9].at_mut(Joint::RightWrist).position = elbow;
        let mut notes = Vec::new();
        derive_confidence(&mut frames, &mut notes);
        assert_eq!(frames[5].at(spike).confidence, 0.0);
        assert_eq!(frames[9].at(Joint::RightWrist).confidence, 0.0);
        assert_eq!(frames[4].at(spike).confidence, 1.0);
        assert!(frames[3].joints.iter().all(|j| j.confidence == 1.0));
        assert!(notes[0].contains("20 frames"), "{notes:?}");
    }

    #[test]
    fn a_confidence_already_lower_is_kept() {
        let mut frames: Vec<Joints> = (0..5).map(|i| standing(i * 33)).collect();
        frames[2].at_mut(Joint::LeftHand).confidence = 0.4;
        derive_confidence(&mut frames, &mut Vec::new());
        assert_eq!(frames[2].at(Joint::LeftHand).confidence, 0.4);
    }

    #[test]
    fn anchor_skips_what_is_absent() {
        assert_eq!(anchor(Joint::LeftShoulder, |j| j != Joint::LeftClavicle), Some(Joint::Chest));
        assert_eq!(anchor(Joint::Pelvis, |_| true), None);
    }
}
