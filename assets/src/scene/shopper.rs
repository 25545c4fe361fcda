//! The shopper of the embedded session: who she is, and what she does before the camera.

use std::f32::consts::{PI, TAU};

use glam::{Quat, Vec3};

use toile_base::body::{Measures, Sex};
use toile_base::skeleton::{Joint, Pose, Skeleton};

/// The woman of the embedded session: her girths lie between two sizes of the women's table, so that choosing one is a
/// real question, and Toile knows them only from the session.
pub const SHOPPER: (Sex, Measures) = (
    Sex::Female,
    Measures { stature: 1.694, shoulder_breadth: 0.372, chest_girth: 0.906, waist_girth: 0.741, hip_girth: 0.981 },
);

/// Time that the shopper stands still to be measured (s).
pub const STILL_S: f32 = 1.6;

/// Length of the whole performance (s); afterwards the shopper stands still.
pub const LENGTH_S: f32 = 10.0;

/// The shopper's pose at a time (s): stands still, lifts the arms, walks on the spot, swings the hips, turns around once,
/// and comes to rest.
pub fn shopper(skeleton: &Skeleton, time: f32) -> Pose {
    let mut pose = Pose::rest(skeleton);
    let mut act = PoseBlend { pose: &mut pose, breath: (TAU * 0.3 * time).sin() };
    act.stand();
    act.lower_arms(ramp(time, STILL_S, STILL_S + 1.0));
    act.lift_arms(window(time, STILL_S, 3.6));
    act.walk(window(time, 3.2, 6.0), TAU * 1.1 * (time - 3.2));
    act.swing(window(time, 5.6, 7.4), TAU * 0.9 * (time - 5.6));
    act.turn(ramp(time, 7.0, 9.0));
    act.repose(ramp(time, 8.6, 9.4));
    pose.root.y += lift_to_floor(skeleton, &pose);
    pose
}

/// 0 before, 1 after, smooth between.
fn ramp(time: f32, from: f32, to: f32) -> f32 {
    let t = ((time - from) / (to - from)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// Rises from 0 at `from` to 1 and falls back to 0 at `to`.
fn window(time: f32, from: f32, to: f32) -> f32 {
    let edge = 0.3 * (to - from);
    ramp(time, from, from + edge) * (1.0 - ramp(time, to - edge, to))
}

/// One moment of the performance; each part adds to the pose by its strength 0..1.
struct PoseBlend<'a> {
    pose: &'a mut Pose,
    breath: f32,
}

impl PoseBlend<'_> {
    fn bend(&mut self, joint: Joint, turn: Quat) {
        let i = joint.index();
        self.pose.local[i] = turn * self.pose.local[i];
    }

    /// The same turn on both sides, mirrored.
    fn bend_both(&mut self, left: Joint, turn: Quat) {
        self.bend(left, turn);
        self.bend(left.mirror(), Quat::from_xyzw(turn.x, -turn.y, -turn.z, turn.w));
    }

    /// Upright, arms a little away from the sides, breathing.
    fn stand(&mut self) {
        self.bend_both(Joint::LeftShoulder, Quat::from_rotation_z(-0.30 + 0.01 * self.breath));
        self.bend_both(Joint::LeftElbow, Quat::from_rotation_y(-0.15));
        self.bend(Joint::Chest, Quat::from_rotation_x(0.01 * self.breath));
    }

    /// Lowers the arms to the sides, since people do not keep them away for long.
    fn lower_arms(&mut self, strength: f32) {
        self.bend_both(Joint::LeftShoulder, Quat::from_rotation_z(-0.24 * strength));
    }

    /// Both arms out to the sides and up to the height of the head.
    fn lift_arms(&mut self, strength: f32) {
        self.bend_both(Joint::LeftShoulder, Quat::from_rotation_z(1.4 * strength));
        self.bend_both(Joint::LeftClavicle, Quat::from_rotation_z(0.12 * strength));
    }

    /// Steps on the spot: knees rise in turn, arms swing against them.
    fn walk(&mut self, strength: f32, phase: f32) {
        for (side, hip, shoulder) in
            [(0.0, Joint::LeftHip, Joint::LeftShoulder), (PI, Joint::RightHip, Joint::RightShoulder)]
        {
            let rise = strength * (phase + side).sin().max(0.0);
            self.bend(hip, Quat::from_rotation_x(-0.75 * rise));
            let knee = if hip == Joint::LeftHip { Joint::LeftKnee } else { Joint::RightKnee };
            self.bend(knee, Quat::from_rotation_x(1.15 * rise));
            self.bend(shoulder, Quat::from_rotation_x(0.45 * strength * (phase + side).sin()));
        }
        self.pose.root.x += 0.02 * strength * phase.sin();
    }

    /// Twists the trunk to and fro, which swings a skirt.
    fn swing(&mut self, strength: f32, phase: f32) {
        self.bend(Joint::Pelvis, Quat::from_rotation_y(0.38 * strength * phase.sin()));
        self.bend(Joint::Spine, Quat::from_rotation_y(-0.15 * strength * phase.sin()));
    }

    /// Once around, to the left.
    fn turn(&mut self, part: f32) {
        self.bend(Joint::Pelvis, Quat::from_rotation_y(TAU * part));
    }

    /// At ease: weight on one leg, one hand near the hip.
    fn repose(&mut self, strength: f32) {
        self.bend(Joint::LeftHip, Quat::from_rotation_x(-0.16 * strength));
        self.bend(Joint::LeftKnee, Quat::from_rotation_x(0.26 * strength));
        self.bend(Joint::RightElbow, Quat::from_rotation_x(-0.5 * strength));
        self.bend(Joint::Neck, Quat::from_rotation_y(0.18 * strength));
    }
}

/// How far the pelvis must rise for the lower ankle to stand as high as it does at rest (m).
fn lift_to_floor(skeleton: &Skeleton, pose: &Pose) -> f32 {
    use Joint::{LeftAnkle, LeftHip, LeftKnee, Pelvis, RightAnkle, RightHip, RightKnee};
    let ankle = |chain: [Joint; 4]| {
        let mut turn = Quat::IDENTITY;
        let mut at = pose.root;
        for joint in chain {
            if joint != Pelvis {
                at += turn * skeleton.offset(joint);
            }
            turn *= pose.local[joint.index()];
        }
        at.y - skeleton.at(chain[3]).y
    };
    -ankle([Pelvis, LeftHip, LeftKnee, LeftAnkle]).min(ankle([Pelvis, RightHip, RightKnee, RightAnkle]))
}

/// Where the camera of the embedded session stands (m), and what it looks at.
pub const CAMERA: [Vec3; 2] = [Vec3::new(0.0, 1.05, 2.6), Vec3::new(0.0, 0.95, 0.0)];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_performance_is_smooth_and_stays_on_the_floor() {
        let body = crate::body::build(SHOPPER.0, &SHOPPER.1).unwrap();
        let mut before = shopper(&body.skeleton, 0.0);
        for step in 1..=1_250 {
            let pose = shopper(&body.skeleton, step as f32 / 120.0);
            assert!(pose.root.distance(before.root) < 0.02, "step {step}");
            for (a, b) in pose.local.iter().zip(&before.local) {
                assert!(a.angle_between(*b) < 0.08, "step {step}: {}", a.angle_between(*b));
            }
            before = pose;
        }
    }
}
