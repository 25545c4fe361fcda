//! Arms beside the body, not in it: other proportions, and a body measured with its clothes on, leave a hanging hand
//! inside the hip.
//!
//! Points along the forearm are compared with the collision body of trunk and legs, and the arm is turned about the
//! shoulder until none lies inside.

use glam::{Quat, Vec3};
use toile_base::limits::MAX_CAPSULES;
use toile_base::skeleton::{JOINTS, Joint, Pose, Skeleton};

use super::kinematics::JointFrames;
use super::limits::Side;
use super::smooth::fraction;
use crate::cone::{RestSphere, RoundCone};

/// Distance (m) kept between arm and body, for the cloth between them.
const GAP: f32 = 0.015;

/// Radii (m) of an arm at the elbow, the wrist and the knuckles.
const RADII: [f32; 3] = [0.045, 0.03, 0.03];

/// Corrections a step; each halves what is left or better.
const ITERATIONS: usize = 4;

/// Greatest turn of the arm (rad): beyond it the arm is meant to be there.
const MAX_TURN: f32 = 0.7;

/// Time constant of the turn (s).
const TAU: f32 = 0.06;

/// The collision body of trunk and legs, and how far each arm is turned away from it.
#[derive(Debug, Clone, Default)]
pub struct ArmClearance {
    capsules: heapless::Vec<[RestSphere; 2], MAX_CAPSULES>,
    /// Turn of each arm about its shoulder, world (rad).
    turns: [Vec3; 2],
}

impl ArmClearance {
    /// The capsules of a rig that belong to trunk and legs; those of the arms, and what does not exist, are left out.
    pub fn new(spheres: &[RestSphere], capsules: &[[u8; 2]]) -> Self {
        let mut clear = Self::default();
        for ends in capsules {
            let [a, b] = ends.map(|i| spheres.get(usize::from(i)).copied());
            if let (Some(a), Some(b)) = (a, b)
                && is_trunk_or_leg(a.bone)
                && is_trunk_or_leg(b.bone)
            {
                // As many as a rig may have; more are refused with the colliders.
                let _ = clear.capsules.push([a, b]);
            }
        }
        clear
    }

    /// Forgets the turns.
    pub fn reset(&mut self) {
        self.turns = [Vec3::ZERO; 2];
    }

    /// Turns the arms of `pose` out of the body.
    pub fn apply(&mut self, skeleton: &Skeleton, pose: &mut Pose, dt: f32, first: bool) {
        if self.capsules.is_empty() {
            return;
        }
        let frames = JointFrames::new(skeleton, pose);
        let mut cones = heapless::Vec::<RoundCone, MAX_CAPSULES>::new();
        for [a, b] in &self.capsules {
            let [p, q] = [a, b].map(|s| place(skeleton, &frames, s));
            let _ = cones.push(RoundCone::new(p, a.radius, q, b.radius));
        }
        let share = if first { 1.0 } else { fraction(dt, TAU) };
        for (turn, side) in self.turns.iter_mut().zip(Side::BOTH) {
            *turn += (way_out(&frames, &cones, side) - *turn) * share;
            let (clavicle, shoulder) = match side {
                Side::Left => (Joint::LeftClavicle, Joint::LeftShoulder.index()),
                Side::Right => (Joint::RightClavicle, Joint::RightShoulder.index()),
            };
            let parent = frames.turn(clavicle);
            let turned = parent.inverse() * Quat::from_scaled_axis(*turn) * parent * pose.local[shoulder];
            pose.local[shoulder] = turned.normalize();
        }
    }
}

/// Whether a bone carries trunk or leg, shoulders included.
fn is_trunk_or_leg(bone: u8) -> bool {
    use Joint::*;
    let arm = [LeftShoulder, LeftElbow, LeftWrist, LeftHand, RightShoulder, RightElbow, RightWrist, RightHand];
    usize::from(bone) < JOINTS && arm.iter().all(|j| j.index() != usize::from(bone))
}

/// Where a sphere stands (m).
fn place(skeleton: &Skeleton, frames: &JointFrames, sphere: &RestSphere) -> Vec3 {
    // A joint: spheres on anything else were left out at load.
    let i = usize::from(sphere.bone);
    frames.position[i] + frames.rotation[i] * (sphere.centre - skeleton.rest[i])
}

/// The turn about the shoulder (world, rad) that brings an arm out of the body.
fn way_out(frames: &JointFrames, cones: &[RoundCone], side: Side) -> Vec3 {
    use Joint::*;
    let joints = match side {
        Side::Left => [LeftShoulder, LeftElbow, LeftWrist, LeftHand],
        Side::Right => [RightShoulder, RightElbow, RightWrist, RightHand],
    };
    let [shoulder, elbow, wrist, knuckles] = joints.map(|j| frames.at(j));
    let [at_elbow, at_wrist, at_knuckles] = RADII;
    let points = [
        (elbow, at_elbow),
        ((elbow + wrist) * 0.5, (at_elbow + at_wrist) * 0.5),
        (wrist, at_wrist),
        (knuckles, at_knuckles),
        (knuckles + (knuckles - wrist) * 0.7, at_knuckles),
    ];
    let mut turn = Vec3::ZERO;
    for _ in 0..ITERATIONS {
        let rotation = Quat::from_scaled_axis(turn);
        let (mut sum, mut weight) = (Vec3::ZERO, 0.0);
        for (point, radius) in points {
            let arm = rotation * (point - shoulder);
            let (distance, normal) = nearest(cones, shoulder + arm);
            let depth = radius + GAP - distance;
            if depth > 0.0 {
                // Where the way out points along the arm, no turn helps.
                sum += arm.cross(normal) * (depth * depth / arm.length_squared().max(1e-4));
                weight += depth;
            }
        }
        if weight == 0.0 {
            break;
        }
        turn = (turn + sum / weight).clamp_length_max(MAX_TURN);
    }
    turn
}

/// Distance (m) to the union of the cones, and the way out of the one that is nearest.
fn nearest(cones: &[RoundCone], p: Vec3) -> (f32, Vec3) {
    let mut best = (f32::INFINITY, Vec3::Y);
    for cone in cones {
        let found = cone.distance(p);
        if found.0 < best.0 {
            best = found;
        }
    }
    best
}
