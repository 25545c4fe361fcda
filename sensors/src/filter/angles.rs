//! Asymptotic smoothing of bone directions: each frame a bone turns a fraction of the axis-angle step that is left
//! (Gultepe 2013, section 4.4.2, eq. 4.6), its length kept as seen.
//!
//! The published fraction is a constant a frame; here it is `1 - exp(-dt / tau)`, so that it means the same at any rate.
//! The posed body does the same to joint rotations; this is the form for positions.

use glam::{Quat, Vec3};
use toile_base::skeleton::{JOINTS, Joint};

use super::Filter;
use super::gate::{anchor, in_the_room};
use toile_base::clock::seconds_between;
use toile_base::frame::Joints;

/// Shortest bone that has a direction (m).
const SHORTEST: f32 = 1e-3;

/// The directions of all bones. The pelvis, and what has no parent, stays where it is seen.
#[derive(Debug, Clone)]
pub struct AngleFilter {
    /// Time constant (s).
    tau: f32,
    last_ns: Option<u64>,
    /// Unit, from the nearest ancestor that is present; `None` before it was seen.
    directions: [Option<Vec3>; JOINTS],
}

impl AngleFilter {
    /// Smoothing with a time constant (s).
    pub fn new(tau: f32) -> Self {
        Self { tau, last_ns: None, directions: [None; JOINTS] }
    }
}

impl Filter for AngleFilter {
    fn push(&mut self, frame: &Joints) -> Joints {
        let dt = self.last_ns.map_or(0.0, |last| seconds_between(last, frame.time_ns)).max(0.0);
        self.last_ns = Some(frame.time_ns);
        let share = 1.0 - (-dt / self.tau).exp();
        let frame = in_the_room(frame);
        let mut out = frame;
        for joint in Joint::ALL {
            let tracked = *frame.at(joint);
            let there = |j: Joint| frame.at(j).confidence > 0.0;
            let Some(parent) = anchor(joint, there).filter(|_| there(joint)) else { continue };
            let bone = tracked.position - frame.at(parent).position;
            let length = bone.length();
            if length < SHORTEST {
                out.at_mut(joint).position = out.at(parent).position + bone;
                continue;
            }
            let seen = bone / length;
            let direction = self.directions[joint.index()].map_or(seen, |last| turned(last, seen, share));
            self.directions[joint.index()] = Some(direction);
            out.at_mut(joint).position = out.at(parent).position + direction * length;
        }
        out
    }

    fn reset(&mut self) {
        *self = Self::new(self.tau);
    }
}

/// A direction (unit) turned a share of the angle towards another.
fn turned(from: Vec3, to: Vec3, share: f32) -> Vec3 {
    let turn = Quat::IDENTITY.slerp(Quat::from_rotation_arc(from, to), share);
    (turn * from).normalize_or(to)
}

#[cfg(test)]
mod tests {
    use super::*;
    use toile_base::frame::TrackedJoint;

    fn arm(ms: u64, angle: f32) -> Joints {
        let mut f = Joints::absent(ms * 1_000_000);
        let mut put = |joint, position| *f.at_mut(joint) = TrackedJoint { position, confidence: 1.0 };
        put(Joint::LeftShoulder, Vec3::Y);
        put(Joint::LeftElbow, Vec3::Y + Vec3::new(angle.cos(), angle.sin(), 0.0) * 0.3);
        f
    }

    #[test]
    fn a_turn_is_approached_by_the_same_share_of_what_is_left_and_the_bone_keeps_its_length() {
        let mut filter = AngleFilter::new(0.1);
        filter.push(&arm(0, 0.0));
        for i in 1..10 {
            let out = filter.push(&arm(i * 50, 1.0));
            let bone = out.at(Joint::LeftElbow).position - Vec3::Y;
            let left = 1.0 - bone.y.atan2(bone.x);
            assert!((left - (-0.5 * i as f32).exp()).abs() < 1e-4 && (bone.length() - 0.3).abs() < 1e-5, "{left}");
        }
    }

    #[test]
    fn what_is_not_finite_is_absent_and_time_may_stand_still() {
        let mut filter = AngleFilter::new(0.1);
        let mut bad = arm(0, 0.0);
        bad.at_mut(Joint::LeftElbow).position.x = f32::NAN;
        bad.at_mut(Joint::Head).position = Vec3::splat(f32::INFINITY);
        for f in [arm(10, 0.0), bad, arm(10, 1.0), arm(0, 3.1)] {
            assert!(filter.push(&f).is_valid());
        }
    }
}
