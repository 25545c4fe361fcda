//! The floor under the person: where it is for the sensor, and how high our body stands over it.
//!
//! Our feet stand when the sensor's stand, whatever the proportions: the root is set so that the lowest point of our
//! body touches the floor, then lifted by what the sensor's lowest joints rise above where they usually are. So a jump
//! stays a jump, which a foot that is always held to the floor forbids (Gultepe 2013, section 4.5).

use glam::Vec3;
use toile_assets::skeleton::{Joint, Skeleton};

use super::kinematics::JointFrames;
use super::limb::ramp;
use super::seen::Seen;
use super::smooth::fraction;

/// Time constant with which a lower floor is taken over (s).
const DOWN_TAU: f32 = 0.15;

/// Time constant (s) and greatest speed (m/s) with which a higher floor is taken over: slow, as it may be a jump.
const UP_TAU: f32 = 5.0;
const UP_SPEED: f32 = 0.02;

/// Rise (m) up to which feet are taken to stand, and from which the rise is taken as it is: bones held to their length
/// lift the feet with a hip that wobbles by as much.
const RISE: [f32; 2] = [0.06, 0.14];

/// Longest flight (s): a jump of 80 cm. Who is up longer stands on something.
const LONGEST_FLIGHT: f32 = 0.8;

/// Time constant with which the floor then comes up (s).
const LIFT_TAU: f32 = 0.2;

/// Time constant of the clearance (s).
const CLEARANCE_TAU: f32 = 0.03;

/// Heel behind the ankle, and tip of the toes ahead of the toe joint (m), along the foot.
const HEEL: f32 = 0.04;
const TIP: f32 = 0.05;

/// Joints besides the feet that may touch the floor, and how far they are inside the body (m).
const TOUCHING: [(Joint, f32); 8] = [
    (Joint::Pelvis, 0.10),
    (Joint::Head, 0.10),
    (Joint::LeftKnee, 0.05),
    (Joint::RightKnee, 0.05),
    (Joint::LeftElbow, 0.04),
    (Joint::RightElbow, 0.04),
    (Joint::LeftWrist, 0.03),
    (Joint::RightWrist, 0.03),
];

/// What is known of the sensor's floor.
#[derive(Debug, Clone, Default)]
pub struct Ground {
    /// Usual height (m) of the lower ankle and the lower toe in the sensor's world.
    ankle: Option<f32>,
    toe: Option<f32>,
    /// Height of a standing ankle of our skeleton (m).
    ankle_height: f32,
    /// How far the lowest point is off the floor (m), smooth.
    clearance: f32,
    /// How long the feet have been up (s).
    flight: f32,
}

impl Ground {
    /// Nothing known yet.
    pub fn new(skeleton: &Skeleton) -> Self {
        let ankle_height = skeleton.at(Joint::LeftAnkle).y.min(skeleton.at(Joint::RightAnkle).y);
        Self { ankle_height, ..Self::default() }
    }

    /// Takes in the heights of one moment.
    pub fn observe(&mut self, seen: &Seen, dt: f32) {
        let height = |joint| seen.at(joint).map(|p| p.y);
        let ankle = height(Joint::LeftAnkle).zip(height(Joint::RightAnkle)).map(|(l, r)| l.min(r));
        let toe = height(Joint::LeftToe).zip(height(Joint::RightToe)).map(|(l, r)| l.min(r));
        let landed = self.flight > LONGEST_FLIGHT;
        let ankle_rise = track(&mut self.ankle, ankle, dt, landed);
        let toe_rise = track(&mut self.toe, toe, dt, landed);
        let rise = match (ankle_rise, toe_rise) {
            (Some(a), Some(t)) => a.min(t),
            (Some(a), None) => a,
            (None, _) => 0.0,
        };
        let rise = rise.min(self.others(seen)).max(0.0);
        self.flight = if rise > RISE[0] { self.flight + dt } else { 0.0 };
        self.clearance += (rise * ramp(RISE, rise) - self.clearance) * fraction(dt, CLEARANCE_TAU);
    }

    /// How far an ankle at height `y` is above where ankles stand (m).
    pub fn lift(&self, y: f32) -> f32 {
        self.ankle.map_or(0.0, |base| (y - base).max(0.0))
    }

    /// Height of the root above the floor (m) for joint frames whose root is at the origin.
    pub fn root_height(&self, skeleton: &Skeleton, frames: &JointFrames) -> f32 {
        self.clearance - lowest(skeleton, frames)
    }

    /// Least height of the other joints above the sensor's floor (m): knees or hands may be what is stood on.
    fn others(&self, seen: &Seen) -> f32 {
        let floor = self.ankle.unwrap_or(0.0) - self.ankle_height;
        let heights = TOUCHING.iter().filter_map(|(joint, radius)| Some(seen.at(*joint)?.y - radius - floor));
        heights.fold(f32::INFINITY, f32::min)
    }
}

/// Follows the usual height of the lower of two joints, and returns how far it is above that (m).
fn track(base: &mut Option<f32>, low: Option<f32>, dt: f32, landed: bool) -> Option<f32> {
    let low = low?;
    let base = base.get_or_insert(low);
    let above = low - *base;
    *base += if above < 0.0 {
        above * fraction(dt, DOWN_TAU)
    } else if landed {
        above * fraction(dt, LIFT_TAU)
    } else {
        (above * fraction(dt, UP_TAU)).min(UP_SPEED * dt.max(0.0))
    };
    Some(low - *base)
}

/// Height of the lowest point of the body (m): soles, and joints with their radius.
pub fn lowest(skeleton: &Skeleton, frames: &JointFrames) -> f32 {
    let soles = soles(skeleton, frames).into_iter().flatten().map(|p| p.y);
    let others = TOUCHING.iter().map(|(joint, radius)| frames.at(*joint).y - radius);
    soles.chain(others).fold(f32::INFINITY, f32::min)
}

/// World positions (m) of heel, ball and tip of both soles, left first. The sole is level in the rest pose, at y = 0.
pub fn soles(skeleton: &Skeleton, frames: &JointFrames) -> [[Vec3; 3]; 2] {
    [(Joint::LeftAnkle, Joint::LeftToe), (Joint::RightAnkle, Joint::RightToe)].map(|(ankle, toe)| {
        let (at, ball) = (skeleton.at(ankle), skeleton.at(toe));
        let ahead = (ball - at).with_y(0.0).normalize_or(Vec3::Z);
        [at - ahead * HEEL, ball, ball + ahead * TIP]
            .map(|rest| frames.at(ankle) + frames.turn(ankle) * (rest.with_y(0.0) - at))
    })
}
