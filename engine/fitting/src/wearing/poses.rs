//! Poses in which clothes are tested.

use glam::{Affine3A, Quat, Vec3};
use toile_base::frame::{Joints, TrackedJoint};
use toile_base::skeleton::{BONES, Joint, Pose, Skeleton};
use toile_engine::body::palette;

/// How far from the vertical arms are that hang down (degrees): beside the hips.
const ARMS_DEGREES: f32 = 10.0;

/// How far from hanging straight down they are when they are raised (degrees).
const RAISED_DEGREES: f32 = 150.0;

/// Arms that are raised over the head.
pub fn arms_raised(skeleton: &Skeleton) -> Pose {
    with_arms(skeleton, RAISED_DEGREES)
}

/// Arms that hang beside the hips.
pub fn arms_down(skeleton: &Skeleton) -> Pose {
    with_arms(skeleton, ARMS_DEGREES)
}

/// Upper arms at an angle from hanging straight down (degrees), in the plane of the body.
pub fn with_arms(skeleton: &Skeleton, degrees: f32) -> Pose {
    let mut pose = Pose::rest(skeleton);
    let (sin, cos) = degrees.to_radians().sin_cos();
    for (shoulder, elbow) in [(Joint::LeftShoulder, Joint::LeftElbow), (Joint::RightShoulder, Joint::RightElbow)] {
        let now = skeleton.offset(elbow).normalize_or_zero();
        pose.local[shoulder.index()] = Quat::from_rotation_arc(now, Vec3::new(sin * now.x.signum(), -cos, 0.0));
    }
    pose
}

/// Hips bent by a right angle, thighs forward; arms hang.
pub fn bent(skeleton: &Skeleton, hips: &[Joint]) -> Pose {
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

/// The joints of a pose, its feet on the floor.
pub fn joints(skeleton: &Skeleton, pose: &Pose) -> Joints {
    let mut bones = [Affine3A::IDENTITY; BONES];
    palette(skeleton, pose, &mut bones);
    let at = |joint: Joint| bones[joint.index()].transform_point3(skeleton.at(joint));
    let ankles = [Joint::LeftAnkle, Joint::RightAnkle];
    let drop = ankles.into_iter().map(|ankle| at(ankle).y - skeleton.at(ankle).y).fold(f32::MAX, f32::min);
    let mut joints = Joints::absent(0);
    for joint in Joint::ALL {
        *joints.at_mut(joint) = TrackedJoint { position: at(joint) - Vec3::Y * drop, confidence: 1.0 };
    }
    joints
}

#[cfg(test)]
mod tests {
    use toile_base::body::{Measures, Sex};

    use super::*;

    #[test]
    fn limbs_are_where_the_poses_say_and_feet_on_the_floor() {
        let skeleton = toile_assets::body::build(Sex::Female, &Measures::average(Sex::Female)).unwrap().skeleton;
        let seen = |pose: Pose| {
            let seen = joints(&skeleton, &pose);
            let lowest = [Joint::LeftAnkle, Joint::RightAnkle].map(|j| seen.at(j).position.y);
            assert!((lowest[0].min(lowest[1]) - skeleton.at(Joint::LeftAnkle).y).abs() < 1e-3);
            move |from: Joint, to: Joint| (seen.at(to).position - seen.at(from).position).normalize()
        };
        let near = |a: Vec3, b: Vec3| a.angle_between(b).to_degrees() < 12.0;
        let sits = seen(sitting(&skeleton));
        assert!(near(sits(Joint::RightHip, Joint::RightKnee), Vec3::Z));
        assert!(near(sits(Joint::RightKnee, Joint::RightAnkle), Vec3::NEG_Y));
        let raised = seen(arms_raised(&skeleton));
        assert!(raised(Joint::LeftShoulder, Joint::LeftElbow).y > 0.8);
        let down = seen(arms_down(&skeleton));
        assert!(near(down(Joint::RightShoulder, Joint::RightElbow), Vec3::NEG_Y));
    }
}
