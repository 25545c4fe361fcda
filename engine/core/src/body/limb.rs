//! Arms and legs: two directions become a ball joint, its twist, and a hinge.
//!
//! The hinge's axis stands across the plane of upper and lower limb, and so fixes how the upper limb is twisted. The
//! twist is kept as one angle, counted from where the shortest swing out of the rest pose would leave the axis: when
//! the limb is nearly straight and its plane is noise, the angle simply stays, whichever way the limb moves.

use glam::{Quat, Vec3};
use toile_base::skeleton::{JOINTS, Joint, Skeleton};

use super::body_input::BodyInput;
use super::limits::{self, Range, Reach, Side, clamp_angle, soft_clamp};
use super::smooth::{fraction, ramp, wrap};

/// Bend (degrees) from which the plane of a limb begins to be believed, and from which it is believed fully: at 25
/// degrees a centimetre of noise turns the plane by 7.
const BENT_DEG: [f32; 2] = [8.0, 25.0];

/// Bend (degrees) from which the plane fades again: a folded limb has none.
const FOLDED_DEG: [f32; 2] = [162.0, 174.0];

/// A plane this far outside the twist's range (degrees) is taken for a tracking error, fully from the second value.
const IMPLAUSIBLE_DEG: [f32; 2] = [25.0, 60.0];

/// Time constant with which the twist follows a believed plane (s).
const PLANE_TAU: f32 = 0.03;

/// Time constant with which the twist of a straight leg follows the foot (s).
const TOE_TAU: f32 = 0.1;

/// Time constant with which the twist of a straight limb goes back to none (s).
const RELAX_TAU: f32 = 1.5;

/// Time constant with which a joint that is held, not seen, is followed (s).
const HELD_TAU: f32 = 0.3;

/// Time constant with which hands are followed (s): short, noisy bones.
const HAND_TAU: f32 = 0.1;

/// A ball joint, a hinge and an end: shoulder, elbow, wrist and hand, or hip, knee, ankle and toe.
#[derive(Debug, Clone)]
pub struct Limb {
    joints: [Joint; 4],
    side: Side,
    reach: Reach,
    twist_range: Range,
    hinge_range: Range,
    /// Rest directions (unit) of upper limb, lower limb and end.
    upper: Vec3,
    lower: Vec3,
    end: Vec3,
    /// Axis of the hinge at rest (unit): a positive turn about it bends the limb.
    axis: Vec3,
    /// How far the limb is bent at rest (rad).
    rest_bend: f32,
    /// Turn of the rest foot about the leg (rad); nothing for arms.
    rest_toe: Option<f32>,
    /// Twist of the upper limb about itself (rad), as described above.
    twist: f32,
}

impl Limb {
    /// An arm; the elbow bends it forwards.
    pub fn arm(skeleton: &Skeleton, side: Side) -> Self {
        use Joint::*;
        let joints = match side {
            Side::Left => [LeftShoulder, LeftElbow, LeftWrist, LeftHand],
            Side::Right => [RightShoulder, RightElbow, RightWrist, RightHand],
        };
        let mut limb = Self::new(skeleton, joints, side, Vec3::Z);
        (limb.reach, limb.twist_range, limb.hinge_range) =
            (limits::SHOULDER_REACH, limits::SHOULDER_TWIST.on(side), limits::ELBOW);
        limb
    }

    /// A leg; the knee bends it backwards.
    pub fn leg(skeleton: &Skeleton, side: Side) -> Self {
        use Joint::*;
        let joints = match side {
            Side::Left => [LeftHip, LeftKnee, LeftAnkle, LeftToe],
            Side::Right => [RightHip, RightKnee, RightAnkle, RightToe],
        };
        let mut limb = Self::new(skeleton, joints, side, Vec3::NEG_Z);
        limb.rest_toe = Some(angle_between(limb.axis, limb.end.cross(limb.upper), limb.upper));
        limb
    }

    /// A limb with a leg's ranges that bends towards `bends`.
    fn new(skeleton: &Skeleton, joints: [Joint; 4], side: Side, bends: Vec3) -> Self {
        let at = joints.map(|j| skeleton.at(j));
        let upper = (at[1] - at[0]).normalize_or(Vec3::NEG_Y);
        let lower = (at[2] - at[1]).normalize_or(upper);
        let axis = upper.cross(bends).normalize_or(Vec3::X);
        Self {
            joints,
            side,
            reach: limits::HIP_REACH,
            twist_range: limits::HIP_TWIST.on(side),
            hinge_range: limits::KNEE,
            upper,
            lower,
            end: (at[3] - at[2]).normalize_or(lower),
            axis,
            rest_bend: angle_between(upper, lower, axis),
            rest_toe: None,
            twist: 0.0,
        }
    }

