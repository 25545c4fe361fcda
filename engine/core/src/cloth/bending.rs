//! Bending: a force, linear in the positions, so that nothing can go wrong where cloth is folded flat.
//!
//! Each stencil stores (1/2) |d|^2 with d = sum c_i x_i, the curvature along its fiber times the root of its stiffness
//! (assets, `bake::links`); it pulls with -c_i d. Evaluated at the positions of the substep's start, so statics do not
//! depend on the time step; stable while dt^2 w_i sum_s |c_si| sum_j |c_sj| stays below 4 for every particle
//! (Gershgorin). [`weaken`] weakens what is stiffer than a mesh and a substep can carry, and says by how much.

use toile_assets::garment::layout::{Bends, Set};

use super::state::Columns;
use crate::lanes::{Column, Kernel, Lanes, MOST, V3};

/// The bound on dt^2 omega^2 that is used, half of what is stable: motion near the limit rings.
const STABLE: f32 = 2.0;

/// How bending goes on for one time step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pace {
    /// It acts every so many substeps, with the impulse of all of them (Tuckerman, Berne, Martyna 1992: slow forces need
    /// not be asked as often as fast ones).
    pub every: u32,
    /// Least share of its stiffness that the time step can carry.
    pub least: f32,
}

/// Adds to each particle the bound on dt^2 omega^2 that some stencils put on it.
pub fn add_load<const K: usize>(bends: &Bends<K>, weights: &[f32], dt: f32, load: &mut [f32]) {
    let coefficient = |at: usize, k: usize| bends.coefficients[k][at].abs();
    bends.tuples.for_each(|at, v| {
        let sum: f32 = (0..K).map(|k| coefficient(at, k)).sum();
        for (k, &i) in v.iter().enumerate() {
            load[i as usize] += dt * dt * weights[i as usize] * coefficient(at, k) * sum;
        }
    });
}

/// Writes for each stencil the share of its stiffness that can be carried, 1 where all of it; the least is given back.
pub fn weaken<const K: usize>(bends: &Bends<K>, load: &[f32], scale: &mut [f32]) -> f32 {
    let mut least = 1.0f32;
    scale.fill(1.0);
    bends.tuples.for_each(|at, v| {
        let most = v.iter().map(|&i| load[i as usize]).fold(0.0, f32::max);
        if most > STABLE {
            scale[at] = scale[at].min(STABLE / most);
            least = least.min(scale[at]);
        }
    });
    least
}

/// How often bending has to act.
pub fn every(load: &[f32], substeps: u32) -> u32 {
    let most = load.iter().copied().fold(0.0, f32::max);
    let fits = |every: &u32| substeps.is_multiple_of(*every) && most * (every * every) as f32 <= STABLE;
    (1..=substeps).rev().find(fits).unwrap_or(1)
}

/// Adds the bending forces of one owner's share of a set to the velocities.
pub struct Bend<'a, const K: usize> {
    /// The garment's particles.
    pub columns: Columns<'a>,
    /// All stencils.
    pub bends: &'a Bends<K>,
    /// The set.
    pub set: &'a Set,
    /// Whose share.
    pub owner: usize,
    /// Length of the substep (s).
    pub dt: f32,
    /// What [`weaken`] made, where anything had to be weakened.
    pub scale: Option<&'a [f32]>,
}

impl<const K: usize> Kernel for Bend<'_, K> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(mut self) {
        self.columns = self.columns.level();
        let share = &self.set.shares[self.owner];
        let tuples = &self.bends.tuples;
        for run in &tuples.runs[share.runs.start as usize..share.runs.end as usize] {
            let len = run.len as usize;
            // Stencils side by side overlap. Each block of MOST of them adds to all its middles first, then to all its
            // first ends, then to its second ones: the same order of sums at every width.
            let mut t = 0;
            while t < len {
                let first = run.first.map(|f| f as usize + t);
                let lead = run.alike.then_some(run.first.map(|f| f as usize));
                self.block::<L>(first, run.place(t as u32), lead, (len - t).min(MOST));
                t += MOST;
            }
        }
        for (k, i) in share.loose.clone().enumerate() {
            let first = tuples.loose[i as usize].map(|v| v as usize);
            self.block::<f32>(first, share.loose_at as usize + k, Some(first), 1);
        }
    }
}

