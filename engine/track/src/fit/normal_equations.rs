//! Normal equations of a least squares step: Jacobian rows summed, then solved by Cholesky factorisation.

use toile_assets::body::shape::SHAPES;
use toile_base::numeric::linear;
use toile_base::numeric::linear::Pivot;

use super::posed_body::{JacobianRow, POSE, UNKNOWNS, WIDTH};

/// `hessian` is J^T W J (Gauss-Newton, upper triangle), `gradient` J^T W r, `cost` the weighted sum of squares.
pub struct NormalEquations {
    hessian: Box<[JacobianRow; UNKNOWNS]>,
    gradient: JacobianRow,
    /// The weighted sum of squares of all residuals.
    pub cost: f64,
}

/// Half the cost around a state as a quadratic of the shape alone, the pose following it.
pub struct ShapeQuadratic {
    /// Second derivatives by the shape parameters.
    pub hessian: [[f64; SHAPES]; SHAPES],
    /// First derivatives at the state.
    pub gradient: [f64; SHAPES],
}

impl ShapeQuadratic {
    /// A shape that does not change.
    pub const KEPT: Self = {
        let mut hessian = [[0.0; SHAPES]; SHAPES];
        let mut i = 0;
        while i < SHAPES {
            hessian[i][i] = 1e12;
            i += 1;
        }
        Self { hessian, gradient: [0.0; SHAPES] }
    };
}

impl Default for NormalEquations {
    fn default() -> Self {
        Self::new()
    }
}

impl NormalEquations {
    /// Nothing summed yet.
    pub fn new() -> Self {
        Self { hessian: Box::new([[0.0; WIDTH]; UNKNOWNS]), gradient: [0.0; WIDTH], cost: 0.0 }
    }

    /// Forgets all residuals.
    pub fn clear(&mut self) {
        self.hessian.iter_mut().for_each(|row| row.fill(0.0));
        self.gradient.fill(0.0);
        self.cost = 0.0;
    }

    /// Adds a weighted residual with its Jacobian row.
    pub fn add(&mut self, row: &JacobianRow, residual: f32, weight: f32) {
        for i in 0..UNKNOWNS {
            let by = weight * row[i];
            if by != 0.0 {
                // Starts at the group of eight that holds the diagonal; entries below the diagonal are never read.
                let from = i & !7;
                for (c, r) in self.hessian[i][from..].iter_mut().zip(&row[from..]) {
                    *c += by * r;
                }
            }
        }
        let by = weight * residual;
        self.gradient.iter_mut().zip(row).for_each(|(s, r)| *s += by * r);
        self.cost += f64::from(by * residual);
    }

    /// Adds a weighted residual that depends on one unknown only, with derivative 1.
    pub fn add_one(&mut self, unknown: usize, residual: f32, weight: f32) {
        self.hessian[unknown][unknown] += weight;
        self.gradient[unknown] += weight * residual;
        self.cost += f64::from(weight * residual * residual);
    }

    fn at(&self, i: usize, j: usize) -> f64 {
        f64::from(self.hessian[i.min(j)][i.max(j)])
    }

    /// The Gauss-Newton step with a quadratic of the shape added; `damping` is a fraction of each diagonal
    /// (Levenberg-Marquardt).
    pub fn step(&self, shape: &ShapeQuadratic, damping: f64) -> [f64; UNKNOWNS] {
        let mut a = vec![[0.0; UNKNOWNS]; UNKNOWNS];
        let mut x = [0.0; UNKNOWNS];
        for i in 0..UNKNOWNS {
            for j in 0..=i {
                a[i][j] = self.at(i, j);
                if j >= POSE {
                    a[i][j] += shape.hessian[i - POSE][j - POSE];
                }
            }
            a[i][i] = a[i][i] * (1.0 + damping) + 1e-9;
            x[i] = -f64::from(self.gradient[i]) - if i >= POSE { shape.gradient[i - POSE] } else { 0.0 };
        }
        factored(&mut a);
        linear::solve(&a, &mut x);
        x
    }