    /// Aims upper and lower limb from `parent` (rest to world), and returns the lower limb's rotation in the world.
    /// `toe` is where a leg's foot points (world, unit).
    pub fn update(&mut self, now: BodyInput, parent: Quat, toe: Option<Vec3>, local: &mut [Quat; JOINTS]) -> Quat {
        let seen = now.seen;
        let [root, hinge, end, _] = self.joints;
        let lower = seen.direction(hinge, end);
        if let Some(upper) = seen.direction(root, hinge) {
            let inward = parent.inverse();
            let upper = self.reach.clamp(inward * upper, self.side);
            let swing = Quat::from_rotation_arc(self.upper, upper);
            self.follow_twist(now, upper, [lower, toe].map(|d| Some(inward * d?)));
            let share = if seen.believes(&[root, hinge]) { 1.0 } else { now.share(HELD_TAU) };
            follow(&mut local[root.index()], Quat::from_axis_angle(upper, self.twist) * swing, share);
        }
        let carrier = parent * local[root.index()];
        if let Some(lower) = lower {
            let share = if seen.believes(&[hinge, end]) { 1.0 } else { now.share(HELD_TAU) };
            follow(&mut local[hinge.index()], self.bend(carrier.inverse() * lower), share);
        }
        carrier * local[hinge.index()]
    }

    /// Brings the limb a share of the way back to rest, and returns the lower limb's rotation in the world for a limb
    /// whose parent is `parent`.
    pub fn stretch(&self, share: f32, parent: Quat, local: &mut [Quat; JOINTS]) -> Quat {
        let [root, hinge, ..] = self.joints.map(Joint::index);
        for joint in [root, hinge] {
            if share > 0.0 {
                follow(&mut local[joint], Quat::IDENTITY, share);
            }
        }
        parent * local[root] * local[hinge]
    }

    /// Aims the hand from the forearm's rotation; a hand that is not believed is held straight.
    pub fn hand(&self, now: BodyInput, forearm: Quat, local: &mut [Quat; JOINTS]) {
        let [.., wrist, hand] = self.joints;
        let target = match now.seen.direction(wrist, hand) {
            Some(shown) if now.seen.believes(&[wrist, hand]) => {
                clamp_angle(Quat::from_rotation_arc(self.end, forearm.inverse() * shown), limits::WRIST_DEG)
            }
            _ => Quat::IDENTITY,
        };
        follow(&mut local[wrist.index()], target, now.share(HAND_TAU));
    }

    /// Brings the twist to where plane, foot or rest say, each as far as it is to be believed. Directions in the
    /// parent's frame: the upper limb, and where known the lower limb and the foot.
    fn follow_twist(&mut self, now: BodyInput, upper: Vec3, [lower, toe]: [Option<Vec3>; 2]) {
        let share = |trust: f32, tau: f32| if now.first { trust } else { fraction(now.dt * trust, tau) };
        let plain = Quat::from_rotation_arc(self.upper, upper) * self.axis;
        if now.first {
            self.twist = 0.0;
        }
        let mut free = 1.0;
        if let Some(lower) = lower {
            let normal = upper.cross(lower);
            let bend = normal.length().atan2(upper.dot(lower)).to_degrees();
            let angle = self.twist_range.near(angle_between(plain, normal, upper));
            let error = self.twist_range.excess(angle).to_degrees();
            let trust = ramp(BENT_DEG, bend) * (1.0 - ramp(FOLDED_DEG, bend)) * (1.0 - ramp(IMPLAUSIBLE_DEG, error));
            self.twist += (self.twist_range.clamp(angle) - self.twist) * share(trust, PLANE_TAU);
            free -= trust;
        }
        if let (Some(toe), Some(rest)) = (toe, self.rest_toe) {
            let normal = toe.cross(upper);
            let angle = self.twist_range.near(wrap(angle_between(plain, normal, upper) - rest));
            let trust = free * ramp([0.4, 0.7], normal.length());
            self.twist += (self.twist_range.clamp(angle) - self.twist) * share(trust, TOE_TAU);
            free -= trust;
        }
        self.twist -= self.twist * share(free, RELAX_TAU);
    }

    /// Rotation of the hinge that aims the lower limb at `lower` (unit, in the upper limb's frame).
    fn bend(&self, lower: Vec3) -> Quat {
        let angle = self.hinge_range.near(self.rest_bend + angle_between(self.lower, lower, self.axis));
        let turn = Quat::from_axis_angle(self.axis, self.hinge_range.clamp(angle) - self.rest_bend);
        // What leaves the hinge's plane, beyond what the rest pose has.
        let play = limits::HINGE_PLAY.to_radians();
        let rest = self.lower.dot(self.axis).clamp(-1.0, 1.0).asin();
        let aside = rest + soft_clamp(lower.dot(self.axis).clamp(-1.0, 1.0).asin() - rest, -play, play);
        let flat = (turn * self.lower - self.axis * self.lower.dot(self.axis)).normalize_or(self.lower);
        let (sine, cosine) = aside.sin_cos();
        Quat::from_rotation_arc(turn * self.lower, (flat * cosine + self.axis * sine).normalize()) * turn
    }
}

/// Turns a rotation a share of the way to its target.
fn follow(rotation: &mut Quat, target: Quat, share: f32) {
    *rotation = if share >= 1.0 { target } else { rotation.slerp(target, share).normalize() };
}

/// Angle (rad, within half a turn) by which `from` must turn about `axis` (unit) to stand over `to`.
fn angle_between(from: Vec3, to: Vec3, axis: Vec3) -> f32 {
    let from = from - axis * from.dot(axis);
    axis.dot(from.cross(to)).atan2(from.dot(to))
}
