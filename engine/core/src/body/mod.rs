//! Pose: the latest joints become joint rotations of a body of other proportions.
//!
//! A step may take 20 us; 16 us were measured, 10 of them to keep the arms clear of the body. It allocates nothing and runs on
//! the physics thread at 120 Hz.

mod arm_clearance;
mod body_input;
mod foot;
pub mod ground;
pub mod kinematics;
mod leg;
mod limb;
pub mod limits;
mod neutral;
mod plant;
mod reliable_joints;
mod retarget;
pub mod smooth;
mod stance;
#[cfg(test)]
mod tests;
mod tread;
mod trunk;

pub use kinematics::{JointFrames, palette};

use crate::cone::RestSphere;
use glam::Vec3;
use toile_base::frame::Joints;
use toile_base::skeleton::{JOINTS, Joint, Pose, Skeleton};

use arm_clearance::ArmClearance;
use body_input::BodyInput;
use ground::Ground;
use reliable_joints::ReliableJoints;
use retarget::Retarget;
use smooth::{ANGLE_TAU, LIMB_SPEED, TRUNK_SPEED, turn_towards};
use stance::Stance;
use tread::Tread;

/// Fastest that the person is carried along (m/s): a run.
pub const ROOT_SPEED: f32 = 5.0;

/// Joints by which the person is placed, the best first; hips are better than any.
const ANCHORS: [Joint; 4] = [Joint::Pelvis, Joint::Spine, Joint::Chest, Joint::Neck];

/// Longest step that is taken as one (s): after a longer gap nothing of the past would be left anyway.
const MAX_DT: f32 = 1.0;

/// Turns joints into poses of one skeleton, moment by moment.
///
/// Joints that are absent or not finite keep their last rotation; those below the confidence gate are followed
/// slowly, as a filter holds them for the sensor. The first moment in which the trunk is seen is taken over as it is;
/// from then on every angle moves smoothly and at a bounded speed, so whatever the sensor does, the pose never jumps
/// and is always finite.
#[derive(Debug, Clone)]
pub struct Poser {
    skeleton: Skeleton,
    retarget: Retarget,
    ground: Ground,
    stance: Stance,
    /// Where the pelvis is seen, and where it is carried to before feet are held, world (m); y is not used.
    place: Vec3,
    carried: Vec3,
    /// Where planted feet are kept.
    tread: Tread,
    clear: ArmClearance,
    /// The pose before feet are kept and the arms kept clear of the body.
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
            stance: Stance::default(),
            place: skeleton.at(Joint::Pelvis),
            carried: skeleton.at(Joint::Pelvis),
            tread: Tread::default(),
            clear: ArmClearance::default(),
            pose: Pose::rest(skeleton),
            started: false,
        }
    }

    /// The same, with arms that stay out of the body that these spheres and capsules make up. At load.
    #[must_use]
    pub fn keeping_clear(self, spheres: &[RestSphere], capsules: &[[u8; 2]]) -> Self {
        Self { clear: ArmClearance::new(spheres, capsules), ..self }
    }

    /// Forgets the person: the next moment is taken over as it is.
    pub fn reset(&mut self) {
        let mut clear = std::mem::take(&mut self.clear);
        clear.reset();
        *self = Self { clear, ..Self::new(&self.skeleton) };
    }

    /// The pose `dt` (s) after the last call, from the latest joints; call it every step, also with old joints.
    pub fn pose(&mut self, joints: &Joints, dt: f32) -> Pose {
        let dt = if dt.is_finite() { dt.clamp(0.0, MAX_DT) } else { 0.0 };
        let seen = ReliableJoints::new(joints);
        let first = !self.started;
        if first && ANCHORS.iter().all(|j| seen.at(*j).is_none()) {
            return self.pose;
        }
        self.started = true;
        self.ground.observe(&seen, dt, first);
        self.retarget.update(BodyInput { seen: &seen, ground: &self.ground, dt, first });
        let mut next = if first { Pose { local: self.retarget.local, ..self.pose } } else { self.turn(dt) };
        self.carry(&seen, &mut next, dt, first);
        if next.root.is_finite() && next.local.iter().all(|q| q.is_finite()) {
            self.pose = next;
        } else {
            // No input is known to lead here; should one, the last good pose stays and the memory starts anew.
            self.retarget = Retarget::new(&self.skeleton);
            self.ground = Ground::new(&self.skeleton);
        }
        let mut shown = self.pose;
        self.tread.apply(&self.skeleton, &mut shown, self.stance.planted(), dt);
        self.clear.apply(&self.skeleton, &mut shown, dt, first);
        shown
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
    fn carry(&mut self, seen: &ReliableJoints, next: &mut Pose, dt: f32, first: bool) {
        let frames = JointFrames::new(&self.skeleton, &Pose { root: Vec3::ZERO, ..*next });
        if let Some(hips) = seen.hips() {
            self.place = hips - (frames.at(Joint::LeftHip) + frames.at(Joint::RightHip)) * 0.5;
        } else if let Some(joint) = ANCHORS.into_iter().find(|j| seen.at(*j).is_some()) {
            self.place = seen.at(joint).unwrap_or(self.place) - frames.at(joint);
        }
        let now = BodyInput { seen, ground: &self.ground, dt, first };
        self.carried = self.carried.lerp(self.place, now.share(ANGLE_TAU));
        let shift = self.stance.shift(now, &self.skeleton, &frames, self.carried);
        let step = (self.carried + shift - self.pose.root).with_y(0.0);
        let step = if first { step } else { step.clamp_length_max(ROOT_SPEED * dt) };
        next.root = (self.pose.root + step).with_y(self.ground.root_height(&self.skeleton, &frames));
    }
}
