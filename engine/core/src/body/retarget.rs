//! Joint positions become joint rotations of a skeleton with other proportions.
//!
//! Only directions are taken over, never positions: a sensor's shoulder or hip does not coincide with ours, but a limb
//! points where it points. The trunk gives two frames (hips and spine, shoulders and neck) between which the bend is
//! spread; a limb's two directions span the plane of its hinge, and that plane fixes the twist. Each joint is limited
//! before its child is aimed, so that the child makes up for what its parent could not reach.

use glam::{Mat3, Quat, Vec3};
use toile_assets::limits::CONFIDENCE_GATE;
use toile_assets::skeleton::{JOINTS, Joint, Skeleton};
use toile_sensors::frame::Joints;

use super::foot::Foot;
use super::ground::Ground;
use super::limb::Limb;
use super::limits::{self, Side};
use super::smooth::fraction;

/// Joints nearer together than this (m) give no direction.
pub const MIN_BONE: f32 = 0.02;

/// Farther away than this (m) a joint is an error, not a shopper.
const MAX_RANGE: f32 = 50.0;

/// Time constant with which the head follows the chest's turn (s): eyes stay on the mirror a moment longer.
const HEAD_TAU: f32 = 0.25;

/// Furthest the head lags behind the chest (rad).
const HEAD_LAG: f32 = 0.5;

/// Lift of the collar bone when the arm is straight up (rad): a third of the arm's last 90 degrees is the shoulder
/// blade's (Inman, Saunders and Abbott 1944); used where no sensor joint shows it.
const CLAVICLE_LIFT: f32 = 0.4;

/// The joints of one moment that are believed.
#[derive(Debug, Clone, Copy)]
pub struct Seen([Option<Vec3>; JOINTS]);

impl Seen {
    /// Drops joints below the confidence gate and those whose position is no number or out of reach.
    pub fn new(joints: &Joints) -> Self {
        Self(joints.joints.map(|j| {
            let near = j.position.is_finite() && j.position.abs().max_element() < MAX_RANGE;
            (near && j.confidence >= CONFIDENCE_GATE).then_some(j.position)
        }))
    }

    /// One joint's position (m), if believed.
    pub fn at(&self, joint: Joint) -> Option<Vec3> {
        self.0[joint.index()]
    }

    /// Middle of two joints (m).
    pub fn middle(&self, a: Joint, b: Joint) -> Option<Vec3> {
        Some((self.at(a)? + self.at(b)?) * 0.5)
    }

    /// Unit vector from one joint to another.
    pub fn direction(&self, from: Joint, to: Joint) -> Option<Vec3> {
        unit(self.at(to)? - self.at(from)?)
    }
}

/// Unit vector, unless too short to trust.
pub fn unit(v: Vec3) -> Option<Vec3> {
    let length = v.length();
    (length > MIN_BONE).then(|| v / length)
}

/// What retargeting keeps from one moment to the next.
#[derive(Debug, Clone)]
pub struct Retarget {
    rest: Seen,
    arms: [Limb; 2],
    legs: [Limb; 2],
    feet: [Foot; 2],
    head_yaw: f32,
    /// Target rotation of each joint relative to its parent: joints that are not seen keep theirs.
    pub local: [Quat; JOINTS],
}

impl Retarget {
    /// Nothing seen yet: the rest pose of `skeleton`.
    pub fn new(skeleton: &Skeleton) -> Self {
        let rest = Seen(skeleton.rest.map(Some));
        Self {
            rest,
            arms: Side::BOTH.map(|side| Limb::arm(skeleton, side)),
            legs: Side::BOTH.map(|side| Limb::leg(skeleton, side)),
            feet: Side::BOTH.map(|side| Foot::new(skeleton, side)),
            head_yaw: 0.0,
            local: [Quat::IDENTITY; JOINTS],
        }
    }

    /// Takes in one moment, `dt` (s) after the last; `first` takes it over without memory.
    pub fn update(&mut self, seen: &Seen, ground: &Ground, dt: f32, first: bool) {
        let pelvis = self.pelvis(seen).unwrap_or(self.local[Joint::Pelvis.index()]);
        self.local[Joint::Pelvis.index()] = pelvis;
        let chest = self.trunk(seen, pelvis);
        self.head(seen, chest, if first { 1.0 } else { fraction(dt, HEAD_TAU) });
        for (i, side) in Side::BOTH.into_iter().enumerate() {
            let clavicle = chest * self.clavicle(seen, chest, side);
            let forearm = self.arms[i].update(seen, clavicle, dt, first, &mut self.local);
            self.arms[i].hand(seen, forearm, &mut self.local);
            let shin = self.legs[i].update(seen, pelvis, dt, first, &mut self.local);
            self.feet[i].update(seen, ground, shin, dt, &mut self.local);
        }
    }

