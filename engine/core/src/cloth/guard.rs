//! Guard: the doors of the cloth. Nothing that is not finite comes in, leaves, or stays.

use glam::Vec3A;

use super::state::{self, Columns};
use crate::lanes::{Column, Kernel, Lanes, Mask};

/// What went wrong, counted since the garment was made.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Events {
    /// Particles that were not finite when a step began, or ran away; put back to their last good place.
    pub repaired: u64,
    /// Steps that ended with a value that is not finite and were rolled back.
    pub rolled_back: u64,
    /// Particle substeps that were held at the speed limit.
    pub speed_limited: u64,
    /// Skinned particles whose target was not finite and that were held.
    pub held_pins: u64,
    /// Steps whose settings no step can be made with; it was made with sound ones.
    pub held_settings: u64,
    /// Steps in which the root jumped and the garment was reset or carried along.
    pub teleports: u64,
    /// Sphere steps in which a collider was not where it was said to be, because it had jumped or was not finite; since
    /// the colliders were made.
    pub held_colliders: u64,
}

/// Farthest from the origin that anything can be (m): beyond it, f32 no longer tells millimetres apart.
const FARTHEST_M: f32 = 10_000.0;

/// Whether every number of some columns is finite and within reach.
pub struct Sound<'a>(pub [Column<'a>; 3]);

impl Kernel for Sound<'_> {
    type Out = bool;

    #[inline(always)]
    fn run<L: Lanes>(self) -> bool {
        let (mut least, mut most) = (L::splat(0.0), L::splat(0.0));
        let mut sum = L::splat(0.0);
        for column in self.0 {
            let whole = column.len() / L::N * L::N;
            let mut at = 0;
            while at < whole {
                let v = L::load(column, at);
                (least, most, sum) = (least.min(v), most.max(v), sum + v * L::splat(0.0));
                at += L::N;
            }
            if at < column.len() {
                let v = L::load_part(column, at, column.len() - at);
                (least, most, sum) = (least.min(v), most.max(v), sum + v * L::splat(0.0));
            }
        }
        let far = L::splat(FARTHEST_M);
        let outside = far.lt(most).any() || least.lt(-far).any();
        // What is not a number, times 0, is not 0.
        !outside && sum.to_array().iter().all(|s| *s == 0.0)
    }
}

/// Puts every particle that is not finite back to its last good place, at rest; gives how many.
pub fn repair(columns: Columns<'_>, good: &[Vec3A]) -> u64 {
    let mut repaired = 0;
    for (i, &good) in good.iter().enumerate() {
        let (x, v) = (state::get(columns.x, i), state::get(columns.v, i));
        let sound = x.is_finite() && v.is_finite() && x.abs().max_element() <= FARTHEST_M;
        if !sound {
            state::set(columns.x, i, good);
            state::set(columns.previous, i, good);
            state::set(columns.v, i, Vec3A::ZERO);
            repaired += 1;
        }
    }
    repaired
}

/// Puts the whole garment back, `towards` of the way from its last good place to where it was dressed, at rest.
pub fn roll_back(columns: Columns<'_>, good: &[Vec3A], dressed: impl Fn(usize) -> Vec3A, towards: f32) {
    for (i, &good) in good.iter().enumerate() {
        let goal = if towards > 0.0 { good.lerp(dressed(i), towards) } else { good };
        let goal = if goal.is_finite() { goal } else { good };
        state::set(columns.x, i, goal);
        state::set(columns.previous, i, goal);
        state::set(columns.v, i, Vec3A::ZERO);
    }
}
