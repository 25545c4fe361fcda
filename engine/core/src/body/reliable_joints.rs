//! The reliable part of one moment's joints: positions, and directions between them.

use glam::Vec3;
use toile_base::frame::Joints;
use toile_base::limits::CONFIDENCE_GATE;
use toile_base::skeleton::{JOINTS, Joint, Skeleton};

/// Joints nearer together than this (m) give no direction.
pub const MIN_BONE: f32 = 0.02;

/// Farther away than this (m) a joint is an error, not a shopper.
const MAX_RANGE: f32 = 50.0;

/// Confidence from which a joint is followed at all: what a filter holds or infers through a dropout.
const HELD: f32 = 0.2;

/// The joints of one moment that are worth following.
#[derive(Debug, Clone, Copy)]
pub struct ReliableJoints([Option<ReliableJoint>; JOINTS]);

/// Where a joint is, and whether it is seen there or only held.
#[derive(Debug, Clone, Copy)]
struct ReliableJoint {
    position: Vec3,
    believed: bool,
}

impl ReliableJoints {
    /// Drops joints that are absent and those whose position is not finite or out of reach.
    pub fn new(joints: &Joints) -> Self {
        Self(joints.joints.map(|j| {
            let near = j.position.is_finite() && j.position.abs().max_element() < MAX_RANGE;
            let shown = ReliableJoint { position: j.position, believed: j.confidence >= CONFIDENCE_GATE };
            (near && j.confidence >= HELD).then_some(shown)
        }))
    }

    /// The rest pose, as a perfect sensor would show it.
    pub fn rest(skeleton: &Skeleton) -> Self {
        Self(skeleton.rest.map(|position| Some(ReliableJoint { position, believed: true })))
    }

    /// One joint's position (m), if it has any.
    pub fn at(&self, joint: Joint) -> Option<Vec3> {
        Some(self.0[joint.index()]?.position)
    }

    /// Whether all these joints are seen, rather than held.
    pub fn believes(&self, joints: &[Joint]) -> bool {
        joints.iter().all(|j| self.0[j.index()].is_some_and(|shown| shown.believed))
    }

    /// Middle of two joints (m).
    pub fn middle(&self, a: Joint, b: Joint) -> Option<Vec3> {
        Some((self.at(a)? + self.at(b)?) * 0.5)
    }

    /// Middle of both hips (m).
    pub fn hips(&self) -> Option<Vec3> {
        self.middle(Joint::LeftHip, Joint::RightHip)
    }

    /// Unit vector from one joint to another.
    pub fn direction(&self, from: Joint, to: Joint) -> Option<Vec3> {
        unit(self.at(to)? - self.at(from)?)
    }
}

/// Unit vector, unless too short to trust.
pub fn unit(v: Vec3) -> Option<Vec3> {
    let length = v.length();
    (length > MIN_BONE).then(|| v / length)
}
