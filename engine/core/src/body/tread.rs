//! Where planted feet are kept: at the place where they were set down, by inverse kinematics of the leg.
//!
//! A foot that is planted keeps its sole where it is shown at that moment, so that planting moves nothing; one that is let
//! go returns to where it is seen, smoothly. What a leg cannot reach moves the whole body (root relocation, Gultepe 2013,
//! section 4.5), and a foot that is dragged too far is let go, for then it does not stand.

use glam::{Quat, Vec3};
use toile_base::skeleton::{Joint, Pose, Skeleton};

use super::ground::soles;
use super::kinematics::JointFrames;
use super::leg;
use super::limits::Side;
use super::smooth::{LIMB_SPEED, fraction, turn_towards};

/// Farthest that a planted foot is kept from where it is seen (m); beyond it is let go.
const FARTHEST: f32 = 0.12;

/// Farthest from where it is seen that a foot is shown when it is planted (m).
const PLANTABLE: f32 = 0.04;

/// Time constant with which a foot that was let go returns to where it is seen (s), and its greatest speed (m/s): that
/// of a foot which swings.
const RETURN_TAU: f32 = 0.1;
const RETURN_SPEED: f32 = 1.5;

/// Farthest that the root is moved for what a leg cannot reach (m).
const FARTHEST_ROOT: f32 = 0.05;

/// Time constant with which the root is moved (s).
const ROOT_TAU: f32 = 0.1;

/// Fastest that a kept foot is corrected (m/s): what is seen to move faster does not stand.
const KEEPING_SPEED: f32 = 1.5;

/// Time constant of a turn that is made whole in one step (s).
const AT_ONCE: f32 = 1e-6;

/// Smallest correction that is worth turning a leg for (m).
const SMALLEST: f32 = 1e-5;

/// Both feet, left first.
#[derive(Debug, Clone, Copy, Default)]
pub struct Tread {
    feet: [Kept; 2],
    /// How far the root is moved (m), level.
    root: Vec3,
    /// Rotations of hips, knees and ankles as last shown.
    shown: Option<[[Quat; 3]; 2]>,
}

#[derive(Debug, Clone, Copy, Default)]
struct Kept {
    /// Where the sole is kept, world, level (m); `None` for a foot that is free.
    place: Option<Vec3>,
    /// From where the sole is seen to where it is shown, level (m).
    shift: Vec3,
}

impl Tread {
    /// Keeps planted feet of a pose in place; `planted` left first.
    pub fn apply(&mut self, skeleton: &Skeleton, pose: &mut Pose, planted: [bool; 2], dt: f32) {
        let mut frames = JointFrames::new(skeleton, pose);
        let middles = soles(skeleton, &frames).map(|[heel, ball, _]| (heel + ball) * 0.5);
        for ((foot, sole), planted) in self.feet.iter_mut().zip(middles).zip(planted) {
            foot.keep(sole, planted, dt);
        }
        self.relocate(&frames, dt);
        pose.root += self.root;
        frames.position.iter_mut().for_each(|p| *p += self.root);
        for (foot, side) in self.feet.iter().zip(Side::BOTH) {
            let shift = foot.shift - self.root;
            if shift.length() > SMALLEST {
                let target = frames.at(leg::joints(side)[2]) + shift;
                leg::reach(pose, &frames, side, leg::within_reach(&frames, side, target));
            }
        }
        self.slow_down(pose, dt);
    }

    /// Keeps the legs from turning faster than limbs do: the speed of the pose and that of the correction may add up.
    fn slow_down(&mut self, pose: &mut Pose, dt: f32) {
        let mut shown = Side::BOTH.map(|side| leg::joints(side).map(|j| pose.local[j.index()]));
        if let Some(last) = &self.shown {
            for (turn, last) in shown.iter_mut().flatten().zip(last.iter().flatten()) {
                *turn = turn_towards(*last, *turn, dt, AT_ONCE, LIMB_SPEED);
            }
            for (side, turns) in Side::BOTH.into_iter().zip(&shown) {
                leg::joints(side).into_iter().zip(turns).for_each(|(joint, turn)| pose.local[joint.index()] = *turn);
            }
        }
        self.shown = Some(shown);
    }

    /// Moves the root by what the legs fall short of, the mean of both feet that are kept.
    fn relocate(&mut self, frames: &JointFrames, dt: f32) {
        let (mut short, mut count) = (Vec3::ZERO, 0.0);
        for (foot, side) in self.feet.iter().zip(Side::BOTH) {
            if foot.place.is_some() {
                let target = frames.at(leg::joints(side)[2]) + foot.shift;
                short += (target - leg::within_reach(frames, side, target)).with_y(0.0);
                count += 1.0;
            }
        }
        let wanted = if count > 0.0 { (short / count).clamp_length_max(FARTHEST_ROOT) } else { Vec3::ZERO };
        self.root += (wanted - self.root) * fraction(dt, ROOT_TAU);
    }
}

impl Kept {
    /// Takes in where the sole is seen.
    fn keep(&mut self, sole: Vec3, planted: bool, dt: f32) {
        let sole = sole.with_y(0.0);
        let place = self.place.filter(|place| place.distance(sole) < FARTHEST);
        self.place = match (planted, place) {
            (false, _) => None,
            (true, Some(place)) => Some(place),
            // Dragged too far, or not yet back from there.
            (true, None) if self.place.is_some() || self.shift.length() > PLANTABLE => None,
            (true, None) => Some(sole + self.shift),
        };
        if self.place.is_some_and(|place| (place - sole).distance(self.shift) > KEEPING_SPEED * dt.max(0.0)) {
            self.place = None;
        }
        self.shift = match self.place {
            Some(place) => place - sole,
            None => self.shift - (self.shift * fraction(dt, RETURN_TAU)).clamp_length_max(RETURN_SPEED * dt.max(0.0)),
        };
    }
}

/// The ankles, left first.
pub const ANKLES: [Joint; 2] = [Joint::LeftAnkle, Joint::RightAnkle];
