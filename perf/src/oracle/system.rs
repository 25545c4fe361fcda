//! The linear system of a Newton step: a sparse symmetric matrix of 3 x 3 blocks, factored as L L^T.
//!
//! The pattern depends on links and stencils only, because solids meet one particle at a time: it is ordered and
//! analysed once. Blocks off the diagonal are symmetric themselves (a spring's is along or across its link, a stencil's
//! a multiple of the identity), so that it does not matter which of two particles comes first.

use glam::{DMat3, DVec3};

use super::cholesky::{Analysis, Factor};
use super::problem::Problem;

/// In place of a row: the particle is pinned.
const PINNED: u32 = u32::MAX;

/// The matrix, its pattern and what is known of its factors.
#[derive(Debug)]
pub struct System {
    /// Place of each particle among the free ones.
    place: Vec<u32>,
    /// Where the blocks below the diagonal of each column begin in `rows`.
    starts: Vec<usize>,
    rows: Vec<u32>,
    diagonal: Vec<DMat3>,
    blocks: Vec<DMat3>,
    analysis: Analysis,
    factor: Option<Factor>,
    /// Factorisations so far, those that failed among them.
    pub factored: usize,
}

impl System {
    /// Analyses the pattern.
    pub fn new(problem: &Problem) -> Self {
        let mut place = vec![PINNED; problem.particles()];
        let free = (0..problem.particles()).filter(|&i| !problem.pinned(i));
        free.enumerate().for_each(|(k, i)| place[i] = k as u32);
        let count = place.iter().filter(|p| **p != PINNED).count();
        let pairs = pairs(problem, &place);
        let (starts, rows) = below(&pairs, count);
        let (diagonal, blocks) = (vec![DMat3::ZERO; count], vec![DMat3::ZERO; rows.len()]);
        Self {
            place,
            starts,
            rows,
            diagonal,
            blocks,
            analysis: Analysis::new(count, &pairs),
            factor: None,
            factored: 0,
        }
    }

    /// Makes every number 0.
    pub fn clear(&mut self) {
        self.diagonal.fill(DMat3::ZERO);
        self.blocks.fill(DMat3::ZERO);
    }

    /// Adds a symmetric block to a particle's own.
    pub fn add(&mut self, i: usize, block: &DMat3) {
        if self.place[i] != PINNED {
            self.diagonal[self.place[i] as usize] += *block;
        }
    }

    /// Adds a symmetric block between two particles; nothing where one is pinned.
    pub fn add_pair(&mut self, i: usize, j: usize, block: &DMat3) {
        let (p, q) = (self.place[i].max(self.place[j]), self.place[i].min(self.place[j]));
        if p == PINNED {
            return;
        }
        let range = self.starts[q as usize]..self.starts[q as usize + 1];
        // Every pair is one of those that the pattern was made of.
        if let Ok(k) = self.rows[range.clone()].binary_search(&p) {
            self.blocks[range.start + k] += *block;
        }
    }

    /// Each block below the diagonal with its row and column.
    fn placed(&self) -> impl Iterator<Item = ([u32; 2], DMat3)> {
        let columns = self.starts.windows(2).zip(0..).flat_map(|(w, column)| (w[0]..w[1]).map(move |at| (at, column)));
        columns.map(|(at, column)| ([self.rows[at], column], self.blocks[at]))
    }

    /// Factors the matrix; false where it is not positive definite.
    pub fn factor(&mut self) -> bool {
        self.factored += 1;
        self.factor = self.analysis.factor(&self.diagonal, self.placed());
        self.factor.is_some()
    }

    /// Solves `A d = -g` with the last factors; nothing where there are none or the step is not finite. Rows of pinned
    /// particles are left 0.
    pub fn solve(&self, gradient: &[DVec3]) -> Option<Vec<DVec3>> {
        let factor = self.factor.as_ref()?;
        let mut side = self.free(gradient);
        side.iter_mut().for_each(|g| *g = -*g);
        self.analysis.solve(factor, &mut side);
        let step = self.all(&side);
        step.iter().all(|d| d.is_finite()).then_some(step)
    }

    /// The vectors of the free particles.
    fn free(&self, all: &[DVec3]) -> Vec<DVec3> {
        self.place.iter().zip(all).filter(|(p, _)| **p != PINNED).map(|(_, v)| *v).collect()
    }

    /// The vectors of all particles, 0 for those that are pinned.
    fn all(&self, free: &[DVec3]) -> Vec<DVec3> {
        self.place.iter().map(|p| free.get(*p as usize).copied().unwrap_or_default()).collect()
    }

    /// The matrix times a vector `[particles]`, for tests: what was added, not what was factored.
    #[cfg(test)]
    pub fn times(&self, x: &[DVec3]) -> Vec<DVec3> {
        let from = self.free(x);
        let mut out: Vec<DVec3> = self.diagonal.iter().zip(&from).map(|(d, x)| *d * *x).collect();
        for ([row, column], block) in self.placed() {
            let (row, column) = (row as usize, column as usize);
            out[row] += block * from[column];
            out[column] += block.transpose() * from[row];
        }
        self.all(&out)
    }
}

/// Every pair of free particles that a link or a stencil joins, larger place second, in order.
fn pairs(problem: &Problem, place: &[u32]) -> Vec<[u32; 2]> {
    let mut all = Vec::new();
    let mut join = |a: u32, b: u32| {
        let (p, q) = (place[a as usize], place[b as usize]);
        if p != q && p != PINNED && q != PINNED {
            all.push([p.min(q), p.max(q)]);
        }
    };
    problem.links.iter().for_each(|l| join(l.ends[0], l.ends[1]));
    for bend in &problem.bends {
        for (k, &a) in bend.particles.iter().enumerate() {
            bend.particles[..k].iter().for_each(|&b| join(a, b));
        }
    }
    all.sort_unstable();
    all.dedup();
    all
}

/// The blocks below the diagonal, column after column.
fn below(pairs: &[[u32; 2]], count: usize) -> (Vec<usize>, Vec<u32>) {
    let mut starts = vec![0; count + 1];
    pairs.iter().for_each(|[column, _]| starts[*column as usize + 1] += 1);
    (0..count).for_each(|c| starts[c + 1] += starts[c]);
    (starts, pairs.iter().map(|[_, row]| *row).collect())
}
