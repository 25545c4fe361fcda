//! The floor under the person: where it is for the sensor, and how high our body stands over it.
//!
//! Our feet stand when the sensor's stand, whatever the proportions: the root is set so that the lowest point of our
//! body touches the floor, then lifted by what the sensor's lowest joints rise above where they usually are. So a jump
//! stays a jump, which a foot that is always held to the floor forbids (Gultepe 2013, section 4.5).

use glam::Vec3;
use toile_base::skeleton::{Joint, Skeleton};

use super::kinematics::JointFrames;
use super::reliable_joints::ReliableJoints;
use super::smooth::{fraction, ramp};

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

/// Rise of both feet (m) from which the legs are doubted, and from which they are not believed at all: higher than
/// people jump from a stand.
const TOO_HIGH: [f32; 2] = [0.45, 0.6];

/// The same for ankles that a filter holds or a sensor infers: what is not seen does not jump.
const TOO_HIGH_UNSEEN: [f32; 2] = [0.15, 0.3];

/// Time constants with which the legs are doubted, and believed again (s).
const DOUBT_TAU: f32 = 0.05;
const BELIEVE_TAU: f32 = 0.3;

/// Highest floor (m): a step or a stool. A sensor's world has its floor at y = 0, whatever its legs look like.
const HIGHEST_FLOOR: f32 = 0.35;

/// Fastest rise and fall of the feet (m/s): that of a jump of 80 cm.
const JUMP_SPEED: f32 = 4.0;

/// Time constant of the clearance (s).
const CLEARANCE_TAU: f32 = 0.03;

/// Clearance from which the body is in the air (m).
const FLYING: f32 = 0.01;

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
#[derive(Debug, Clone)]
pub struct Ground {
    /// Usual height (m) of the lower ankle and the lower toe in the sensor's world.
    ankle: f32,
    toe: f32,
    /// Height of a standing ankle of our skeleton (m).
    ankle_height: f32,
    /// How far the lowest point is off the floor (m), smooth.
    clearance: f32,
    /// How long the feet have been up (s).
    flight: f32,
    /// How far the legs are believed, 0 to 1.
    trust: f32,
}

impl Ground {
    /// Nothing seen yet: the floor is taken at y = 0, where the world has it.
    pub fn new(skeleton: &Skeleton) -> Self {
        let ankle_height = skeleton.at(Joint::LeftAnkle).y.min(skeleton.at(Joint::RightAnkle).y);
        let toe = skeleton.at(Joint::LeftToe).y.min(skeleton.at(Joint::RightToe).y);
        Self { ankle: ankle_height, toe, ankle_height, clearance: 0.0, flight: 0.0, trust: 1.0 }
    }

    /// Takes in the heights of one moment; `first` takes them over without memory.
    pub fn observe(&mut self, seen: &ReliableJoints, dt: f32, first: bool) {
        let height = |joint| seen.at(joint).map(|p| p.y);
        let lower = |left, right| Some(f32::min(height(left)?, height(right)?));
        let landed = self.flight > LONGEST_FLIGHT;
        let ankle = track(&mut self.ankle, lower(Joint::LeftAnkle, Joint::RightAnkle), dt, landed);
        let toe = track(&mut self.toe, lower(Joint::LeftToe, Joint::RightToe), dt, landed);
        let feet = ankle.map_or(0.0, |a| toe.map_or(a, |t| a.min(t)));
        let ankles_seen = seen.believes(&[Joint::LeftAnkle]) || seen.believes(&[Joint::RightAnkle]);
        let believed = 1.0 - ramp(if ankles_seen { TOO_HIGH } else { TOO_HIGH_UNSEEN }, feet);
        let rise = feet.min(self.others(seen)).max(0.0);
        self.flight = if rise > RISE[0] { self.flight + dt } else { 0.0 };
        let share = |tau| if first { 1.0 } else { fraction(dt, tau) };
        self.trust += (believed - self.trust) * share(if believed < self.trust { DOUBT_TAU } else { BELIEVE_TAU });
        let flies = seen.believes(&[Joint::LeftAnkle, Joint::RightAnkle]);
        let wanted = if flies { rise * ramp(RISE, rise) * self.trust.min(believed) } else { 0.0 };
        let step = (wanted - self.clearance) * share(CLEARANCE_TAU);
        self.clearance += if first { step } else { step.clamp(-JUMP_SPEED * dt, JUMP_SPEED * dt) };
    }

    /// Confidence in the legs, 0 to 1: it falls while both feet are seen higher than a person can jump.
    pub fn legs_trust(&self) -> f32 {
        self.trust
    }

    /// Whether the body is in the air: both feet are off the floor by more than they wobble.
    pub fn flies(&self) -> bool {
        self.clearance > FLYING
    }

    /// How far an ankle at height `y` is above where ankles stand (m).
    pub fn lift(&self, y: f32) -> f32 {
        (y - self.ankle).max(0.0)
    }

    /// Height of the root above the floor (m) for joint frames whose root is at the origin.
    pub fn root_height(&self, skeleton: &Skeleton, frames: &JointFrames) -> f32 {
        self.clearance - lowest(skeleton, frames)
    }

    /// Least height of the other joints above the sensor's floor (m): knees or hands may be what is stood on.
    fn others(&self, seen: &ReliableJoints) -> f32 {
        let floor = self.ankle - self.ankle_height;
        let heights = TOUCHING.iter().filter_map(|(joint, radius)| Some(seen.at(*joint)?.y - radius - floor));
        heights.fold(f32::INFINITY, f32::min)
    }
}

/// Follows the usual height of the lower of two joints, and returns how far it is above that (m).
fn track(base: &mut f32, low: Option<f32>, dt: f32, landed: bool) -> Option<f32> {
    let above = low? - *base;
    let rise = if landed { above * fraction(dt, LIFT_TAU) } else { (above * fraction(dt, UP_TAU)).min(UP_SPEED * dt) };
    *base += if above < 0.0 { above * fraction(dt, DOWN_TAU) } else { rise.min((HIGHEST_FLOOR - *base).max(0.0)) };
    Some(low? - *base)
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
