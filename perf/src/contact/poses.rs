//! The poses in which cloth is held against the skin.

use glam::{Quat, Vec3};
use toile_assets::skeleton::{Joint, Pose, Skeleton};

/// How far from the vertical arms are that hang down (degrees): beside the hips.
const ARMS_DEGREES: f32 = 10.0;

/// How far from hanging straight down they are when they are raised (degrees).
const RAISED_DEGREES: f32 = 150.0;

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

/// Arms that are raised over the head.
pub fn arms_raised(skeleton: &Skeleton) -> Pose {
    with_arms(skeleton, RAISED_DEGREES)
}

/// Arms that hang beside the hips.
pub fn arms_down(skeleton: &Skeleton) -> Pose {
    with_arms(skeleton, ARMS_DEGREES)
}

/// Upper arms at an angle from hanging straight down (degrees), in the plane of the body.
fn with_arms(skeleton: &Skeleton, degrees: f32) -> Pose {
    let mut pose = Pose::rest(skeleton);
    let (sin, cos) = degrees.to_radians().sin_cos();
    for (shoulder, elbow) in [(Joint::LeftShoulder, Joint::LeftElbow), (Joint::RightShoulder, Joint::RightElbow)] {
        let now = skeleton.offset(elbow).normalize_or_zero();
        pose.local[shoulder.index()] = Quat::from_rotation_arc(now, Vec3::new(sin * now.x.signum(), -cos, 0.0));
    }
    pose
}

/// Hips bent by a right angle, thighs forward; arms hang.
fn bent(skeleton: &Skeleton, hips: &[Joint]) -> Pose {
    let mut pose = with_arms(skeleton, ARMS_DEGREES);
    hips.iter().for_each(|hip| pose.local[hip.index()] = Quat::from_rotation_x(-90f32.to_radians()));
    pose
}

/// Hips and knees at right angles.
pub fn sitting(skeleton: &Skeleton) -> Pose {
    let mut pose = bent(skeleton, &[Joint::LeftHip, Joint::RightHip]);
    let knees = [Joint::LeftKnee, Joint::RightKnee];
    knees.iter().for_each(|knee| pose.local[knee.index()] = Quat::from_rotation_x(90f32.to_radians()));
    pose
}

#[cfg(test)]
mod tests {
    use glam::Affine3A;
    use toile_assets::body::{Body, Measures, Sex};
    use toile_assets::skeleton::BONES;
    use toile_engine::body::palette;

    use super::*;

    #[test]
    fn limbs_are_where_the_poses_say() {
        let skeleton = Body::build(Sex::Female, &Measures::average(Sex::Female)).unwrap().skeleton;
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
