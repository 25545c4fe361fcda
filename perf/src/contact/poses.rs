//! The poses in which cloth is held against the skin.

use toile_base::skeleton::{Joint, Pose, Skeleton};
use toile_fitting::wearing::poses::{arms_down, bent, sitting, with_arms};

/// A pose by its name.
pub struct NamedPose {
    /// What it is called.
    pub name: &'static str,
    /// The pose of a skeleton.
    pub of: fn(&Skeleton) -> Pose,
}

/// The four poses.
pub const POSES: [NamedPose; 4] = [
    NamedPose { name: "T-pose", of: |skeleton| with_arms(skeleton, 90.0) },
    NamedPose { name: "arms down", of: arms_down },
    NamedPose { name: "left hip bent by 90 degrees", of: |skeleton| bent(skeleton, &[Joint::LeftHip]) },
    NamedPose { name: "sitting", of: sitting },
];

#[cfg(test)]
mod tests {
    use glam::{Affine3A, Vec3};
    use toile_base::body::{Measures, Sex};
    use toile_base::skeleton::BONES;
    use toile_engine::body::palette;

    use super::*;

    #[test]
    fn limbs_are_where_the_poses_say() {
        let skeleton = toile_assets::body::build(Sex::Female, &Measures::average(Sex::Female)).unwrap().skeleton;
        let limb = |pose: usize, from: Joint, to: Joint| {
            let mut bones = [Affine3A::IDENTITY; BONES];
            palette(&skeleton, &(POSES[pose].of)(&skeleton), &mut bones);
            let at = |joint: Joint| bones[from.index()].transform_point3(skeleton.at(joint));
            (at(to) - at(from)).normalize()
        };
        let near = |a: Vec3, b: Vec3| a.angle_between(b).to_degrees() < 12.0;
        assert!(near(limb(0, Joint::LeftShoulder, Joint::LeftElbow), Vec3::X));
        assert!(near(limb(0, Joint::RightShoulder, Joint::RightElbow), Vec3::NEG_X));
        assert!(near(limb(1, Joint::RightShoulder, Joint::RightElbow), Vec3::NEG_Y));
        assert!(near(limb(2, Joint::LeftHip, Joint::LeftKnee), Vec3::Z));
        assert!(near(limb(2, Joint::RightHip, Joint::RightKnee), Vec3::NEG_Y));
        assert!(near(limb(3, Joint::RightHip, Joint::RightKnee), Vec3::Z));
        assert!(near(limb(3, Joint::RightKnee, Joint::RightAnkle), Vec3::NEG_Y));
    }
}
