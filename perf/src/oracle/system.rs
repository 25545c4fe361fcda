//! The linear system of a Newton step: a sparse symmetric matrix of 3 x 3 blocks, factored as L L^T by faer.
//!
//! The pattern depends on links and stencils only, because solids meet one particle at a time: it is ordered and
//! analysed once. Blocks off the diagonal are symmetric themselves (a spring's is along or across its link, a stencil's
//! a multiple of the identity), so that it does not matter which of two particles comes first.

use faer::Side;
use faer::linalg::solvers::SolveCore;
use faer::sparse::linalg::solvers::{Llt, SymbolicLlt};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMat};
use faer::{Conj, MatMut};
use glam::{DMat3, DVec3};

use super::OracleError;
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
    pattern: SymbolicSparseColMat<usize>,
    values: Vec<f64>,
    analysis: SymbolicLlt<usize>,
    factors: Option<Llt<usize, f64>>,
    /// Factorisations so far, those that failed among them.
    pub factored: usize,
}

impl System {
    /// Analyses the pattern. Fails for want of memory only, or where nothing is free.
    pub fn new(problem: &Problem) -> Result<Self, OracleError> {
        let mut place = vec![PINNED; problem.particles()];
        let free = (0..problem.particles()).filter(|&i| !problem.pinned(i));
        free.enumerate().for_each(|(k, i)| place[i] = k as u32);
        let count = place.iter().filter(|p| **p != PINNED).count();
        let (starts, rows) = below(&pairs(problem, &place), count);
        let (columns, indices) = scalar(&starts, &rows);
        let n = 3 * count;
        let pattern = SymbolicSparseColMat::new_checked(n, n, columns, None, indices);
        let analysis =
            SymbolicLlt::try_new(pattern.as_ref(), Side::Lower).map_err(|_| OracleError::Memory { unknowns: n })?;
        let values = vec![0.0; pattern.row_idx().len()];
        Ok(Self { place, starts, rows, pattern, values, analysis, factors: None, factored: 0 })
    }

    /// Makes every number 0.
    pub fn clear(&mut self) {
        self.values.fill(0.0);
    }

    /// Adds a symmetric block to a particle's own.
    pub fn add(&mut self, i: usize, block: &DMat3) {
        let at = self.place[i] as usize;
        if self.place[i] == PINNED {
            return;
        }
        for c in 0..3 {
            let first = self.pattern.col_ptr()[3 * at + c];
            for r in c..3 {
                self.values[first + r - c] += block.col(c)[r];
            }
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
        let Ok(k) = self.rows[range].binary_search(&p) else { return };
        for c in 0..3 {
            let first = self.pattern.col_ptr()[3 * q as usize + c] + (3 - c) + 3 * k;
            for r in 0..3 {
                self.values[first + r] += block.col(c)[r];
            }
        }
    }

    /// Factors the matrix; false where it is not positive definite.
    pub fn factor(&mut self) -> bool {
        self.factored += 1;
        let matrix = SparseColMatRef::new(self.pattern.as_ref(), &self.values);
        self.factors = Llt::try_new_with_symbolic(self.analysis.clone(), matrix, Side::Lower).ok();
        self.factors.is_some()
    }

    /// Solves `A d = -g` with the last factors; nothing where there are none or the step is not finite. Rows of pinned
    /// particles are left 0.
    pub fn solve(&self, gradient: &[DVec3]) -> Option<Vec<DVec3>> {
        let factors = self.factors.as_ref()?;
        let mut side = vec![0.0; self.pattern.ncols()];
        for (p, g) in self.place.iter().zip(gradient).filter(|(p, _)| **p != PINNED) {
            side[3 * *p as usize..][..3].copy_from_slice(&(-*g).to_array());
        }
        let n = side.len();
        factors.solve_in_place_with_conj(Conj::No, MatMut::from_column_major_slice_mut(&mut side, n, 1));
        let of = |p: &u32| if *p == PINNED { DVec3::ZERO } else { DVec3::from_slice(&side[3 * *p as usize..]) };
        let step: Vec<DVec3> = self.place.iter().map(of).collect();
        step.iter().all(|d| d.is_finite()).then_some(step)
    }

    /// The matrix times a vector `[particles]`, for tests: what was added, not what was factored.
    #[cfg(test)]
    pub fn times(&self, x: &[DVec3]) -> Vec<DVec3> {
        let mut flat = vec![0.0; self.pattern.ncols()];
        let mut from = flat.clone();
        for (p, v) in self.place.iter().zip(x).filter(|(p, _)| **p != PINNED) {
            from[3 * *p as usize..][..3].copy_from_slice(&v.to_array());
        }
        for c in 0..flat.len() {
            for at in self.pattern.col_ptr()[c]..self.pattern.col_ptr()[c + 1] {
                let (r, value) = (self.pattern.row_idx()[at], self.values[at]);
                flat[r] += value * from[c];
                if r != c {
                    flat[c] += value * from[r];
                }
            }
        }
        let of = |p: &u32| if *p == PINNED { DVec3::ZERO } else { DVec3::from_slice(&flat[3 * *p as usize..]) };
        self.place.iter().map(of).collect()
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

/// The same in numbers instead of blocks: where each column begins, and the rows.
fn scalar(starts: &[usize], rows: &[u32]) -> (Vec<usize>, Vec<usize>) {
    let (mut columns, mut indices) = (vec![0], Vec::new());
    for block in 0..starts.len() - 1 {
        for c in 0..3 {
            indices.extend(3 * block + c..3 * block + 3);
            let others = &rows[starts[block]..starts[block + 1]];
            indices.extend(others.iter().flat_map(|&r| 3 * r as usize..3 * r as usize + 3));
            columns.push(indices.len());
        }
    }
    (columns, indices)
}
