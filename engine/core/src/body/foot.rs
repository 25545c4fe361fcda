//! Feet: flat on the floor, turned where the toes point, heels lifted when they are.
//!
//! Sensors disagree where in a foot its joints are, so the slope from ankle to toe says little by itself: the slope of
//! a foot that stands is learned, and only what differs from it counts. A foot in the air whose toes are not seen hangs
//! from its shin.

use glam::{Quat, Vec3};
use toile_assets::skeleton::{JOINTS, Joint, Skeleton};

use super::ground::Ground;
use super::limb::ramp;
use super::limits::{self, Side};
use super::seen::Seen;
use super::smooth::fraction;

/// Lift of the ankle (m) up to which a foot stands flat, and from which its slope is its own.
const STANDING: [f32; 2] = [0.04, 0.10];

/// Lift of the ankle (m) up to which a foot without toes is taken to stand, and from which it is taken to hang.
const HANGING: [f32; 2] = [0.05, 0.25];

/// Time constant with which the slope of a standing foot is learned (s).
const SLOPE_TAU: f32 = 1.0;

/// Time constants with which a swinging and a standing foot turn (s): toes are the joint that sensors know worst, and a
/// foot that stands cannot turn fast.
const SWING_TAU: f32 = 0.05;
const STAND_TAU: f32 = 0.3;

/// One foot.
#[derive(Debug, Clone)]
pub struct Foot {
    ankle: Joint,
    toe: Joint,
    side: Side,
    /// Rest direction from ankle to toe, level part (unit).
    heading: Vec3,
    /// Direction in which it heads now, world, level (unit).
    ahead: Vec3,
    /// Slope (rad, downwards negative) that the sensor shows for a flat foot.
    flat_slope: f32,
}

impl Foot {
    /// A foot that stands as in the rest pose.
    pub fn new(skeleton: &Skeleton, side: Side) -> Self {
        let (ankle, toe) = match side {
            Side::Left => (Joint::LeftAnkle, Joint::LeftToe),
            Side::Right => (Joint::RightAnkle, Joint::RightToe),
        };
        let ahead = skeleton.at(toe) - skeleton.at(ankle);
        let heading = level(ahead).unwrap_or(Vec3::Z);
        Self { ankle, toe, side, heading, ahead: heading, flat_slope: slope(ahead.normalize_or(heading)) }
    }

    /// Turns the foot against the shin's rotation (rest to world).
    pub fn update(
        &mut self,
        seen: &Seen,
        ground: &Ground,
        shin: Quat,
        dt: f32,
        first: bool,
        local: &mut [Quat; JOINTS],
    ) {
        let lift = seen.at(self.ankle).map_or(0.0, |p| ground.lift(p.y));
        let standing = 1.0 - ramp(STANDING, lift);
        let tau = SWING_TAU + (STAND_TAU - SWING_TAU) * standing;
        let share = if first { 1.0 } else { fraction(dt, tau) };
        let target = match seen.direction(self.ankle, self.toe) {
            Some(now) => {
                let difference = slope(now) - self.flat_slope;
                self.flat_slope += difference * fraction(dt * standing * standing, SLOPE_TAU);
                self.turn_to(level(now), share);
                self.stand(self.ahead, shin, (slope(now) - self.flat_slope) * (1.0 - standing))
            }
            None => {
                self.turn_to(level(shin * self.heading), share);
                let flat = self.stand(self.ahead, shin, 0.0);
                flat.slerp(Quat::IDENTITY, ramp(HANGING, lift))
            }
        };
        local[self.ankle.index()] = limits::ANKLE.clamp(target, self.side);
    }

    /// Turns the heading a share of the way to where the foot is seen to head.
    fn turn_to(&mut self, shown: Option<Vec3>, share: f32) {
        if let Some(shown) = shown {
            self.ahead = level(self.ahead.lerp(shown, share)).unwrap_or(shown);
        }
    }

    /// Rotation against the shin of a foot heading `ahead` (level, unit), pitched up by `pitch` (rad).
    fn stand(&self, ahead: Vec3, shin: Quat, pitch: f32) -> Quat {
        let yaw = Quat::from_rotation_arc(self.heading, ahead);
        let upwards = self.heading.cross(Vec3::Y);
        shin.inverse() * yaw * Quat::from_axis_angle(upwards, pitch)
    }
}

/// Slope of a unit vector (rad), upwards positive.
fn slope(direction: Vec3) -> f32 {
    direction.y.clamp(-1.0, 1.0).asin()
}

/// Level part of a direction (unit), unless it is nearly upright.
fn level(direction: Vec3) -> Option<Vec3> {
    let flat = Vec3::new(direction.x, 0.0, direction.z);
    (flat.length() > 0.3 * direction.length()).then(|| flat.normalize())
}
