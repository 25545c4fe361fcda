//! Symmetric sparse systems of 3 x 3 blocks, solved by conjugate gradients.
//!
//! The blocks of a row stand side by side, by column; a term of the energy keeps the places of its blocks, so that summing costs no
//! search. Preconditioned by the inverse of the blocks on the diagonal (Barrett et al. 1994, "Templates", sections 2.3.1 and 3.2.1).

use std::collections::BTreeSet;

use glam::{DMat3, DVec3};

/// Pivot, as a part of the trace, below which a diagonal block is taken to be singular.
const SINGULAR: f64 = 1e-9;

/// A symmetric matrix of 3 x 3 blocks, each stored, with its right hand side.
#[derive(Debug, Clone)]
pub struct BlockSystem {
    starts: Vec<usize>,
    columns: Vec<u32>,
    diagonal: Vec<usize>,
    /// Values `[blocks]`.
    pub blocks: Vec<DMat3>,
    /// The right hand side `[rows]`.
    pub right: Vec<DVec3>,
}

/// What solving took.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SolveOutcome {
    /// Steps of the conjugate gradients.
    pub steps: usize,
    /// Length of the residual that is left, as a part of the right hand side's.
    pub left: f64,
}

impl BlockSystem {
    /// A system of so many rows, in which the vertices of each group meet each other.
    pub fn new<'a>(rows: usize, groups: impl Iterator<Item = &'a [u32]>) -> Self {
        let mut met: Vec<BTreeSet<u32>> = (0..rows as u32).map(|i| BTreeSet::from([i])).collect();
        for group in groups {
            for &i in group {
                met[i as usize].extend(group);
            }
        }
        let mut starts = vec![0];
        let (mut columns, mut diagonal) = (Vec::new(), Vec::new());
        for (i, row) in met.iter().enumerate() {
            diagonal.push(columns.len() + row.range(..i as u32).count());
            columns.extend(row);
            starts.push(columns.len());
        }
        let blocks = vec![DMat3::ZERO; columns.len()];
        Self { starts, columns, diagonal, blocks, right: vec![DVec3::ZERO; rows] }
    }

    /// Where the block of a row and a column stands.
    ///
    /// # Panics
    /// Where the two never met in a group.
    pub fn place(&self, row: u32, column: u32) -> usize {
        let (from, to) = (self.starts[row as usize], self.starts[row as usize + 1]);
        from + self.columns[from..to].binary_search(&column).expect("the vertices meet in a group")
    }

    /// Sets all values to 0.
    pub fn clear(&mut self) {
        self.blocks.fill(DMat3::ZERO);
        self.right.fill(DVec3::ZERO);
    }

    /// The matrix times a vector.
    pub fn multiply(&self, x: &[DVec3], out: &mut [DVec3]) {
        for (i, out) in out.iter_mut().enumerate() {
            let (from, to) = (self.starts[i], self.starts[i + 1]);
            let mut sum = DVec3::ZERO;
            for (block, column) in self.blocks[from..to].iter().zip(&self.columns[from..to]) {
                sum += *block * x[*column as usize];
            }
            *out = sum;
        }
    }

    /// Solves for `x`, from 0, until the residual is below `tolerance` of the right hand side.
    pub fn solve(&self, x: &mut Vec<DVec3>, tolerance: f64, most: usize) -> SolveOutcome {
        let n = self.right.len();
        x.clear();
        x.resize(n, DVec3::ZERO);
        let inverse: Vec<DMat3> = self.diagonal.iter().map(|d| inverse(&self.blocks[*d])).collect();
        let mut r = self.right.clone();
        let mut z: Vec<DVec3> = r.iter().zip(&inverse).map(|(r, m)| *m * *r).collect();
        let mut p = z.clone();
        let mut q = vec![DVec3::ZERO; n];
        let mut rz = dot(&r, &z);
        let (first, mut outcome) = (dot(&r, &r).sqrt(), SolveOutcome::default());
        while outcome.steps < most && rz > 0.0 {
            self.multiply(&p, &mut q);
            let pq = dot(&p, &q);
            if pq <= 0.0 || pq.is_nan() {
                break;
            }
            let alpha = rz / pq;
            for i in 0..n {
                x[i] += alpha * p[i];
                r[i] -= alpha * q[i];
                z[i] = inverse[i] * r[i];
            }
            outcome.steps += 1;
            outcome.left = dot(&r, &r).sqrt() / first;
            if outcome.left < tolerance {
                break;
            }
            let next = dot(&r, &z);
            let beta = next / rz;
            rz = next;
            for i in 0..n {
                p[i] = z[i] + beta * p[i];
            }
        }
        outcome
    }
}

fn dot(a: &[DVec3], b: &[DVec3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a.dot(*b)).sum()
}

/// The inverse of a diagonal block; of a singular one, that of its trace alone.
fn inverse(block: &DMat3) -> DMat3 {
    let trace = block.x_axis.x + block.y_axis.y + block.z_axis.z;
    if trace <= 0.0 {
        return DMat3::IDENTITY;
    }
    if block.determinant() > SINGULAR * trace.powi(3) {
        block.inverse()
    } else {
        DMat3::from_diagonal(DVec3::splat(3.0 / trace))
    }
}

#[cfg(test)]
mod tests {
    use toile_base::numeric::random::SplitMix64;

    use super::*;

    #[test]
    fn a_solved_system_gives_its_right_hand_side_again() {
        let groups: Vec<[u32; 3]> = (0..18).map(|i| [i, i + 1, (i * 7 + 3) % 20]).collect();
        let mut system = BlockSystem::new(20, groups.iter().map(|g| &g[..]));
        let mut random = SplitMix64::new(5);
        let mut vector = || DVec3::from_array(std::array::from_fn(|_| random.uniform_f64() - 0.5));
        for g in &groups {
            let j: [DMat3; 3] = std::array::from_fn(|_| DMat3::from_cols(vector(), vector(), vector()));
            for a in 0..3 {
                for b in 0..3 {
                    let at = system.place(g[a], g[b]);
                    system.blocks[at] += j[a].transpose() * j[b];
                }
            }
        }
        for i in 0..20 {
            let at = system.place(i, i);
            system.blocks[at] += DMat3::IDENTITY * 0.05;
            system.right[i as usize] = vector();
        }
        let mut x = Vec::new();
        let outcome = system.solve(&mut x, 1e-10, 400);
        let mut back = vec![DVec3::ZERO; 20];
        system.multiply(&x, &mut back);
        for (a, b) in back.iter().zip(&system.right) {
            assert!(a.distance(*b) < 1e-8, "{a} {b} after {} steps", outcome.steps);
        }
    }
}
