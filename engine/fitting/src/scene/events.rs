//! Counts of the interventions of the cloth's guards, in sums and differences.

use serde::Serialize;

/// What happened that should not have, over some steps of a cloth.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize)]
pub struct ClothEvents {
    /// Particles that were put back to their last good place.
    pub repaired: u64,
    /// Steps taken back because something was not finite.
    pub rolled_back: u64,
    /// Particle substeps at the speed limit.
    pub speed_limited: u64,
    /// Pinned particles whose target was not finite and was not followed.
    pub held_pins: u64,
    /// Steps in which the root jumped.
    pub teleports: u64,
    /// Collision spheres that jumped or were not finite and were held.
    pub held_colliders: u64,
}

impl ClothEvents {
    fn fields(&mut self) -> [&mut u64; 6] {
        let Self { repaired, rolled_back, speed_limited, held_pins, teleports, held_colliders } = self;
        [repaired, rolled_back, speed_limited, held_pins, teleports, held_colliders]
    }

    /// What happened since an earlier count.
    pub fn since(mut self, mut earlier: Self) -> Self {
        self.fields().into_iter().zip(earlier.fields()).for_each(|(now, then)| *now -= *then);
        self
    }
}

impl From<toile_engine::cloth::step::guard::GuardEvents> for ClothEvents {
    fn from(e: toile_engine::cloth::step::guard::GuardEvents) -> Self {
        Self {
            repaired: e.repaired,
            rolled_back: e.rolled_back,
            speed_limited: e.speed_limited,
            held_pins: e.held_pins,
            teleports: e.teleports,
            held_colliders: e.held_colliders,
        }
    }
}

impl std::iter::Sum for ClothEvents {
    fn sum<I: Iterator<Item = Self>>(all: I) -> Self {
        all.fold(Self::default(), |mut sum, mut e| {
            sum.fields().into_iter().zip(e.fields()).for_each(|(sum, e)| *sum += *e);
            sum
        })
    }
}
