//! The one skeleton that all crates share: joint names, parents, and the pose that bends them.
//!
//! Right-handed, y up, metres. The person faces +z, so their left side is +x. In the rest pose every bone's frame is
//! aligned with the world's axes: a bone's rest transform is a translation.

mod bones;
mod joint;
mod names;

use glam::{Quat, Vec3};

pub use bones::{BONE_CHAIN, BONES, TWISTS, Twist, bone_joint, bone_name};
pub use joint::{JOINTS, Joint};

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
