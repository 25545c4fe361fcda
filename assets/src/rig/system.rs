//! Normal equations of the fit's least squares.

use toile_base::numeric::linear;
use toile_base::numeric::linear::Pivot;

use super::plan::{MIDDLE, PAIRS};

/// Centre and radius of each sphere that is not a mirror image.
pub(super) const UNKNOWNS: usize = 4 * (PAIRS + MIDDLE);
pub(super) type SphereVector = [f64; UNKNOWNS];

/// One residual's gradient: the first unknown of each of the two spheres, and the slopes of its four. Both may be the
/// same one, where a capsule joins a sphere to its own mirror image.
#[derive(Default)]
pub(super) struct SphereGradient(pub [(usize, [f64; 4]); 2]);

/// The equations: matrix times step = right.
pub(super) struct NormalEquations {
    matrix: Box<[SphereVector]>,
    right: SphereVector,
}

impl Default for NormalEquations {
    fn default() -> Self {
        Self { matrix: vec![[0.0; UNKNOWNS]; UNKNOWNS].into(), right: [0.0; UNKNOWNS] }
    }
}

impl NormalEquations {
    /// Adds a residual.
    pub(super) fn add(&mut self, row: &SphereGradient, residual: f64, weight: f64) {
        for (first, slopes) in &row.0 {
            for (i, a) in slopes.iter().enumerate() {
                self.right[first + i] -= weight * a * residual;
                for (second, others) in &row.0 {
                    for (j, b) in others.iter().enumerate() {
                        self.matrix[first + i][second + j] += weight * a * b;
                    }
                }
            }
        }
    }

    /// Adds a spring on one unknown, `away` from its rest.
    pub(super) fn hold(&mut self, unknown: usize, stiffness: f64, away: f64) {
        self.matrix[unknown][unknown] += stiffness;
        self.right[unknown] -= stiffness * away;
    }

    /// The damped step, by Cholesky; `None` where the matrix is not positive definite.
    pub(super) fn solve(&self, damping: f64) -> Option<SphereVector> {
        let mut lower = self.matrix.clone();
        let mut x = self.right;
        lower.iter_mut().enumerate().for_each(|(i, row)| row[i] += damping * row[i] + 1e-9);
        linear::factor(&mut lower, Pivot::Positive)?;
        linear::solve(&lower, &mut x);
        Some(x)
    }
}