impl<const K: usize> Bend<'_, K> {
    #[inline(always)]
    fn block<L: Lanes>(&self, first: [usize; K], at: usize, alike: Option<[usize; K]>, n: usize) {
        if L::N == MOST && n == MOST {
            let p = self.parameters::<L>(first, at, alike, MOST);
            let d = self.curvature::<L>(first, &p, MOST);
            for (k, v) in first.into_iter().enumerate() {
                self.push(&p, k, d, v, MOST);
            }
            return;
        }
        if L::N == MOST || n == 1 {
            let n = n.min(L::N).min(if L::N == MOST { MOST - 1 } else { L::N });
            let p = self.parameters::<L>(first, at, alike, n);
            let d = self.curvature::<L>(first, &p, n);
            for (k, v) in first.into_iter().enumerate() {
                self.push(&p, k, d, v, n);
            }
            return;
        }
        let mut d = [V3::<L>::splat(glam::Vec3A::ZERO); MOST];
        let steps = n.div_ceil(L::N);
        for (step, d) in d.iter_mut().enumerate().take(steps) {
            let (o, part) = (step * L::N, (n - step * L::N).min(L::N));
            let (first, at) = (first.map(|v| v + o), if alike.is_some() { at } else { at + o });
            let p = self.parameters::<L>(first, at, alike, part);
            *d = self.curvature::<L>(first, &p, part);
        }
        for (k, &v) in first.iter().enumerate() {
            for (step, &d) in d.iter().enumerate().take(steps) {
                let (o, part) = (step * L::N, (n - step * L::N).min(L::N));
                let place = if alike.is_some() { at } else { at + o };
                let p = self.parameters::<L>(first.map(|v| v + o), place, alike, part);
                self.push(&p, k, d, v + o, part);
            }
        }
    }

    /// Coefficients, and the weights of the three particles, of `n` stencils; `alike` is the first of the run where all
    /// of it are alike.
    #[inline(always)]
    fn parameters<L: Lanes>(
        &self,
        first: [usize; K],
        at: usize,
        alike: Option<[usize; K]>,
        n: usize,
    ) -> Parameters<L, K> {
        let coefficients = &self.bends.coefficients;
        let w = self.columns.w;
        // Plain loops: a closure is not always compiled for the kernel's lanes.
        let (mut c, mut weights) = ([L::splat(0.0); K], [L::splat(0.0); K]);
        let mut scale = L::splat(self.dt);
        if let Some(lead) = alike {
            for k in 0..K {
                c[k] = L::splat(coefficients[k][at]);
                weights[k] = L::splat(w.get(lead[k]));
            }
            if let Some(s) = self.scale {
                scale = scale * L::splat(s[at]);
            }
        } else {
            for k in 0..K {
                c[k] = load(Column::read_only(&coefficients[k]), at, n);
                weights[k] = load(w, first[k], n);
            }
            if let Some(s) = self.scale {
                scale = scale * load(Column::read_only(s), at, n);
            }
        }
        Parameters { c, w: weights, scale }
    }

    /// `n` stencils: the curvature, times the substep.
    #[inline(always)]
    fn curvature<L: Lanes>(&self, first: [usize; K], p: &Parameters<L, K>, n: usize) -> V3<L> {
        let x = self.columns.x;
        let mut d = V3::<L>::load(x, first[0], n) * p.c[0];
        for (&v, &c) in first.iter().zip(&p.c).skip(1) {
            d = d + V3::load(x, v, n) * c;
        }
        d * p.scale
    }

    /// What `n` stencils do to their particles of one kind.
    #[inline(always)]
    fn push<L: Lanes>(&self, p: &Parameters<L, K>, k: usize, d: V3<L>, v: usize, n: usize) {
        let c = &self.columns;
        (V3::<L>::load(c.v, v, n) - d * (p.c[k] * p.w[k])).store(c.v, v, n);
    }
}

/// What some stencils need besides positions.
struct Parameters<L, const K: usize> {
    c: [L; K],
    w: [L; K],
    scale: L,
}

#[inline(always)]
fn load<L: Lanes>(from: Column<'_>, at: usize, n: usize) -> L {
    if n == L::N { L::load(from, at) } else { L::load_part(from, at, n) }
}
