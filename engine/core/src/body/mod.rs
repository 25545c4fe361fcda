//! Pose: the latest joints become joint rotations of a body of other proportions.
//!
//! Reads: filtered joints with confidence; the measured body's skeleton. Writes: a pose within human limits, the palette.
//! Budget: 20 us a step; nothing allocated.
//! Thread: physics, 120 Hz.

mod foot;
pub mod ground;
pub mod kinematics;
mod limb;
pub mod limits;
mod retarget;
pub mod smooth;
#[cfg(test)]
mod tests;

pub use kinematics::{JointFrames, palette};

use glam::Vec3;
use toile_assets::skeleton::{JOINTS, Joint, Pose, Skeleton};
use toile_sensors::frame::Joints;

use ground::Ground;
use retarget::{Retarget, Seen};
use smooth::{ANGLE_TAU, LIMB_SPEED, TRUNK_SPEED, move_towards, turn_towards};

/// Fastest that the person is carried along (m/s): a run.
pub const ROOT_SPEED: f32 = 5.0;

/// Longest step that is taken as one (s): after a longer gap nothing of the past would be left anyway.
const MAX_DT: f32 = 1.0;

/// Turns joints into poses of one skeleton, moment by moment.
///
/// Joints below the confidence gate, or that are no numbers, keep their last rotation. The first moment in which hips
/// and trunk are seen is taken over as it is; from then on every angle moves smoothly and at a bounded speed, so
/// whatever the sensor does, the pose never jumps and is always finite.
#[derive(Debug, Clone)]
pub struct Poser {
    skeleton: Skeleton,
    retarget: Retarget,
    ground: Ground,
    /// Where the pelvis is wanted on the floor's plane; y is not used.
    place: Vec3,
    pose: Pose,
    started: bool,
}

impl Poser {
    /// A person in the rest pose, not seen yet.
    pub fn new(skeleton: &Skeleton) -> Self {
        Self {
            skeleton: skeleton.clone(),
            retarget: Retarget::new(skeleton),
            ground: Ground::new(skeleton),
            place: skeleton.at(Joint::Pelvis),
            pose: Pose::rest(skeleton),
            started: false,
        }
    }

    /// Forgets the person: the next moment is taken over as it is.
    pub fn reset(&mut self) {
        *self = Self::new(&self.skeleton);
    }

    /// The skeleton that is posed.
    pub fn skeleton(&self) -> &Skeleton {
        &self.skeleton
    }

    /// The pose `dt` (s) after the last call, from the latest joints; call it every step, also with old joints.
    pub fn pose(&mut self, joints: &Joints, dt: f32) -> Pose {
        let dt = if dt.is_finite() { dt.clamp(0.0, MAX_DT) } else { 0.0 };
        let seen = Seen::new(joints);
        let first = !self.started;
        if first && seen.middle(Joint::LeftHip, Joint::RightHip).is_none() {
            return self.pose;
        }
        self.started = true;
        self.ground.observe(&seen, dt);
        self.retarget.update(&seen, &self.ground, dt, first);
        let mut next = if first { Pose { local: self.retarget.local, ..self.pose } } else { self.turn(dt) };
        self.carry(&seen, &mut next, dt, first);
        if next.root.is_finite() && next.local.iter().all(|q| q.is_finite()) {
            self.pose = next;
        } else {
            // No input is known to lead here; should one, the last good pose stays and the memory starts anew.
            self.retarget = Retarget::new(&self.skeleton);
            self.ground = Ground::new(&self.skeleton);
        }
        self.pose
    }

    /// Every joint moved towards its target.
    fn turn(&self, dt: f32) -> Pose {
        let mut next = self.pose;
        for i in 0..JOINTS {
            let trunk = i <= Joint::Head.index();
            let speed = if trunk { TRUNK_SPEED } else { LIMB_SPEED };
            next.local[i] = turn_towards(self.pose.local[i], self.retarget.local[i], dt, ANGLE_TAU, speed);
        }
        next
    }

    /// Puts the root where the hips are seen, at the height at which our feet stand.
    fn carry(&mut self, seen: &Seen, next: &mut Pose, dt: f32, first: bool) {
        let frames = JointFrames::new(&self.skeleton, &Pose { root: Vec3::ZERO, ..*next });
        if let Some(hips) = seen.middle(Joint::LeftHip, Joint::RightHip) {
            self.place = hips - (frames.at(Joint::LeftHip) + frames.at(Joint::RightHip)) * 0.5;
        }
        let height = self.ground.root_height(&self.skeleton, &frames);
        let wanted = self.place.with_y(height);
        next.root = if first { wanted } else { move_towards(next.root, wanted, dt, ANGLE_TAU, ROOT_SPEED) };
        next.root.y = height;
    }
}
