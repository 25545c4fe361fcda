//! Joint positions become joint rotations of a skeleton with other proportions.
//!
//! Only directions are taken over, never positions: a sensor's shoulder or hip does not coincide with ours, but a limb
//! points where it points. Each joint is limited before its child is aimed, so that the child makes up for what its
//! parent could not reach.

use glam::{Quat, Vec3};
use toile_base::skeleton::{JOINTS, Joint, Skeleton};

use super::body_input::BodyInput;
use super::foot::Feet;
use super::limb::Limb;
use super::limits::Side;
use super::neutral::Neutral;
use super::reliable_joints::ReliableJoints;
use super::trunk::Trunk;

/// Greatest slant of a sensor's legs that is taken for its habit (rad): 15 degrees.
const MAX_SLANT: f32 = 0.26;

/// Difference between the legs (rad) and bend of a knee (cosine) up to which a person stands with straight legs.
const ALIKE: f32 = 0.12;
const STRAIGHT: f32 = 0.93;

/// Lift of an ankle (m) up to which it stands.
const STANDING: f32 = 0.05;

/// What retargeting keeps from one moment to the next.
#[derive(Debug, Clone)]
pub struct Retarget {
    trunk: Trunk,
    arms: [Limb; 2],
    legs: [Limb; 2],
    feet: Feet,
    /// Slant of a standing person's straight legs about x, and the same in our rest pose (rad).
    slant: Neutral,
    rest_slant: f32,
    /// Target rotation of each joint relative to its parent: joints that are not seen keep theirs.
    pub local: [Quat; JOINTS],
}

impl Retarget {
    /// Nothing seen yet: the rest pose of `skeleton`.
    pub fn new(skeleton: &Skeleton) -> Self {
        Self {
            trunk: Trunk::new(skeleton),
            arms: Side::BOTH.map(|side| Limb::arm(skeleton, side)),
            legs: Side::BOTH.map(|side| Limb::leg(skeleton, side)),
            feet: Feet::new(skeleton),
            slant: Neutral::default(),
            rest_slant: slants(&ReliableJoints::rest(skeleton), Vec3::Z).map_or(0.0, |[l, r]| 0.5 * (l + r)),
            local: [Quat::IDENTITY; JOINTS],
        }
    }

    /// Takes in one moment.
    pub fn update(&mut self, now: BodyInput) {
        let (pelvis, chest) = self.trunk.update(now, &mut self.local);
        let slant = self.legs_slant(now, pelvis);
        let toes = self.feet.aim(now, pelvis);
        for (i, side) in Side::BOTH.into_iter().enumerate() {
            let clavicle = chest * self.trunk.clavicle(now, chest, side, &mut self.local);
            let forearm = self.arms[i].update(now, clavicle, None, &mut self.local);
            self.arms[i].hand(now, forearm, &mut self.local);
            // The leg is aimed as if the pelvis had the sensor's slant, and hung on ours without it.
            self.legs[i].update(now, slant * pelvis, toes[i], &mut self.local);
            let shin = self.legs[i].stretch(1.0 - now.ground.legs_trust(), pelvis, &mut self.local);
            self.feet.update(now, i, shin, toes[i], &mut self.local);
        }
    }

    /// World rotation by which a sensor's legs are slanted: a person who stands on straight legs has the hips above the
    /// feet, or would fall.
    fn legs_slant(&mut self, now: BodyInput, pelvis: Quat) -> Quat {
        let (seen, ground, dt) = (now.seen, now.ground, now.dt);
        let left = (pelvis * Vec3::X).with_y(0.0).normalize_or(Vec3::X);
        let stands = |ankle| seen.at(ankle).is_some_and(|p| ground.lift(p.y) < STANDING);
        if let Some([l, r]) = slants(seen, left.cross(Vec3::Y))
            && (l - r).abs() < ALIKE
            && stands(Joint::LeftAnkle)
            && stands(Joint::RightAnkle)
        {
            self.slant.learn(Vec3::X * (0.5 * (l + r) - self.rest_slant), dt);
        }
        Quat::from_axis_angle(left, -self.slant.value().x.clamp(-MAX_SLANT, MAX_SLANT))
    }
}

/// How far each straight leg leads from the vertical towards `forward` (rad), left first; nothing unless both are seen
/// and straight.
fn slants(seen: &ReliableJoints, forward: Vec3) -> Option<[f32; 2]> {
    use Joint::*;
    let slant = |hip, knee, ankle| {
        let straight = seen.direction(hip, knee)?.dot(seen.direction(knee, ankle)?) > STRAIGHT;
        let leg = seen.direction(hip, ankle)?;
        (straight && seen.believes(&[hip, knee, ankle])).then(|| leg.dot(forward).atan2(-leg.y))
    };
    Some([slant(LeftHip, LeftKnee, LeftAnkle)?, slant(RightHip, RightKnee, RightAnkle)?])
}
