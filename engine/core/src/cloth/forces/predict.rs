//! Predict: gravity, air and wind move every free particle; the skinned ones follow the body.

use glam::Vec3A;

use crate::cloth::state::ParticleColumns;
use crate::lanes::{Kernel, Lanes, V3, WriteColumn};

/// Semi-implicit Euler over one owner's particles: v = (v + a dt) kept; x += v dt.
pub struct Predict<'a> {
    /// The garment's particles.
    pub columns: ParticleColumns<'a>,
    /// Ranges of particles, `(first, len)`.
    pub spans: &'a [(u32, u32)],
    /// Gravity over the substep (m/s).
    pub gravity_step: Vec3A,
    /// Accelerations of each particle besides gravity (m/s2), and the substep (s).
    pub acceleration: Option<([WriteColumn<'a>; 3], f32)>,
    /// Share of the velocity that the air leaves.
    pub damping_factor: f32,
    /// Length of the substep (s).
    pub dt: f32,
}

impl Kernel for Predict<'_> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(mut self) {
        self.columns = self.columns.level();
        for &(first, len) in self.spans {
            let (first, len) = (first as usize, len as usize);
            let mut t = 0;
            while t + L::N <= len {
                self.some::<L>(first + t, L::N);
                t += L::N;
            }
            if t < len && L::N > 1 {
                // Less than a vector; this lets the compiler know.
                self.some::<L>(first + t, (len - t).min(L::N - 1));
            }
        }
    }
}

impl Predict<'_> {
    #[inline(always)]
    fn some<L: Lanes>(&self, at: usize, n: usize) {
        let c = &self.columns;
        let x = V3::<L>::load(c.x, at, n);
        x.store(c.previous, at, n);
        let mut v = V3::<L>::load(c.v, at, n) + V3::splat(self.gravity_step);
        if let Some((acceleration, dt)) = self.acceleration {
            v = v + V3::load(acceleration, at, n) * L::splat(dt);
        }
        let w = if n == L::N { L::load(c.w, at) } else { L::load_part(c.w, at, n) };
        // A skinned particle has no velocity of its own.
        let damping_factor = L::splat(self.damping_factor).select(L::splat(0.0).lt(w), L::splat(0.0));
        let v = v * damping_factor;
        v.store(c.v, at, n);
        (x + v * L::splat(self.dt)).store(c.x, at, n);
    }
}