    /// The pose eliminated (Schur complement): the frame's information about the shape alone.
    pub fn shape(&self) -> ShapeQuadratic {
        let mut a = vec![[0.0; UNKNOWNS]; UNKNOWNS];
        let mut gradient = [0.0; UNKNOWNS];
        for i in 0..UNKNOWNS {
            for j in 0..=i {
                a[i][j] = self.at(i, j);
            }
            a[i][i] += 1e-9;
            gradient[i] = f64::from(self.gradient[i]);
        }
        // Eliminates the pose's block only: what remains of the shape's block is its Schur complement.
        for k in 0..POSE {
            let pivot = a[k][k].max(1e-12);
            for i in k + 1..UNKNOWNS {
                let by = a[i][k] / pivot;
                if by != 0.0 {
                    for j in k + 1..=i {
                        a[i][j] -= by * a[j][k];
                    }
                    gradient[i] -= by * gradient[k];
                }
            }
        }
        ShapeQuadratic {
            hessian: std::array::from_fn(|i| std::array::from_fn(|j| a[POSE + i.max(j)][POSE + i.min(j)])),
            gradient: std::array::from_fn(|i| gradient[POSE + i]),
        }
    }
}

/// The inverse of a symmetric positive matrix of the shape's size, and the logarithm of its determinant.
pub fn invert(a: &[[f64; SHAPES]; SHAPES]) -> ([[f64; SHAPES]; SHAPES], f64) {
    let mut l = *a;
    factored(&mut l);
    (linear::inverse(&l), linear::log_determinant(&l))
}

/// Puts the Cholesky factor in the place of the lower triangle; small pivots are raised.
fn factored<const N: usize>(a: &mut [[f64; N]]) {
    let done = linear::factor(a, LEAST_PIVOT);
    debug_assert!(done.is_some(), "raised pivots are never refused");
}

/// Pivots below this are raised to it: directions that no residual constrains.
const LEAST_PIVOT: Pivot = Pivot::AtLeast(1e-12);

#[cfg(test)]
mod tests {
    use super::*;
    use toile_base::numeric::random::SplitMix64;

    fn rows() -> Vec<(JacobianRow, f32)> {
        let mut rng = SplitMix64::new(7);
        let row = |rng: &mut SplitMix64| std::array::from_fn(|i| if i < UNKNOWNS { rng.gaussian() } else { 0.0 });
        (0..3 * UNKNOWNS).map(|_| (row(&mut rng), rng.gaussian())).collect()
    }

    fn nothing() -> ShapeQuadratic {
        ShapeQuadratic { hessian: [[0.0; SHAPES]; SHAPES], gradient: [0.0; SHAPES] }
    }

    #[test]
    fn after_the_step_no_row_is_left_with_a_slope() {
        let mut equations = NormalEquations::new();
        rows().iter().for_each(|(row, r)| equations.add(row, *r, 2.0));
        let step = equations.step(&nothing(), 0.0);
        let mut then = NormalEquations::new();
        for (row, r) in rows() {
            let moved: f64 = row.iter().zip(&step).map(|(a, b)| f64::from(*a) * b).sum();
            then.add(&row, r + moved as f32, 2.0);
        }
        assert!(then.gradient[..UNKNOWNS].iter().all(|s| s.abs() < 2e-3), "{:?}", then.gradient);
        assert!(then.cost < equations.cost);
    }

    #[test]
    fn eliminating_the_pose_leaves_the_same_shape() {
        let mut equations = NormalEquations::new();
        rows().iter().for_each(|(row, r)| equations.add(row, *r, 1.0));
        let whole = equations.step(&nothing(), 0.0);
        let ShapeQuadratic { hessian, gradient } = equations.shape();
        let (inverse, _) = invert(&hessian);
        for i in 0..SHAPES {
            let step: f64 = -(0..SHAPES).map(|j| inverse[i][j] * gradient[j]).sum::<f64>();
            assert!((step - whole[POSE + i]).abs() < 1e-3, "{i}: {step} {}", whole[POSE + i]);
        }
    }
}
