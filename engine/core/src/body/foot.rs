//! Feet: flat on the floor, turned where the toes point, heels lifted when they are.
//!
//! Sensors disagree where in a foot its joints are, so the slope from ankle to toe says little by itself: the slope of
//! a foot that stands is learned, and only what differs from it counts. A foot in the air whose toes are not seen hangs
//! from its shin.

use glam::{Quat, Vec3};
use toile_base::skeleton::{JOINTS, Joint, Skeleton};

use super::body_input::BodyInput;
use super::limits::{self, Side};
use super::neutral::Neutral;
use super::smooth::{fraction, ramp};

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

/// Greatest turn of a sensor's feet, both inwards or both outwards, that is taken for its habit (rad).
const MAX_TURN: f32 = 0.6;

/// Tracks both feet and keeps them where they are planted.
#[derive(Debug, Clone)]
pub struct Feet {
    feet: [Foot; 2],
    /// How far both seem to be turned outwards.
    turn: Neutral,
}

impl Feet {
    /// Feet that stand as in the rest pose.
    pub fn new(skeleton: &Skeleton) -> Self {
        Self { feet: Side::BOTH.map(|side| Foot::new(skeleton, side)), turn: Neutral::default() }
    }

    /// Where the feet point (world, unit), left first, but for the sensor's habit to show both turned in or out.
    pub fn aim(&mut self, now: BodyInput, pelvis: Quat) -> [Option<Vec3>; 2] {
        if let (Some(left), Some(right)) = (self.feet[0].outwards(now, pelvis), self.feet[1].outwards(now, pelvis)) {
            self.turn.learn(Vec3::X * (0.5 * (left + right)), now.dt);
        }
        let habit = self.turn.value().x.clamp(-MAX_TURN, MAX_TURN);
        self.feet.each_ref().map(|foot| {
            let shown = now.seen.direction(foot.ankle, foot.toe)?;
            Some(Quat::from_rotation_y(-habit * foot.side.sign()) * shown)
        })
    }

    /// Turns one foot, 0 left or 1 right, against its shin's rotation (rest to world).
    pub fn update(&mut self, now: BodyInput, foot: usize, shin: Quat, toe: Option<Vec3>, local: &mut [Quat; JOINTS]) {
        self.feet[foot].update(now, shin, toe, local);
    }
}

/// Tracks one foot: where it is planted, and how it is turned.
#[derive(Debug, Clone)]
struct Foot {
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
    fn new(skeleton: &Skeleton, side: Side) -> Self {
        let (ankle, toe) = match side {
            Side::Left => (Joint::LeftAnkle, Joint::LeftToe),
            Side::Right => (Joint::RightAnkle, Joint::RightToe),
        };
        let ahead = skeleton.at(toe) - skeleton.at(ankle);
        let heading = level(ahead).unwrap_or(Vec3::Z);
        Self { ankle, toe, side, heading, ahead: heading, flat_slope: slope(ahead.normalize_or(heading)) }
    }

    /// Turns the foot, seen to point towards `toe` (world, unit), against the shin's rotation (rest to world).
    fn update(&mut self, now: BodyInput, shin: Quat, toe: Option<Vec3>, local: &mut [Quat; JOINTS]) {
        let lift = now.seen.at(self.ankle).map_or(0.0, |p| now.ground.lift(p.y));
        let standing = 1.0 - ramp(STANDING, lift);
        let share = now.share(SWING_TAU + (STAND_TAU - SWING_TAU) * standing);
        let target = match toe {
            Some(toe) => {
                let difference = slope(toe) - self.flat_slope;
                self.flat_slope += difference * fraction(now.dt * standing * standing, SLOPE_TAU);
                self.turn_to(level(toe), share);
                self.stand(self.ahead, shin, (slope(toe) - self.flat_slope) * (1.0 - standing))
            }
            None => {
                self.turn_to(level(shin * self.heading), share);
                let flat = self.stand(self.ahead, shin, 0.0);
                flat.slerp(Quat::IDENTITY, ramp(HANGING, lift))
            }
        };
        local[self.ankle.index()] = limits::ANKLE.clamp(target, self.side);
    }

    /// How far the foot is turned outwards against the pelvis, more than in the rest pose (rad), if it stands.
    fn outwards(&self, now: BodyInput, pelvis: Quat) -> Option<f32> {
        let stands = now.ground.lift(now.seen.at(self.ankle)?.y) < STANDING[0];
        let toe = level(now.seen.direction(self.ankle, self.toe)?)?;
        let plain = level(pelvis * self.heading)?;
        let turn = plain.cross(toe).y.atan2(plain.dot(toe));
        (stands && now.seen.believes(&[self.ankle, self.toe])).then_some(turn * self.side.sign())
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
