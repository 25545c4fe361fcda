//! Bending: a force, linear in the positions, so that nothing can go wrong where cloth is folded flat.
//!
//! Each stencil stores (1/2) |d|^2 with d = sum c_i x_i, the curvature along its fiber times the root of its stiffness
//! (assets, `bake::links`); it pulls with -c_i d. Evaluated at the positions of the substep's start, so statics do not
//! depend on the time step; stable while dt^2 w_i sum_s |c_si| sum_j |c_sj| stays below 4 for every particle
//! (Gershgorin). [`prepare`] weakens what is stiffer than a mesh and a substep can carry, and says by how much.

use toile_assets::garment::layout::{Bends, Set};

use super::state::Columns;
use crate::lanes::{Column, Kernel, Lanes, MOST, V3};

/// The bound on dt^2 omega^2 that is used, half of what is stable: motion near the limit rings.
const STABLE: f32 = 2.0;

/// Writes for each stencil the share of its stiffness that can be carried, 1 where all of it; the least share is
/// returned. `load` is room for a number a particle.
pub fn prepare(bends: &Bends, weights: &[f32], dt: f32, load: &mut [f32], scale: &mut [f32]) -> f32 {
    load.fill(0.0);
    let all = bends.tuples.all();
    let coefficient = |at: usize, k: usize| bends.coefficients[k][at];
    for (at, v) in all.iter().enumerate() {
        let sum: f32 = (0..3).map(|k| coefficient(at, k).abs()).sum();
        for (k, &i) in v.iter().enumerate() {
            load[i as usize] += dt * dt * weights[i as usize] * coefficient(at, k).abs() * sum;
        }
    }
    let mut least = 1.0f32;
    for (at, v) in all.iter().enumerate() {
        let most = v.iter().map(|&i| load[i as usize]).fold(0.0, f32::max);
        scale[at] = if most > STABLE { STABLE / most } else { 1.0 };
        least = least.min(scale[at]);
    }
    least
}

/// Adds the bending forces of one owner's share of a set to the velocities.
pub struct Bend<'a> {
    /// The garment's particles.
    pub columns: Columns<'a>,
    /// All stencils.
    pub bends: &'a Bends,
    /// The set.
    pub set: &'a Set,
    /// Whose share.
    pub owner: usize,
    /// Length of the substep (s).
    pub dt: f32,
    /// What [`prepare`] made, where anything had to be weakened.
    pub scale: Option<&'a [f32]>,
}

impl Kernel for Bend<'_> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self) {
        let share = &self.set.shares[self.owner];
        let tuples = &self.bends.tuples;
        for run in &tuples.runs[share.runs.start as usize..share.runs.end as usize] {
            let (at, len) = (run.at as usize, run.len as usize);
            // Stencils side by side overlap. Each block of MOST of them adds to all its middles first, then to all its
            // first ends, then to its second ones: the same order of sums at every width.
            let mut t = 0;
            while t < len {
                self.block::<L>(run.first.map(|f| f as usize + t), at + t, (len - t).min(MOST));
                t += MOST;
            }
        }
        for (k, i) in share.loose.clone().enumerate() {
            self.block::<f32>(tuples.loose[i as usize].map(|v| v as usize), share.loose_at as usize + k, 1);
        }
    }
}

impl Bend<'_> {
    #[inline(always)]
    fn block<L: Lanes>(&self, first: [usize; 3], at: usize, n: usize) {
        let c = &self.columns;
        let zero = V3::<L>::splat(glam::Vec3A::ZERO);
        let mut d = [zero; MOST];
        let steps = n.div_ceil(L::N);
        let part = |step: usize| (n - step * L::N).min(L::N);
        for (step, d) in d.iter_mut().enumerate().take(steps) {
            let (o, n) = (step * L::N, part(step));
            for (k, &v) in first.iter().enumerate() {
                *d = *d + V3::<L>::load(c.x, v + o, n) * self.coefficient::<L>(k, at + o, n);
            }
            if let Some(scale) = self.scale {
                *d = *d * load(Column::read_only(scale), at + o, n);
            }
            *d = *d * L::splat(self.dt);
        }
        for (k, &v) in first.iter().enumerate() {
            for (step, &d) in d.iter().enumerate().take(steps) {
                let (o, n) = (step * L::N, part(step));
                let share = self.coefficient::<L>(k, at + o, n) * load(c.w, v + o, n);
                (V3::<L>::load(c.v, v + o, n) - d * share).store(c.v, v + o, n);
            }
        }
    }

    #[inline(always)]
    fn coefficient<L: Lanes>(&self, k: usize, at: usize, n: usize) -> L {
        load(Column::read_only(&self.bends.coefficients[k]), at, n)
    }
}

#[inline(always)]
fn load<L: Lanes>(from: Column<'_>, at: usize, n: usize) -> L {
    if n == L::N { L::load(from, at) } else { L::load_part(from, at, n) }
}
