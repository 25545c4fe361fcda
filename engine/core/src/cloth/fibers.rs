//! Fibers: stretch along warp and weft, shear along the bias, by Gauss-Seidel.
//!
//! Extended position-based dynamics (Macklin, Mueller, Chentanez 2016, eq. 18): for a link C = |b - a| - rest with
//! compliance alpha, one iteration a substep moves the ends by -+ w n C / (w_a + w_b + alpha / dt^2). The compliance is
//! the inverse of a physical stiffness, so neither the step nor the number of substeps changes what is converged to.

use toile_assets::garment::{Garment, Stretch};

use super::Cloth;

/// A link shorter than this has no direction (m).
const LEAST_LENGTH_M: f32 = 1e-7;

/// Solves every set once, in the order in which they were baked: bias, weft, warp.
pub fn solve(cloth: &mut Cloth, garment: &Garment, dt: f32) {
    let per_dt2 = (dt * dt).recip();
    for link in &garment.stretch {
        solve_link(&mut cloth.positions, &garment.inverse_mass, link, per_dt2);
    }
}

#[inline]
fn solve_link(positions: &mut [glam::Vec3A], inverse_mass: &[f32], link: &Stretch, per_dt2: f32) {
    let (a, b) = (link.a as usize, link.b as usize);
    let (wa, wb) = (inverse_mass[a], inverse_mass[b]);
    let d = positions[b] - positions[a];
    let length = d.length();
    let weight = wa + wb + link.compliance * per_dt2;
    if length < LEAST_LENGTH_M || weight <= 0.0 {
        return;
    }
    let push = d * ((length - link.rest) / (length * weight));
    positions[a] += push * wa;
    positions[b] -= push * wb;
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3A;

    #[test]
    fn a_stiff_link_reaches_its_length_and_keeps_the_centre_of_mass() {
        let mut p = [Vec3A::ZERO, Vec3A::new(2.0, 0.0, 0.0)];
        let w = [1.0, 3.0];
        solve_link(&mut p, &w, &Stretch { a: 0, b: 1, rest: 1.0, compliance: 0.0 }, 1.0);
        assert!(((p[1] - p[0]).length() - 1.0).abs() < 1e-6);
        assert!((p[0].x / w[0] + p[1].x / w[1] - 2.0 / w[1]).abs() < 1e-6);
    }

    #[test]
    fn collapsed_and_fixed_links_do_nothing() {
        for (w, b) in [([1.0, 1.0], Vec3A::ZERO), ([0.0, 0.0], Vec3A::X * 3.0)] {
            let mut p = [Vec3A::ZERO, b];
            solve_link(&mut p, &w, &Stretch { a: 0, b: 1, rest: 1.0, compliance: 0.0 }, 1.0);
            assert_eq!(p, [Vec3A::ZERO, b]);
        }
    }
}
