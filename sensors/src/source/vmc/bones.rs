//! Unity's humanoid bones, and where each stands in the world.

use glam::{Affine3A, Quat, Vec3};
use toile_base::skeleton::{JOINTS, Joint};

use crate::source::joint_map;
use toile_base::frame::{Joints, TrackedJoint};

/// The bones that a body is made of, each with its parent, parents first. Fingers, eyes and jaw move
/// nothing of ours, but for the knuckle of the middle finger, which is the end of the hand.
const BONES: [(&str, Option<usize>); COUNT] = [
    ("Hips", None),
    ("Spine", Some(0)),
    ("Chest", Some(1)),
    ("UpperChest", Some(2)),
    ("Neck", Some(3)),
    ("Head", Some(4)),
    ("LeftShoulder", Some(3)),
    ("LeftUpperArm", Some(6)),
    ("LeftLowerArm", Some(7)),
    ("LeftHand", Some(8)),
    ("LeftMiddleProximal", Some(9)),
    ("RightShoulder", Some(3)),
    ("RightUpperArm", Some(11)),
    ("RightLowerArm", Some(12)),
    ("RightHand", Some(13)),
    ("RightMiddleProximal", Some(14)),
    ("LeftUpperLeg", Some(0)),
    ("LeftLowerLeg", Some(16)),
    ("LeftFoot", Some(17)),
    ("LeftToes", Some(18)),
    ("RightUpperLeg", Some(0)),
    ("RightLowerLeg", Some(20)),
    ("RightFoot", Some(21)),
    ("RightToes", Some(22)),
];

/// Bones of a body.
pub const COUNT: usize = 24;

/// A bone relative to its parent, in our axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Local {
    /// From the parent (m).
    pub position: Vec3,
    /// Rotation from the parent, a unit quaternion.
    pub turn: Quat,
}

/// The bone that a name means; case does not count.
pub fn bone(name: &str) -> Option<usize> {
    BONES.iter().position(|(bone, _)| bone.eq_ignore_ascii_case(name))
}

/// The bone of each of our joints, the better of two that are there.
#[derive(Debug, Clone)]
pub struct BoneMap([[Option<u8>; 2]; JOINTS]);

impl BoneMap {
    /// From the joint map.
    pub fn new() -> Self {
        let mut map = [[None; 2]; JOINTS];
        for (joint, name) in joint_map::vmc_bones() {
            let places: &mut [Option<u8>; 2] = &mut map[joint.index()];
            if let (Some(place), Some(bone)) = (places.iter_mut().find(|p| p.is_none()), bone(name)) {
                *place = Some(bone as u8);
            }
        }
        Self(map)
    }

    /// Joints of the bones that are there (m, world); those that are not carry nothing and are skipped.
    pub fn joints(&self, time_ns: u64, root: Local, bones: &[Option<Local>; COUNT]) -> Joints {
        let mut world = [Affine3A::IDENTITY; COUNT];
        let root = Affine3A::from_rotation_translation(root.turn, root.position);
        for (i, (_, parent)) in BONES.iter().enumerate() {
            let from = parent.map_or(root, |p| world[p]);
            world[i] = match bones[i] {
                Some(bone) => from * Affine3A::from_rotation_translation(bone.turn, bone.position),
                None => from,
            };
        }
        let mut out = Joints::absent(time_ns);
        for joint in Joint::ALL {
            let there = self.0[joint.index()].into_iter().flatten().map(usize::from).find(|b| bones[*b].is_some());
            if let Some(bone) = there {
                *out.at_mut(joint) = TrackedJoint { position: world[bone].translation.into(), confidence: 1.0 };
            }
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parents_come_first_and_every_joint_has_its_bone() {
        assert!(BONES.iter().enumerate().all(|(i, (_, parent))| parent.is_none_or(|p| p < i)));
        let map = BoneMap::new();
        assert!(Joint::ALL.into_iter().all(|j| map.0[j.index()][0].is_some()));
        assert_eq!(bone("leftshoulder"), Some(6));
        assert_eq!(bone("LeftEye"), None);
        assert_eq!(map.0[Joint::LeftClavicle.index()], [Some(6), None]);
        assert_eq!(map.0[Joint::Chest.index()], [Some(2), Some(3)]);
    }

    #[test]
    fn bones_that_are_absent_are_skipped_in_the_chain() {
        let mut bones = [None; COUNT];
        let up = |y: f32| Some(Local { position: Vec3::Y * y, turn: Quat::IDENTITY });
        (bones[0], bones[1], bones[5]) = (up(1.0), up(0.2), up(0.5));
        let root = Local { position: Vec3::X, turn: Quat::from_rotation_y(1.0) };
        let joints = BoneMap::new().joints(3, root, &bones);
        assert!(joints.at(Joint::Head).position.distance(Vec3::new(1.0, 1.7, 0.0)) < 1e-6);
        assert_eq!(joints.at(Joint::Neck).confidence, 0.0);
    }
}
