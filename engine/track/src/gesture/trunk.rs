//! The trunk's own axes, and the arm's length as the unit of everything.

use glam::Vec3;
use toile_base::clock::seconds_between;
use toile_base::frame::Joints;
use toile_base::skeleton::Joint;

/// One of the shopper's own sides.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Side {
    /// The shopper's left.
    Left,
    /// The shopper's right.
    Right,
}

impl Side {
    /// Both sides, in the order of every array over hands.
    pub const BOTH: [Self; 2] = [Self::Left, Self::Right];

    /// Shoulder, elbow, wrist and hand of this side.
    pub(crate) const fn arm(self) -> [Joint; 4] {
        use Joint::*;
        match self {
            Self::Left => [LeftShoulder, LeftElbow, LeftWrist, LeftHand],
            Self::Right => [RightShoulder, RightElbow, RightWrist, RightHand],
        }
    }

    pub(crate) const fn shoulder(self) -> Joint {
        self.arm()[0]
    }

    pub(crate) const fn wrist(self) -> Joint {
        self.arm()[2]
    }
}

/// Arms shorter or longer than this (m, shoulder over elbow to wrist) are a tracker's mistake: from a child of 1.1 m to a
/// man of 2.1 m.
const ARMS: [f32; 2] = [0.34, 0.80];

/// The arm's length is a running mean over this time (s): bones of a depth camera's skeleton wobble by a tenth.
const SETTLE_S: f32 = 1.0;

/// Running estimate of the arm's length.
#[derive(Debug, Clone, Copy)]
pub(super) struct ArmLength {
    arm: Option<(f32, u64)>,
}

impl ArmLength {
    pub(super) const fn new() -> Self {
        Self { arm: None }
    }

    /// The running mean (m).
    pub(super) fn arm(&self) -> Option<f32> {
        self.arm.map(|(length, _)| length)
    }

    /// Updates it with the arms of a frame that are believed from shoulder to wrist.
    pub(super) fn see(&mut self, joints: &Joints) {
        let length = |side: Side| {
            let [shoulder, elbow, wrist, _] = side.arm().map(|j| joints.believed(j));
            Some(shoulder?.distance(elbow?) + elbow?.distance(wrist?))
        };
        let (sum, count) = Side::BOTH.into_iter().filter_map(length).fold((0.0, 0.0), |(s, n), l| (s + l, n + 1.0));
        if count > 0.0 {
            let seen = (sum / count).clamp(ARMS[0], ARMS[1]);
            let (mean, last) = self.arm.unwrap_or((seen, joints.time_ns));
            let weight = (seconds_between(last, joints.time_ns) / SETTLE_S).clamp(0.0, 0.2);
            self.arm = Some((mean + (seen - mean) * weight, joints.time_ns));
        }
    }
}

/// Where the trunk is and which way it looks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Trunk {
    /// Middle of the shoulders, world (m).
    pub origin: Vec3,
    /// Towards the shopper's left, level, of length 1.
    pub left: Vec3,
    /// Where the chest looks, level, of length 1.
    pub forward: Vec3,
}

impl Trunk {
    /// The trunk of a frame; `None` where the shoulders are not both believed or stand one above the other.
    pub fn of(joints: &Joints) -> Option<Self> {
        let left = joints.believed(Joint::LeftShoulder)?;
        let right = joints.believed(Joint::RightShoulder)?;
        let across = (left - right) * Vec3::new(1.0, 0.0, 1.0);
        let across = across.try_normalize()?;
        Some(Self { origin: 0.5 * (left + right), left: across, forward: across.cross(Vec3::Y) })
    }

    /// A world point along the trunk's axes (m): left, up, forward of the middle of the shoulders.
    pub fn local(&self, p: Vec3) -> Vec3 {
        let d = p - self.origin;
        Vec3::new(d.dot(self.left), d.y, d.dot(self.forward))
    }
}

/// The trunk's direction is a running mean over this time (s): two shoulders a forearm's length apart jitter by degrees,
/// and a hand held out swings with them.
const TURN_S: f32 = 0.25;

/// Running mean of the trunk's direction.
#[derive(Debug, Clone, Copy)]
pub(super) struct TrunkDirection {
    left: Option<(Vec3, u64)>,
}

impl TrunkDirection {
    pub(super) const fn new() -> Self {
        Self { left: None }
    }

    /// The trunk with its direction averaged.
    pub(super) fn settled(&mut self, trunk: Trunk, now: u64) -> Trunk {
        let (mean, last) = self.left.unwrap_or((trunk.left, now));
        let weight = 1.0 - (-seconds_between(last, now) / TURN_S).exp();
        let left = mean.lerp(trunk.left, weight).try_normalize().unwrap_or(trunk.left);
        self.left = Some((left, now));
        Trunk { left, forward: left.cross(Vec3::Y), ..trunk }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use toile_base::frame::TrackedJoint;

    #[test]
    fn a_trunk_that_faces_the_camera_looks_along_z() {
        let mut joints = Joints::absent(0);
        let mut put = |joint: Joint, x: f32| {
            *joints.at_mut(joint) = TrackedJoint { position: Vec3::new(x, 1.4, 0.5), confidence: 1.0 };
        };
        put(Joint::LeftShoulder, 0.2);
        assert_eq!(Trunk::of(&joints), None);
        let mut put = |joint: Joint, x: f32| {
            *joints.at_mut(joint) = TrackedJoint { position: Vec3::new(x, 1.4, 0.5), confidence: 1.0 };
        };
        put(Joint::RightShoulder, -0.2);
        let trunk = Trunk::of(&joints).unwrap();
        assert!((trunk.forward - Vec3::Z).length() < 1e-6 && (trunk.left - Vec3::X).length() < 1e-6);
        assert!((trunk.local(Vec3::new(0.1, 1.0, 1.0)) - Vec3::new(0.1, -0.4, 0.5)).length() < 1e-6);
    }
}
