//! Bending: a force, the product of the garment's [`BendingMatrix`] and what is bent.
//!
//! Evaluated at the positions of the substep's start, so statics do not depend on the time step; stable while
//! dt^2 w_i sum_s |c_si| sum_j |c_sj| over all stencils s stays below 4 for every particle (Gershgorin). What is stiffer than
//! a mesh and a substep can carry so takes several [`super::stiff_bending`]; what is stiffer still is weakened
//! ([`BendingMatrix::fill`]), which says by how much.

use toile_base::garment::layout::Layout;

use super::bending_matrix::{BendingMatrix, RowBlock, RowStrip};
use crate::lanes::{Kernel, Lanes, MOST, ReadColumn, Readable, V3, WriteColumn};

/// The bound on dt^2 omega^2 up to which bending is a plain force, a fifth of what is stable: what is stiffer rings, and
/// the stretch solves of cloth that is pressed in its plane feed the ringing.
pub const STABLE: f32 = 0.8;

/// How bending goes on for one time step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BendingPace {
    /// It acts every so many substeps, with the impulse of all of them (Tuckerman, Berne, Martyna 1992: slow forces need
    /// not be asked as often as fast ones).
    pub every: u32,
    /// Stages of each time ([`super::stiff_bending`]); 1 where it is a plain force.
    pub stages: u32,
    /// Least share of its stiffness that the time step can carry.
    pub least: f32,
    /// Friction in it acts every so many substeps.
    pub friction_every: u32,
    /// Least stiffness of what sticks by friction, over the elastic one (1).
    pub sticking: f32,
}

/// Adds to each particle the bound on dt^2 omega^2 that bending puts on it.
pub fn add_load(layout: &Layout, weights: &[f32], dt: f32, load: &mut [f32]) {
    layout.for_each_bend(|particles, coefficient| {
        let sum: f32 = (0..particles.len()).map(|k| coefficient(k).abs()).sum();
        for (k, &i) in particles.iter().enumerate() {
            load[i as usize] += dt * dt * weights[i as usize] * coefficient(k).abs() * sum;
        }
    });
}

/// How often bending has to act.
pub fn every(load: &[f32], substeps: u32) -> u32 {
    let most = load.iter().copied().fold(0.0, f32::max);
    let fits = |every: &u32| substeps.is_multiple_of(*every) && most * (every * every) as f32 <= STABLE;
    (1..=substeps).rev().find(fits).unwrap_or(1)
}

/// Adds the bending forces on one owner's particles to the velocities, or whatever is bent to whatever is pushed.
pub struct Bend<'a> {
    /// The garment's matrix.
    pub matrix: &'a BendingMatrix,
    /// Owner whose rows they are.
    pub owner: usize,
    /// What is bent: the positions (m).
    pub from: [WriteColumn<'a>; 3],
    /// The same as records, where [`BendingMatrix::reads_records`].
    pub records: WriteColumn<'a>,
    /// What is pushed: the velocities (m/s).
    pub to: [WriteColumn<'a>; 3],
    /// How much: the length of the substep (s).
    pub by: f32,
}

impl Kernel for Bend<'_> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(mut self) {
        let len = self.from[0].len();
        for axis in 0..3 {
            (self.from[axis], self.to[axis]) = (self.from[axis].cut(len), self.to[axis].cut(len));
        }
        let strips = &self.matrix.owned_strips[self.owner];
        for strip in &self.matrix.strips[strips.start as usize..strips.end as usize] {
            if strip.alike { self.strip::<L, true>(strip) } else { self.strip::<L, false>(strip) }
        }
        for block in self.matrix.owned_blocks[self.owner].clone() {
            self.block::<L>(block as usize, &self.matrix.blocks[block as usize]);
        }
    }
}

impl Bend<'_> {
    /// Rows whose neighbours lie side by side.
    #[inline(always)]
    fn strip<L: Lanes, const ALIKE: bool>(&self, strip: &RowStrip) {
        let offsets = &self.matrix.offsets[strip.offsets as usize..][..strip.entries as usize];
        let values = ReadColumn::new(&self.matrix.values);
        let (first, len) = (strip.first as usize, strip.len as usize);
        let mut t = 0;
        while t < len {
            let n = (len - t).min(L::N);
            let own = V3::<L>::load(self.from, first + t, n);
            let mut sum = V3::<L>::splat(glam::Vec3A::ZERO);
            for (k, &offset) in offsets.iter().enumerate() {
                let at = (first + t).wrapping_add_signed(offset as isize);
                let d = V3::<L>::load(self.from, at, n) - own;
                let value = if ALIKE {
                    L::splat(values.get(strip.values as usize + k))
                } else {
                    some(values, strip.values as usize + k * len + t, n)
                };
                sum = sum + d * value;
            }
            let to = V3::<L>::load(self.to, first + t, n);
            (to + sum * L::splat(self.by)).store(self.to, first + t, n);
            t += n;
        }
    }

    /// Rows in no order.
    #[inline(always)]
    fn block<L: Lanes>(&self, number: usize, block: &RowBlock) {
        let matrix = self.matrix;
        let (rows, neighbours) = (matrix.rows.within(self.records), matrix.neighbours.within(self.records));
        let values = ReadColumn::new(&matrix.values);
        let mut lane = 0;
        while lane < block.len as usize {
            let [x, y, z, _] = L::load_records(rows, number * MOST + lane);
            let own = V3 { x, y, z };
            let mut sum = V3::<L>::splat(glam::Vec3A::ZERO);
            for k in 0..block.entries as usize {
                let [x, y, z, _] = L::load_records(neighbours, block.neighbours as usize + k * MOST + lane);
                let value = L::load(values, block.values as usize + k * MOST + lane);
                sum = sum + (V3 { x, y, z } - own) * value;
            }
            let (push, n) = (sum * L::splat(self.by), (block.len as usize - lane).min(L::N));
            if block.sequence {
                let i = matrix.rows.record(number * MOST + lane) as usize;
                (V3::<L>::load(self.to, i, n) + push).store(self.to, i, n);
            } else {
                self.scatter(push, number * MOST + lane, n);
            }
            lane += L::N;
        }
    }
}

impl Bend<'_> {
    /// Pushes `n` rows from the `k`th of the blocks on.
    #[inline(always)]
    fn scatter<L: Lanes>(&self, push: V3<L>, k: usize, n: usize) {
        let pushes = [push.x, push.y, push.z].map(L::to_array);
        for t in 0..n {
            let i = self.matrix.rows.record(k + t) as usize;
            for (to, push) in self.to.iter().zip(&pushes) {
                to.set(i, to.get(i) + push[t]);
            }
        }
    }
}

/// `n <= N` numbers side by side.
#[inline(always)]
fn some<L: Lanes>(from: impl Readable, at: usize, n: usize) -> L {
    if n == L::N { L::load(from, at) } else { L::load_part(from, at, n) }
}

#[cfg(test)]
mod tests;
