//! Joints of a person, as a sensor or a program of the caller's own has them.

use toile_sdk::glam::Vec3;
use toile_sdk::{HandState, Joint as SdkJoint, Joints, TrackedJoint};

/// Joints of a person, and the places of toile_joints.
pub const TOILE_JOINTS: usize = 23;

/// A joint: its place in toile_joints.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Joint {
    /// Where the trunk hangs: the middle of the sacroiliac joints.
    Pelvis,
    /// Of the lowest lumbar vertebra: trunk on pelvis.
    Spine,
    /// Of the highest lumbar vertebra: rib cage on loins.
    Chest,
    /// Of the middle of the neck.
    Neck,
    /// Of skull on neck.
    Head,
    /// Of the left collar bone on the breastbone.
    LeftClavicle,
    /// Of the left upper arm.
    LeftShoulder,
    /// Of the left forearm.
    LeftElbow,
    /// Of the left hand.
    LeftWrist,
    /// The knuckle of the left middle finger.
    LeftHand,
    /// Of the left thigh.
    LeftHip,
    /// Of the left shin.
    LeftKnee,
    /// Of the left foot.
    LeftAnkle,
    /// The ball of the left foot.
    LeftToe,
    /// Of the right collar bone on the breastbone.
    RightClavicle,
    /// Of the right upper arm.
    RightShoulder,
    /// Of the right forearm.
    RightElbow,
    /// Of the right hand.
    RightWrist,
    /// The knuckle of the right middle finger.
    RightHand,
    /// Of the right thigh.
    RightHip,
    /// Of the right shin.
    RightKnee,
    /// Of the right foot.
    RightAnkle,
    /// The ball of the right foot.
    RightToe,
}

/// One joint as tracked.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct TrackedJointState {
    /// World position (m); meaningless where the confidence is 0.
    pub x: f32,
    /// Up.
    pub y: f32,
    /// Ahead of the person.
    pub z: f32,
    /// How far to believe it, 0 (absent) to 1 (seen); believed from 0.5.
    pub confidence: f32,
}

/// All joints at one moment.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct JointFrame {
    /// Time since the session began (ns).
    pub time_ns: u64,
    /// The joints, each at the place of its toile_joint.
    pub joints: [TrackedJointState; TOILE_JOINTS],
}

impl From<&JointFrame> for Joints {
    fn from(frame: &JointFrame) -> Self {
        let joint =
            |j: TrackedJointState| TrackedJoint { position: Vec3::new(j.x, j.y, j.z), confidence: j.confidence };
        Self { time_ns: frame.time_ns, joints: frame.joints.map(joint), hands: [HandState::Unknown; 2] }
    }
}

impl From<&Joints> for JointFrame {
    fn from(joints: &Joints) -> Self {
        let state = |j: TrackedJoint| {
            let [x, y, z] = j.position.to_array();
            TrackedJointState { x, y, z, confidence: j.confidence }
        };
        Self { time_ns: joints.time_ns, joints: joints.joints.map(state) }
    }
}

/// Each joint here and in the SDK, which have the same places.
const SAME: [(Joint, SdkJoint); TOILE_JOINTS] = [
    (Joint::Pelvis, SdkJoint::Pelvis),
    (Joint::Spine, SdkJoint::Spine),
    (Joint::Chest, SdkJoint::Chest),
    (Joint::Neck, SdkJoint::Neck),
    (Joint::Head, SdkJoint::Head),
    (Joint::LeftClavicle, SdkJoint::LeftClavicle),
    (Joint::LeftShoulder, SdkJoint::LeftShoulder),
    (Joint::LeftElbow, SdkJoint::LeftElbow),
    (Joint::LeftWrist, SdkJoint::LeftWrist),
    (Joint::LeftHand, SdkJoint::LeftHand),
    (Joint::LeftHip, SdkJoint::LeftHip),
    (Joint::LeftKnee, SdkJoint::LeftKnee),
    (Joint::LeftAnkle, SdkJoint::LeftAnkle),
    (Joint::LeftToe, SdkJoint::LeftToe),
    (Joint::RightClavicle, SdkJoint::RightClavicle),
    (Joint::RightShoulder, SdkJoint::RightShoulder),
    (Joint::RightElbow, SdkJoint::RightElbow),
    (Joint::RightWrist, SdkJoint::RightWrist),
    (Joint::RightHand, SdkJoint::RightHand),
    (Joint::RightHip, SdkJoint::RightHip),
    (Joint::RightKnee, SdkJoint::RightKnee),
    (Joint::RightAnkle, SdkJoint::RightAnkle),
    (Joint::RightToe, SdkJoint::RightToe),
];

const _: () = {
    let mut at = 0;
    while at < TOILE_JOINTS {
        assert!(SAME[at].0 as usize == at && SAME[at].1 as usize == at);
        at += 1;
    }
};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_frame_comes_back_as_it_went() {
        let seen = Joints::seen(17, std::array::from_fn(|i| Vec3::new(i as f32, 1.0, -0.5)));
        assert_eq!(Joints::from(&JointFrame::from(&seen)), seen);
    }
}
