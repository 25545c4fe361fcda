//! A simulated shopper: proportions of their own, arms that reach for a point, and a tracker that sees them.
//!
//! Nothing here is shared with the recogniser: the proportions are Drillis and Contini's (1966) with errors of their own,
//! not those that it assumes.

use glam::{Quat, Vec3};
use toile_base::frame::{Joints, TrackedJoint};
use toile_base::numeric::random::SplitMix64;
use toile_base::skeleton::Joint;
use toile_sensors::source::synthetic::JointNoise;

/// Mean and standard deviation of stature (m), ANSUR II women and men.
const STATURES: [[f32; 2]; 2] = [[1.6285, 0.0642], [1.7562, 0.0686]];

/// How much a person's limb differs from the average of their stature, relative.
const OWN: f32 = 0.04;

/// Jitter of a tracked joint at 2 m (m), growing with the square of the distance as a depth camera's error does.
const JITTER_2M: f32 = 0.006;

/// Chance that a wrist, hand or toe is lost in a frame.
const LOST: f32 = 0.01;

/// Slow wander of a tracked wrist (m), as a tracker's inner point drifts over the limb.
const WANDER: f32 = 0.012;

/// Lengths of a simulated shopper (m).
#[derive(Debug, Clone, Copy)]
pub(super) struct Shopper {
    pub stature: f32,
    /// Half of the distance of the shoulder joints.
    shoulder: f32,
    shoulder_height: f32,
    upper_arm: f32,
    forearm: f32,
    /// Wrist to the middle of the palm.
    palm: f32,
}

impl Shopper {
    /// A random grown-up, or with `scale` a child or a giant of the same proportions.
    pub(super) fn new(rng: &mut SplitMix64, scale: f32) -> Self {
        let [mean, sd] = STATURES[(rng.next_u64() & 1) as usize];
        let stature = scale * (mean + sd * rng.gaussian().clamp(-2.5, 2.5));
        let mut part = |fraction: f32| stature * fraction * (1.0 + OWN * rng.gaussian());
        Self {
            stature,
            shoulder: part(0.105),
            shoulder_height: stature * 0.818,
            upper_arm: part(0.186),
            forearm: part(0.146),
            palm: part(0.050),
        }
    }

    pub(super) fn arm(&self) -> f32 {
        self.upper_arm + self.forearm
    }

    /// The joints of a shopper who stands at `at` (on the floor, m), turned by `turn` (rad, to their left), with the
    /// wrists (left, right) at places in arm lengths along the trunk's axes from the middle of the shoulders.
    pub(super) fn joints(&self, at: Vec3, turn: f32, wrists: [Vec3; 2]) -> Joints {
        use Joint::*;
        let mut joints = Joints::absent(0);
        let rotation = Quat::from_rotation_y(turn);
        let mut put = |joint: Joint, local: Vec3| {
            *joints.at_mut(joint) = TrackedJoint { position: at + rotation * local, confidence: 1.0 };
        };
        let h = |fraction: f32| Vec3::Y * (self.stature * fraction);
        for (joint, height) in [(Pelvis, 0.53), (Spine, 0.60), (Chest, 0.72), (Neck, 0.85), (Head, 0.93)] {
            put(joint, h(height));
        }
        let middle = Vec3::Y * self.shoulder_height;
        let arms = [[LeftShoulder, LeftElbow, LeftWrist, LeftHand], [RightShoulder, RightElbow, RightWrist, RightHand]];
        let legs = [[LeftHip, LeftKnee, LeftAnkle, LeftToe], [RightHip, RightKnee, RightAnkle, RightToe]];
        for (i, sign) in [1.0f32, -1.0].into_iter().enumerate() {
            let side = Vec3::X * sign;
            let shoulder = middle + side * self.shoulder;
            let [elbow, wrist] = self.reach(shoulder, middle + wrists[i] * self.arm(), side);
            let hand = wrist + (wrist - elbow).normalize_or_zero() * self.palm;
            arms[i].into_iter().zip([shoulder, elbow, wrist, hand]).for_each(|(joint, p)| put(joint, p));
            let hip = side * (0.05 * self.stature);
            let toe = hip + h(0.01) + Vec3::Z * (0.1 * self.stature);
            let leg = [hip + h(0.53), hip + h(0.285), hip + h(0.039), toe];
            legs[i].into_iter().zip(leg).for_each(|(joint, p)| put(joint, p));
        }
        joints
    }

    /// Elbow and wrist of an arm that reaches for a point as far as it can: the elbow hangs down and out.
    fn reach(&self, shoulder: Vec3, target: Vec3, side: Vec3) -> [Vec3; 2] {
        let (a, b) = (self.upper_arm, self.forearm);
        let d = target - shoulder;
        let along = d.try_normalize().unwrap_or(Vec3::NEG_Y);
        let length = d.length().clamp((a - b).abs() * 1.05 + 0.02, (a + b) * 0.995);
        let x = (a * a - b * b + length * length) / (2.0 * length);
        let bend = (a * a - x * x).max(0.0).sqrt();
        let out = Vec3::NEG_Y + 0.6 * side + 0.01 * Vec3::Z;
        let out = (out - along * out.dot(along)).try_normalize().unwrap_or(Vec3::NEG_Z);
        [shoulder + along * x + out * bend, shoulder + along * length]
    }
}

/// A tracker at some distance: jitter, slow wander of the wrists, joints lost.
pub(super) struct Tracker {
    noise: JointNoise,
    rng: SplitMix64,
    wander: [Vec3; 2],
}

impl Tracker {
    /// A tracker of a shopper `distance` away (m).
    pub(super) fn new(rng: &mut SplitMix64, distance: f32) -> Self {
        let sigma = JITTER_2M * (0.4 + 0.6 * (distance / 2.0).powi(2));
        Self {
            noise: JointNoise::with(rng.next_u64(), sigma, LOST),
            rng: SplitMix64::new(rng.next_u64()),
            wander: [Vec3::ZERO; 2],
        }
    }

    /// What it sees, `dt` (s) after the frame before.
    pub(super) fn see(&mut self, truth: &Joints, dt: f32) -> Joints {
        let mut moved = *truth;
        let keep = (-dt / 0.5).exp();
        let arms = [[Joint::LeftWrist, Joint::LeftHand], [Joint::RightWrist, Joint::RightHand]];
        for (wander, joints) in self.wander.iter_mut().zip(arms) {
            let kick = Vec3::new(self.rng.gaussian(), self.rng.gaussian(), self.rng.gaussian());
            *wander = *wander * keep + kick * (WANDER * (1.0 - keep * keep).sqrt());
            joints.into_iter().for_each(|j| moved.at_mut(j).position += *wander);
        }
        self.noise.apply(&moved)
    }
}
