//! The joint angles that pose a body: joint, axis, range, and the prior of a standing person.

use glam::{Quat, Vec3};
use toile_base::skeleton::{JOINTS, Joint, Skeleton};

/// One angle of the pose.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct JointAngle {
    /// The joint that rotates.
    pub joint: Joint,
    /// Axis in the parent's frame (unit).
    pub axis: Vec3,
    /// Least and greatest angle, counted from the rest pose (rad).
    pub range: [f32; 2],
    /// Mean angle of a standing person (rad).
    pub usual: f32,
    /// Standard deviation about that mean (rad).
    pub spread: f32,
}

/// Number of angles.
pub const ANGLES: usize = 41;

/// Axes of the rest pose; positive about x is forwards (or down), about y to the left, about z the left side up.
const AXES: [Vec3; 3] = [Vec3::X, Vec3::Y, Vec3::Z];

/// A ball joint of the middle or of the left: range and standard deviation about each axis (degrees), after the
/// ranges of `toile_engine::body::limits`; a deviation of 0 marks an axis without rotation.
struct BallJoint {
    joint: Joint,
    range: [[f32; 2]; 3],
    spread: [f32; 3],
}

const fn ball(joint: Joint, range: [[f32; 2]; 3], spread: [f32; 3]) -> BallJoint {
    BallJoint { joint, range, spread }
}

const FREE: [f32; 2] = [-180.0, 180.0];

const BALLS: [BallJoint; 9] = [
    ball(Joint::Pelvis, [FREE, FREE, FREE], [8.0, 360.0, 6.0]),
    ball(Joint::Spine, [[-20.0, 60.0], [-35.0, 35.0], [-28.0, 28.0]], [7.0, 6.0, 5.0]),
    ball(Joint::Chest, [[-20.0, 60.0], [-35.0, 35.0], [-28.0, 28.0]], [7.0, 6.0, 5.0]),
    ball(Joint::Neck, [[-45.0, 50.0], [-60.0, 60.0], [-45.0, 45.0]], [9.0, 15.0, 8.0]),
    ball(Joint::Head, [[-30.0, 30.0], [0.0; 2], [0.0; 2]], [7.0, 0.0, 0.0]),
    ball(Joint::LeftClavicle, [[0.0; 2], [-25.0, 25.0], [-15.0, 40.0]], [0.0, 7.0, 7.0]),
    ball(Joint::LeftShoulder, [[-110.0, 110.0], [-95.0, 95.0], [-130.0, 110.0]], [35.0, 35.0, 50.0]),
    ball(Joint::LeftWrist, [[-45.0, 45.0], [0.0; 2], [-60.0, 60.0]], [10.0, 0.0, 14.0]),
    ball(Joint::LeftHip, [[-120.0, 30.0], [-45.0, 60.0], [-30.0, 60.0]], [12.0, 14.0, 10.0]),
];

const ANKLE: BallJoint = ball(Joint::LeftAnkle, [[-35.0, 60.0], [-25.0, 25.0], [0.0; 2]], [8.0, 8.0, 0.0]);

/// Range, usual angle and spread of the elbow's and the knee's bend (degrees).
const ELBOW: [f32; 4] = [-10.0, 150.0, 12.0, 45.0];
const KNEE: [f32; 4] = [-10.0, 155.0, 2.0, 10.0];

/// Angle of a hanging arm from the vertical (rad).
const HANGING: f32 = 0.2;

/// The angles of a skeleton, joint by joint in the order of [`Joint::ALL`].
pub fn joint_angles(rest: &Skeleton) -> [JointAngle; ANGLES] {
    let mut all = Vec::with_capacity(ANGLES);
    for joint in Joint::ALL {
        let left = if joint.mirror() < joint { joint.mirror() } else { joint };
        match left {
            Joint::LeftElbow => all.push(hinge(rest, joint, Joint::LeftShoulder, Joint::LeftWrist, Vec3::Z, ELBOW)),
            Joint::LeftKnee => all.push(hinge(rest, joint, Joint::LeftHip, Joint::LeftAnkle, Vec3::NEG_Z, KNEE)),
            _ => {
                if let Some(ball) = BALLS.iter().chain([&ANKLE]).find(|b| b.joint == left) {
                    all.extend(ball_angles(rest, joint, ball));
                }
            }
        }
    }
    std::array::from_fn(|i| all[i])
}