    /// Rotation of the pelvis: its up towards the lower spine, its left along the hips.
    fn pelvis(&self, seen: &Seen) -> Option<Quat> {
        let frame = |seen: &Seen, top: Joint| {
            let left = seen.direction(Joint::RightHip, Joint::LeftHip)?;
            let up = unit(seen.at(top)? - seen.middle(Joint::LeftHip, Joint::RightHip)?)?;
            frame(up, left)
        };
        let top = [Joint::Spine, Joint::Chest, Joint::Neck].into_iter().find(|j| seen.at(*j).is_some())?;
        Some(frame(seen, top)? * frame(&self.rest, top)?.inverse())
    }

    /// Rotations of spine and chest, the bend between pelvis and shoulders shared equally; returns the chest's.
    fn trunk(&mut self, seen: &Seen, pelvis: Quat) -> Quat {
        let (spine, chest) = (Joint::Spine.index(), Joint::Chest.index());
        if let Some(target) = self.chest(seen) {
            let bend = pelvis.inverse() * target;
            let half = Quat::IDENTITY.slerp(bend, 0.5);
            self.local[spine] = limits::TRUNK.clamp(half, Side::Left);
            self.local[chest] = limits::TRUNK.clamp(self.local[spine].inverse() * bend, Side::Left);
        }
        pelvis * self.local[spine] * self.local[chest]
    }

    /// Rotation of the chest: its up towards the neck, its left along the collar bones or shoulders.
    fn chest(&self, seen: &Seen) -> Option<Quat> {
        let has = |a, b| seen.direction(a, b).is_some();
        let (left, right) = if has(Joint::RightClavicle, Joint::LeftClavicle) {
            (Joint::LeftClavicle, Joint::RightClavicle)
        } else {
            (Joint::LeftShoulder, Joint::RightShoulder)
        };
        let top = if seen.at(Joint::Neck).is_some() { Joint::Neck } else { Joint::Head };
        let base = [Joint::Chest, Joint::Spine, Joint::Pelvis].into_iter().find(|j| seen.at(*j).is_some())?;
        let frame = |seen: &Seen| frame(seen.direction(base, top)?, seen.direction(right, left)?);
        Some(frame(seen)? * frame(&self.rest)?.inverse())
    }

    /// Rotations of neck and head: the neck leans as seen, the head's turn follows the chest softly.
    fn head(&mut self, seen: &Seen, chest: Quat, follow: f32) {
        let (neck, head) = (Joint::Neck, Joint::Head);
        if let (Some(now), Some(rest)) = (seen.direction(neck, head), self.rest.direction(neck, head)) {
            let lean = Quat::from_rotation_arc(rest, chest.inverse() * now);
            self.local[neck.index()] = limits::NECK.clamp(lean, Side::Left);
        }
        let forward = chest * Vec3::Z;
        if forward.x.hypot(forward.z) > 0.1 {
            let yaw = forward.x.atan2(forward.z);
            let lag = wrap(yaw - self.head_yaw) * (1.0 - follow);
            let lag = lag.clamp(-HEAD_LAG, HEAD_LAG);
            self.head_yaw = wrap(yaw - lag);
            self.local[head.index()] = Quat::from_rotation_y(-lag);
        }
    }

    /// Rotation of a collar bone: as its two ends show, else lifted with the arm.
    fn clavicle(&mut self, seen: &Seen, chest: Quat, side: Side) -> Quat {
        let (clavicle, shoulder, elbow) = match side {
            Side::Left => (Joint::LeftClavicle, Joint::LeftShoulder, Joint::LeftElbow),
            Side::Right => (Joint::RightClavicle, Joint::RightShoulder, Joint::RightElbow),
        };
        let inward = chest.inverse();
        let shown = seen.direction(clavicle, shoulder).zip(self.rest.direction(clavicle, shoulder));
        let target = match (shown, seen.direction(shoulder, elbow)) {
            (Some((now, rest)), _) => Some(Quat::from_rotation_arc(rest, inward * now)),
            (None, Some(arm)) => {
                // Nothing up to the horizontal, all of it straight up.
                let raised = (inward * arm).y.clamp(0.0, 1.0);
                Some(Quat::from_rotation_z(side.sign() * CLAVICLE_LIFT * raised * raised))
            }
            (None, None) => None,
        };
        let local = &mut self.local[clavicle.index()];
        if let Some(target) = target {
            *local = limits::CLAVICLE.clamp(target, side);
        }
        *local
    }
}

/// The rotation whose y axis is `up` and whose x axis is as near to `left` as that allows.
fn frame(up: Vec3, left: Vec3) -> Option<Quat> {
    let across = left - up * left.dot(up);
    if across.length() < 0.2 {
        return None;
    }
    let x = across.normalize();
    Some(Quat::from_mat3(&Mat3::from_cols(x, up, x.cross(up))).normalize())
}

/// An angle (rad) brought within half a turn of 0.
pub fn wrap(angle: f32) -> f32 {
    let turns = (angle / std::f32::consts::TAU).round();
    angle - turns * std::f32::consts::TAU
}
