//! Bending: (1/2) |d|^2 with d = sum c_i x_i. Gradient c_i d; Hessian c_i c_j I, constant and positive semi-definite.

use glam::{DMat3, DVec3};

use super::super::problem::Bend;
use super::super::system::System;

fn curvature(bend: &Bend, x: &[DVec3]) -> DVec3 {
    bend.particles.iter().zip(&bend.coefficients).map(|(&i, c)| x[i as usize] * c).sum()
}

/// Energy of all stencils (J).
pub fn value(bends: &[Bend], x: &[DVec3]) -> f64 {
    bends.iter().map(|b| 0.5 * curvature(b, x).length_squared()).sum()
}

/// Adds the gradient (N).
pub fn gradient(bends: &[Bend], x: &[DVec3], to: &mut [DVec3]) {
    for bend in bends {
        let d = curvature(bend, x);
        bend.particles.iter().zip(&bend.coefficients).for_each(|(&i, c)| to[i as usize] += d * c);
    }
}

/// Adds the Hessian (N/m).
pub fn hessian(bends: &[Bend], to: &mut System) {
    for bend in bends {
        for (k, (&i, c)) in bend.particles.iter().zip(&bend.coefficients).enumerate().filter(|(_, (_, c))| **c != 0.0) {
            to.add(i as usize, &(DMat3::IDENTITY * (c * c)));
            for (&j, d) in bend.particles[..k].iter().zip(&bend.coefficients) {
                to.add_pair(i as usize, j as usize, &(DMat3::IDENTITY * (c * d)));
            }
        }
    }
}