fn ball_angles(rest: &Skeleton, joint: Joint, ball: &BallJoint) -> Vec<JointAngle> {
    let mirrored = ball.joint != joint;
    let about = (0..3).filter(|&k| ball.spread[k] > 0.0);
    about
        .map(|k| {
            let [least, most] = ball.range[k].map(f32::to_radians);
            let range = if mirrored && k > 0 { [-most, -least] } else { [least, most] };
            let usual = if ball.joint == Joint::LeftShoulder && k == 2 { hanging(rest, joint, HANGING) } else { 0.0 };
            JointAngle { joint, axis: AXES[k], range, usual, spread: ball.spread[k].to_radians() }
        })
        .collect()
}

fn hinge(rest: &Skeleton, joint: Joint, root: Joint, end: Joint, bends: Vec3, figures: [f32; 4]) -> JointAngle {
    let side = |j: Joint| if joint.mirror() < joint { j.mirror() } else { j };
    let upper = (rest.at(joint) - rest.at(side(root))).normalize_or(Vec3::NEG_Y);
    let lower = (rest.at(side(end)) - rest.at(joint)).normalize_or(upper);
    let axis = upper.cross(bends).normalize_or(Vec3::X);
    let bent = axis.dot(upper.cross(lower)).atan2(upper.dot(lower));
    let [least, most, usual, spread] = figures.map(f32::to_radians);
    JointAngle { joint, axis, range: [least - bent, most - bent], usual: usual - bent, spread }
}

/// The rotation about z that brings a shoulder's arm from the rest pose to an angle from the vertical (rad).
pub fn hanging(rest: &Skeleton, shoulder: Joint, angle: f32) -> f32 {
    let elbow = if shoulder == Joint::LeftShoulder { Joint::LeftElbow } else { Joint::RightElbow };
    let arm = rest.at(elbow) - rest.at(shoulder);
    (angle - arm.x.abs().atan2(-arm.y)) * arm.x.signum()
}

/// The angle of a pose about one of its axes (rad).
pub fn angle(local: &[Quat; JOINTS], turn: &JointAngle) -> f32 {
    let q = local[turn.joint.index()];
    let q = if q.w < 0.0 { -q } else { q };
    q.to_scaled_axis().dot(turn.axis)
}

#[cfg(test)]
mod tests {
    use super::*;
    use toile_assets::body::shape::Shapes;
    use toile_base::body::Sex;

    #[test]
    fn both_sides_turn_alike_and_a_standing_arm_hangs() {
        let shapes = Shapes::of(Sex::Female);
        let rest = shapes.skeleton(shapes.mean());
        let all = joint_angles(&rest);
        for t in &all {
            assert!(t.range[0] <= t.usual && t.usual <= t.range[1] && t.spread > 0.0, "{t:?}");
            assert!(all.iter().any(|o| o.joint == t.joint.mirror()));
        }
        for shoulder in [Joint::LeftShoulder, Joint::RightShoulder] {
            let turn = all.iter().find(|t| t.joint == shoulder && t.axis == Vec3::Z).unwrap();
            let elbow = if shoulder == Joint::LeftShoulder { Joint::LeftElbow } else { Joint::RightElbow };
            let arm = Quat::from_rotation_z(turn.usual) * (rest.at(elbow) - rest.at(shoulder));
            assert!((arm.x.abs().atan2(-arm.y) - HANGING).abs() < 0.02, "{arm}");
        }
    }

    #[test]
    fn an_elbow_bends_forwards_and_a_knee_backwards() {
        let shapes = Shapes::of(Sex::Male);
        let rest = shapes.skeleton(shapes.mean());
        for (joint, end, forwards) in
            [(Joint::LeftElbow, Joint::LeftWrist, 1.0), (Joint::RightKnee, Joint::RightAnkle, -1.0)]
        {
            let turn = joint_angles(&rest).into_iter().find(|t| t.joint == joint).unwrap();
            let lower = rest.at(end) - rest.at(joint);
            let bent = Quat::from_axis_angle(turn.axis, 0.8) * lower;
            assert!((bent - lower).z * forwards > 0.1, "{joint:?} {bent}");
        }
    }
}
