//! Settle: velocities from where the particles came to lie.

use crate::cloth::state::ParticleColumns;
use crate::lanes::{Kernel, Lanes, Mask, V3, reciprocal_root};

/// v = (x - previous) / dt over one owner's particles, in a form that keeps the bits of free flight, limited to the settings' speed. A particle over the limit is
/// also put back to where that speed would have brought it, so that position and velocity agree. Gives how many were.
pub struct Settle<'a> {
    /// The garment's particles.
    pub columns: ParticleColumns<'a>,
    /// Ranges of particles, `(first, len)`.
    pub spans: &'a [(u32, u32)],
    /// Speed limit (m/s).
    pub max_speed: f32,
    /// Length of the substep (s).
    pub dt: f32,
}

impl Kernel for Settle<'_> {
    type Out = u32;

    #[inline(always)]
    fn run<L: Lanes>(mut self) -> u32 {
        self.columns = self.columns.level();
        let mut held = 0;
        for &(first, len) in self.spans {
            let (first, len) = (first as usize, len as usize);
            let mut t = 0;
            while t + L::N <= len {
                held += self.some::<L>(first + t, L::N);
                t += L::N;
            }
            if t < len && L::N > 1 {
                // Less than a vector; this lets the compiler know.
                held += self.some::<L>(first + t, (len - t).min(L::N - 1));
            }
        }
        held
    }
}

impl Settle<'_> {
    #[inline(always)]
    fn some<L: Lanes>(&self, at: usize, n: usize) -> u32 {
        let c = &self.columns;
        let previous = V3::<L>::load(c.previous, at, n);
        let x = V3::<L>::load(c.x, at, n);
        let foreseen = V3::<L>::load(c.v, at, n);
        let moved = x - previous;
        let distance2 = moved.dot(moved);
        let farthest = L::splat(self.max_speed * self.dt);
        let w = if n == L::N { L::load(c.w, at) } else { L::load_part(c.w, at, n) };
        let over = (farthest * farthest).lt(distance2).and(L::splat(0.0).lt(w));
        let per_dt = L::splat(self.dt.recip());
        // What the constraints changed, added to the velocity that was foreseen: where they changed nothing, nothing is
        // lost to the rounding of positions, which in short substeps is a few per cent of gravity.
        let mut v = foreseen + (x - (previous + foreseen * L::splat(self.dt))) * per_dt;
        if over.any() {
            let held = moved * (farthest * reciprocal_root(distance2)).select(over, L::splat(1.0));
            (previous + held).select(over, x).store(c.x, at, n);
            v = (held * per_dt).select(over, v);
        }
        v.store(c.v, at, n);
        over.bits().count_ones()
    }
}
