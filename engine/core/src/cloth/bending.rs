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

/// How bending goes on for one time step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pace {
    /// It acts every so many substeps, with the impulse of all of them (Tuckerman, Berne, Martyna 1992: slow forces need
    /// not be asked as often as fast ones).
    pub every: u32,
    /// Least share of its stiffness that the time step can carry.
    pub least: f32,
}

/// Writes for each stencil the share of its stiffness that can be carried, 1 where all of it. `load` is room for a
/// number a particle.
pub fn prepare(
    bends: &Bends,
    weights: &[f32],
    [dt, substeps]: [f32; 2],
    load: &mut [f32],
    scale: &mut [f32],
) -> Pace {
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
    let most = load.iter().copied().fold(0.0, f32::max);
    let substeps = substeps as u32;
    let fits = |every: u32| substeps % every == 0 && most * (every * every) as f32 <= STABLE;
    Pace { every: (1..=substeps).rev().find(|&e| fits(e)).unwrap_or(1), least }
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
        if L::N == MOST && n == MOST {
            let d = self.curvature::<L>(first, at, MOST);
            for (k, v) in first.into_iter().enumerate() {
                self.push(k, d, v, at, MOST);
            }
            return;
        }
        if L::N == MOST {
            let n = n.min(MOST - 1);
            let d = self.curvature::<L>(first, at, n);
            for (k, v) in first.into_iter().enumerate() {
                self.push(k, d, v, at, n);
            }
            return;
        }
        let mut d = [V3::<L>::splat(glam::Vec3A::ZERO); MOST];
        let steps = n.div_ceil(L::N);
        let part = |step: usize| (n - step * L::N).min(L::N);
        for (step, d) in d.iter_mut().enumerate().take(steps) {
            let o = step * L::N;
            *d = self.curvature::<L>(first.map(|v| v + o), at + o, part(step));
        }
        for (k, &v) in first.iter().enumerate() {
            for (step, &d) in d.iter().enumerate().take(steps) {
                let o = step * L::N;
                self.push(k, d, v + o, at + o, part(step));
            }
        }
    }

    /// `n` stencils: the curvature, times the substep.
    #[inline(always)]
    fn curvature<L: Lanes>(&self, first: [usize; 3], at: usize, n: usize) -> V3<L> {
        let x = self.columns.x;
        let mut d = V3::<L>::load(x, first[0], n) * self.coefficient::<L>(0, at, n);
        d = d + V3::load(x, first[1], n) * self.coefficient::<L>(1, at, n);
        d = d + V3::load(x, first[2], n) * self.coefficient::<L>(2, at, n);
        if let Some(scale) = self.scale {
            d = d * load(Column::read_only(scale), at, n);
        }
        d * L::splat(self.dt)
    }

    /// What `n` stencils do to their particles of one kind.
    #[inline(always)]
    fn push<L: Lanes>(&self, k: usize, d: V3<L>, v: usize, at: usize, n: usize) {
        let c = &self.columns;
        let share = self.coefficient::<L>(k, at, n) * load(c.w, v, n);
        (V3::<L>::load(c.v, v, n) - d * share).store(c.v, v, n);
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
