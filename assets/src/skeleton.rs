//! The one skeleton that all crates share: joint names, parents, and the pose that bends them.
//!
//! Right-handed, y up, metres. The person faces +z, so their left side is +x. In the rest pose every bone's frame is
//! aligned with the world's axes: a bone's rest transform is a translation.
//!
//! Reads: nothing. Writes: joints, bones and poses that every room shares. Budget: a pose is copied, nothing is allocated.
//! Thread: any.

mod bones;
mod names;

use glam::{Quat, Vec3};

pub use bones::{BONE_CHAIN, BONES, TWISTS, Twist, bone_joint, bone_mirror, bone_name};

/// Joints that a sensor may report and a pose may bend; each is the centre of the rotation that it names.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[repr(u8)]
pub enum Joint {
    /// Root of the trunk: the middle of the sacroiliac joints.
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
    /// The knuckle of the left middle finger, where the fingers begin.
    LeftHand,
    /// Of the left thigh.
    LeftHip,
    /// Of the left shin.
    LeftKnee,
    /// Of the left foot.
    LeftAnkle,
    /// The ball of the left foot, where the toes begin.
    LeftToe,
    /// Of the right collar bone on the breastbone.
    RightClavicle,
    /// Of the right upper arm.
    RightShoulder,
    /// Of the right forearm.
    RightElbow,
    /// Of the right hand.
    RightWrist,
    /// The knuckle of the right middle finger, where the fingers begin.
    RightHand,
    /// Of the right thigh.
    RightHip,
    /// Of the right shin.
    RightKnee,
    /// Of the right foot.
    RightAnkle,
    /// The ball of the right foot, where the toes begin.
    RightToe,
}

/// Number of joints.
pub const JOINTS: usize = 23;

impl Joint {
    /// All joints, parents before children.
    pub const ALL: [Self; JOINTS] = {
        use Joint::*;
        [
            Pelvis,
            Spine,
            Chest,
            Neck,
            Head,
            LeftClavicle,
            LeftShoulder,
            LeftElbow,
            LeftWrist,
            LeftHand,
            LeftHip,
            LeftKnee,
            LeftAnkle,
            LeftToe,
            RightClavicle,
            RightShoulder,
            RightElbow,
            RightWrist,
            RightHand,
            RightHip,
            RightKnee,
            RightAnkle,
            RightToe,
        ]
    };

    /// The joint's place in every `[_; JOINTS]` array.
    pub const fn index(self) -> usize {
        self as usize
    }

    /// The parent joint; `None` for the pelvis.
    pub const fn parent(self) -> Option<Self> {
        use Joint::*;
        Some(match self {
            Pelvis => return None,
            Spine | LeftHip | RightHip => Pelvis,
            Chest => Spine,
            Neck | LeftClavicle | RightClavicle => Chest,
            Head => Neck,
            LeftShoulder => LeftClavicle,
            LeftElbow => LeftShoulder,
            LeftWrist => LeftElbow,
            LeftHand => LeftWrist,
            LeftKnee => LeftHip,
            LeftAnkle => LeftKnee,
            LeftToe => LeftAnkle,
            RightShoulder => RightClavicle,
            RightElbow => RightShoulder,
            RightWrist => RightElbow,
            RightHand => RightWrist,
            RightKnee => RightHip,
            RightAnkle => RightKnee,
            RightToe => RightAnkle,
        })
    }

    /// The same joint on the other side; joints of the midline are their own mirror.
    pub const fn mirror(self) -> Self {
        let i = self as usize;
        if i < 5 {
            self
        } else if i < 14 {
            Self::ALL[i + 9]
        } else {
            Self::ALL[i - 9]
        }
    }
}

/// Where the joints of one body lie in its rest pose.
#[derive(Debug, Clone, PartialEq)]
pub struct Skeleton {
    /// Rest position of each joint, world (m) `[JOINTS]`; the floor is y = 0.
    pub rest: [Vec3; JOINTS],
}

impl Skeleton {
    /// Rest position of one joint, world (m).
    pub fn at(&self, joint: Joint) -> Vec3 {
        self.rest[joint.index()]
    }

    /// Vector from a joint's parent to the joint in the rest pose (m); the pelvis' is its position.
    pub fn offset(&self, joint: Joint) -> Vec3 {
        match joint.parent() {
            Some(parent) => self.at(joint) - self.at(parent),
            None => self.at(joint),
        }
    }

    /// Rest position of each bone's origin (m) `[BONES]`: the joints, then the twist bones along their limbs.
    pub fn bone_origins(&self) -> [Vec3; BONES] {
        let mut origins = [Vec3::ZERO; BONES];
        origins[..JOINTS].copy_from_slice(&self.rest);
        for twist in &TWISTS {
            for (k, bone) in twist.bones().enumerate() {
                origins[bone] = self.at(twist.from).lerp(self.at(twist.to), twist.share(k + 1));
            }
        }
        origins
    }
}

/// How the skeleton is bent at one moment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pose {
    /// World position of the pelvis (m).
    pub root: Vec3,
    /// Rotation of each joint relative to its parent `[JOINTS]`; identity is the rest pose.
    pub local: [Quat; JOINTS],
}

impl Pose {
    /// The rest pose of a skeleton.
    pub fn rest(skeleton: &Skeleton) -> Self {
        Self { root: skeleton.at(Joint::Pelvis), local: [Quat::IDENTITY; JOINTS] }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parents_come_before_children_and_mirrors_return() {
        for (i, joint) in Joint::ALL.into_iter().enumerate() {
            assert_eq!(joint.index(), i);
            assert!(joint.parent().is_none_or(|p| p.index() < i));
            assert_eq!(joint.mirror().mirror(), joint);
            assert_eq!(joint.parent().map(Joint::mirror), joint.mirror().parent());
        }
    }
}
