//! A leg that reaches: analytic inverse kinematics of hip and knee (after Tolani, Goswami and Badler 2000).
//!
//! The knee's bend alone sets how far the ankle is from the hip, by the law of cosines; then the whole leg swings from
//! where the ankle is to where it should be. The knee stays in the plane in which it is, and the foot keeps its place in
//! the world.

use glam::{Quat, Vec3};
use toile_base::skeleton::{Joint, Pose};

use super::kinematics::JointFrames;
use super::limits::Side;

/// Reach over the leg's length: a knee that locks would turn at any speed.
const STRAIGHTEST: f32 = 0.9995;

/// Sine of the knee's bend below which the leg does not determine its plane.
const FLAT: f32 = 0.02;

/// Pelvis to foot of a side.
pub fn joints(side: Side) -> [Joint; 3] {
    match side {
        Side::Left => [Joint::LeftHip, Joint::LeftKnee, Joint::LeftAnkle],
        Side::Right => [Joint::RightHip, Joint::RightKnee, Joint::RightAnkle],
    }
}

/// The point nearest to `target` that an ankle reaches on this leg (m).
pub fn within_reach(frames: &JointFrames, side: Side, target: Vec3) -> Vec3 {
    let [hip, knee, ankle] = joints(side).map(|j| frames.at(j));
    let [upper, lower] = [knee.distance(hip), ankle.distance(knee)];
    let way = target - hip;
    let reach = way.length().clamp((upper - lower).abs() + 1e-3, (upper + lower) * STRAIGHTEST);
    hip + way.normalize_or(Vec3::NEG_Y) * reach
}

/// Turns hip, knee and ankle of a pose whose joint frames these are so that the ankle comes to `target` (m), which is
/// within reach, and the foot keeps its rotation in the world.
pub fn reach(pose: &mut Pose, frames: &JointFrames, side: Side, target: Vec3) {
    let joints = joints(side);
    let [hip, knee, ankle] = joints.map(|j| frames.at(j));
    let [thigh, shin, foot] = joints.map(|j| frames.turn(j));
    let (upper, lower) = (knee - hip, ankle - knee);
    let (a, b) = (upper.length(), lower.length());
    let distance = target.distance(hip);
    if a * b < 1e-6 || distance < 1e-6 {
        return;
    }
    // Exterior angle of the knee, 0 for a straight leg.
    let bent = |d: f32| ((d * d - a * a - b * b) / (2.0 * a * b)).clamp(-1.0, 1.0).acos();
    let normal = upper.cross(lower);
    let axis = if normal.length() > FLAT * a * b { normal.normalize() } else { thigh * Vec3::X };
    let bend = Quat::from_axis_angle(axis, bent(distance) - upper.angle_between(lower));
    let reached = knee + bend * lower;
    let (Some(from), Some(to)) = ((reached - hip).try_normalize(), (target - hip).try_normalize()) else { return };
    let swing = Quat::from_rotation_arc(from, to);
    let (thigh_to, shin_to) = (swing * thigh, swing * bend * shin);
    // The hip's own rotation is against the pelvis, the parent of both.
    let pelvis = frames.turn(Joint::Pelvis);
    let local = [pelvis.inverse() * thigh_to, thigh_to.inverse() * shin_to, shin_to.inverse() * foot];
    for (joint, turn) in joints.into_iter().zip(local) {
        pose.local[joint.index()] = turn.normalize();
    }
}
