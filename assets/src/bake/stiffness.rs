//! What stiffness an edge gets from the fabric.
//!
//! A link of length h stands for a strip of cloth of width w, its share of the area beside it over its length, and has
//! the stiffness k = E w / h of that strip. E is the fabric's modulus (N/m):
//!
//! * along a fiber of the warp or the weft, that of the thread, even where the mesh makes the fiber lean: a fiber is a
//!   thread, and threads do not stretch;
//! * for every other edge, that of a strip cut at its angle t to the warp (the off-axis modulus of an orthotropic sheet
//!   without Poisson's effect): 1 / E(t) = cos^4 t / E_warp + sin^4 t / E_weft + sin^2 t cos^2 t / G.
//!
//! In a rectangular cell with threads that hardly stretch, diagonals of this law have exactly the shear stiffness G,
//! whether there are two of them, each with half of the cell's area, or one, with all of it.

use super::fibers::{Direction, Edge};
use crate::fabric::Fabric;

/// Stiffness of an edge (N/m) as part of a fiber of the given direction.
pub fn stretch(edge: &Edge, fiber: Direction, fabric: &Fabric) -> f32 {
    let modulus = match fiber {
        Direction::Warp => fabric.stretch_warp_n_m,
        Direction::Weft => fabric.stretch_weft_n_m,
        Direction::Bias => off_axis(edge.angle, fabric),
    };
    modulus * edge.width / edge.rest
}

/// Modulus of a strip cut at an angle to the warp (N/m; rad).
pub fn off_axis(angle: f32, fabric: &Fabric) -> f32 {
    let (sin, cos) = angle.sin_cos();
    let (s, c) = (sin * sin, cos * cos);
    (c * c / fabric.stretch_warp_n_m + s * s / fabric.stretch_weft_n_m + s * c / fabric.shear_n_m).recip()
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;
    use crate::bake::fibers;
    use crate::garment::shape::NO_VERTEX;

    /// Energy of a rectangle's edges under a small shear against G/2 gamma^2 area.
    fn shear_ratio(faces: &[[u32; 4]], width: f32, height: f32) -> f32 {
        let mut fabric = Fabric::built_in("cotton-lawn").unwrap();
        (fabric.stretch_warp_n_m, fabric.stretch_weft_n_m) = (1e6, 1e6);
        let corner = |x: f32, y: f32| Vec3::new(x * width, y * height, 0.0);
        let p = [corner(0.0, 0.0), corner(1.0, 0.0), corner(1.0, 1.0), corner(0.0, 1.0)];
        let gamma = 1e-3;
        let sheared = p.map(|p| p + Vec3::X * gamma * p.y);
        let energy = |e: &Edge| {
            let longer = sheared[e.a as usize].distance(sheared[e.b as usize]) - e.rest;
            let kind = if e.direction == Direction::Bias { Direction::Bias } else { e.direction };
            // Warp sides turn without stretching, to first order.
            if kind == Direction::Bias { 0.5 * stretch(e, kind, &fabric) * longer * longer } else { 0.0 }
        };
        let sum: f32 = fibers::edges(&p, faces).iter().map(energy).sum();
        sum / (0.5 * fabric.shear_n_m * gamma * gamma * width * height)
    }

    #[test]
    fn diagonals_have_the_shear_stiffness_of_their_cell() {
        for (width, height) in [(1.0, 1.0), (1.0, 0.7), (0.6, 0.5)] {
            let two = shear_ratio(&[[0, 1, 2, 3]], width, height);
            let one = shear_ratio(&[[0, 1, 2, NO_VERTEX], [0, 2, 3, NO_VERTEX]], width, height);
            assert!((two - 1.0).abs() < 0.02 && (one - 1.0).abs() < 0.02, "{width} x {height}: {two}, {one}");
        }
    }

    #[test]
    fn a_strip_along_a_thread_has_the_threads_modulus() {
        let fabric = Fabric::built_in("cotton-lawn").unwrap();
        let quarter = std::f32::consts::FRAC_PI_2;
        assert!((off_axis(0.0, &fabric) / fabric.stretch_warp_n_m - 1.0).abs() < 1e-6);
        assert!((off_axis(quarter, &fabric) / fabric.stretch_weft_n_m - 1.0).abs() < 1e-4);
        let diagonal = off_axis(0.5 * quarter, &fabric);
        assert!(diagonal < 4.0 * fabric.shear_n_m && diagonal > 3.0 * fabric.shear_n_m, "{diagonal}");
    }
}
