//! Standing feet stay: what the pose would make a standing foot slide is taken back by shifting the whole body.
//!
//! Hips wobble in a sensor more than feet do, and angles shown with other bone lengths carry a foot elsewhere. The
//! shift fades, so the body never strays from where it is seen (after the root relocation of Gultepe 2013, section 4.5).

use glam::Vec3;
use toile_base::skeleton::Skeleton;

use super::body_input::BodyInput;
use super::ground::soles;
use super::kinematics::JointFrames;
use super::plant::Plant;
use super::smooth::fraction;
use super::tread::ANKLES;

/// Time constant with which the shift fades (s), and its greatest length (m).
const FADE_TAU: f32 = 1.5;
const MAX_SHIFT: f32 = 0.15;

/// What is remembered of the feet.
#[derive(Debug, Clone, Default)]
pub struct Stance {
    shift: Vec3,
    feet: [StanceFoot; 2],
}

#[derive(Debug, Clone, Copy, Default)]
struct StanceFoot {
    plant: Plant,
    /// Where the middle of our sole was, world (m).
    sole: Option<Vec3>,
}

impl Stance {
    /// Level shift (m) to add to a root at `root`; `frames` are joint frames with the root at the origin.
    pub fn shift(&mut self, now: BodyInput, skeleton: &Skeleton, frames: &JointFrames, root: Vec3) -> Vec3 {
        let (seen, ground, dt) = (now.seen, now.ground, now.dt);
        self.shift *= 1.0 - fraction(dt, FADE_TAU);
        let before = self.shift;
        let soles = soles(skeleton, frames).map(|[heel, ball, _]| (heel + ball) * 0.5 + root);
        let (mut slip, mut total, mut most) = (Vec3::ZERO, 0.0, 0.0_f32);
        for ((foot, ankle), sole) in self.feet.iter_mut().zip(ANKLES).zip(soles) {
            foot.plant.watch(seen.at(ankle), ground, dt);
            let stands = foot.plant.share(ground);
            if let Some(last) = foot.sole {
                slip += (sole + before - last) * stands;
                total += stands;
                most = most.max(stands);
            }
        }
        if total > 0.0 {
            self.shift -= (slip * (most / total)).with_y(0.0);
        }
        self.shift = self.shift.clamp_length_max(MAX_SHIFT);
        for (foot, sole) in self.feet.iter_mut().zip(soles) {
            foot.sole = Some(sole + self.shift);
        }
        self.shift
    }

    /// Which feet are planted, left first.
    pub fn planted(&self) -> [bool; 2] {
        self.feet.each_ref().map(|foot| foot.plant.is_planted())
    }
}
