//! Guard: no NaN or infinity enters the cloth, stays in it, or is published.

use glam::Vec3A;
use toile_base::numeric::portable;

use crate::cloth::state::{self, ParticleColumns};
use crate::lanes::{Kernel, Lanes, Mask, WriteColumn};

/// What went wrong, counted since the garment was made.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct GuardEvents {
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
    /// Steps that were refused because they were asked for with another garment than the state's own.
    pub refused: u64,
}

impl std::ops::Add for GuardEvents {
    type Output = Self;

    fn add(self, more: Self) -> Self {
        Self {
            repaired: self.repaired + more.repaired,
            rolled_back: self.rolled_back + more.rolled_back,
            speed_limited: self.speed_limited + more.speed_limited,
            held_pins: self.held_pins + more.held_pins,
            held_settings: self.held_settings + more.held_settings,
            teleports: self.teleports + more.teleports,
            held_colliders: self.held_colliders + more.held_colliders,
            refused: self.refused + more.refused,
        }
    }
}

/// Farthest from the origin that anything can be (m): beyond it, f32 no longer tells millimetres apart.
const FARTHEST_M: f32 = 10_000.0;

/// What is less than this is nothing (m, m/s): a picometre. Of a motion that fades, what is left would be too small for
/// a normal number in the end, and with those many processors count a hundred times slower; squares of this are not.
const LEAST: f32 = 1e-12;

/// Whether every number of some columns is finite and within reach; those that are next to nothing become nothing.
pub struct AllFinite<'a>(pub [WriteColumn<'a>; 3]);

impl Kernel for AllFinite<'_> {
    type Out = bool;

    #[inline(always)]
    fn run<L: Lanes>(self) -> bool {
        let zero = L::splat(0.0);
        let (mut most, mut sum) = (zero, zero);
        for column in self.0 {
            let mut at = 0;
            while at < column.len() {
                let n = (column.len() - at).min(L::N);
                let v = if n == L::N { L::load(column, at) } else { L::load_part(column, at, n) };
                let size = v.max(-v);
                // What is not a number, times 0, is not 0.
                (most, sum) = (most.max(size), sum + v * zero);
                let tiny = size.lt(L::splat(LEAST)).and(zero.lt(size));
                if tiny.any() {
                    let calm = zero.select(tiny, v);
                    if n == L::N { calm.store(column, at) } else { calm.store_part(column, at, n) }
                }
                at += n;
            }
        }
        !L::splat(FARTHEST_M).lt(most).any() && sum.to_array().iter().all(|s| *s == 0.0)
    }
}

/// What a soak writes over the state to try the guard.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum InjectedFault {
    /// A place (m).
    Place(Vec3A),
    /// A velocity (m/s).
    Velocity(Vec3A),
}

/// Of `particles` eight that `seed` picks: two each get a place that is NaN, an infinite velocity, a place beyond all
/// measure, and a violent velocity.
pub fn spoil(seed: u64, particles: usize) -> [(usize, InjectedFault); 8] {
    let mut at = seed;
    std::array::from_fn(|k| {
        // Knuth's multiplier, and the upper bits, which are the better ones.
        at = at.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let what = match k % 4 {
            0 => InjectedFault::Place(Vec3A::NAN),
            1 => InjectedFault::Velocity(Vec3A::INFINITY),
            2 => InjectedFault::Place(Vec3A::splat(1e30)),
            _ => InjectedFault::Velocity(Vec3A::new(900.0, -500.0, 700.0)),
        };
        ((at >> 33) as usize % particles.max(1), what)
    })
}

/// Puts every particle that is not finite back to its last good place, at rest; gives how many.
pub fn repair(columns: ParticleColumns<'_>, good: &[Vec3A]) -> u64 {
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
pub fn roll_back(columns: ParticleColumns<'_>, good: &[Vec3A], dressed: impl Fn(usize) -> Vec3A, towards: f32) {
    for (i, &good) in good.iter().enumerate() {
        let goal = if towards > 0.0 { portable::lerp(good, dressed(i), towards) } else { good };
        let goal = if goal.is_finite() { goal } else { good };
        state::set(columns.x, i, goal);
        state::set(columns.previous, i, goal);
        state::set(columns.v, i, Vec3A::ZERO);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lanes::{Store, Width};

    #[test]
    fn what_is_next_to_nothing_becomes_nothing_and_all_else_stays() {
        let small = [1e-40, -3e-20, 9e-13, -9e-13, 0.0, f32::MIN_POSITIVE];
        let large = [1.1e-12, -1.1e-12, 1e-6, -2.5, 9_999.0];
        for width in Width::ALL.into_iter().filter(|w| w.available()) {
            let mut store = Store::zeros(3 * 37);
            let value = |i: usize| if i.is_multiple_of(2) { small[i % small.len()] } else { large[i % large.len()] };
            store.as_mut().iter_mut().enumerate().for_each(|(i, v)| *v = value(i));
            let all = store.column();
            assert!(width.run(AllFinite([0, 1, 2].map(|k| all.part(k * 37, 37)))), "{width} lanes");
            for (i, v) in store.as_slice().iter().take(3 * 37).enumerate() {
                assert_eq!(*v, if i % 2 == 0 { 0.0 } else { value(i) }, "{width} lanes, number {i}");
            }
        }
    }

    #[test]
    fn one_number_that_is_none_or_out_of_reach_is_found_anywhere() {
        for width in Width::ALL.into_iter().filter(|w| w.available()) {
            for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 1e30, -10_001.0] {
                for i in 0..3 * 21 {
                    let mut store = Store::zeros(3 * 21);
                    store.as_mut()[i] = bad;
                    let all = store.column();
                    assert!(!width.run(AllFinite([0, 1, 2].map(|k| all.part(k * 21, 21)))), "{width}: {bad} at {i}");
                }
            }
        }
    }
}
