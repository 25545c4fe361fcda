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
//! In a rectangular cell with threads that hardly stretch, diagonals of this modulus have exactly the shear stiffness G,
//! whether there are two of them, each with half of the cell's area, or one, with all of it. They pull along the threads
//! too: [`threads`] leaves them that part.

use super::fibers::{Direction, Edge, Fiber};
use toile_base::fabric::Fabric;
use toile_base::numeric::portable;

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
    let (sin, cos) = portable::sin_cos(angle);
    let (s, c) = (sin * sin, cos * cos);
    (c * c / fabric.stretch_warp_n_m + s * s / fabric.stretch_weft_n_m + s * c / fabric.shear_n_m).recip()
}

/// Rounds in which the threads' moduli are found: each leaves less than G/E of the error.
const ROUNDS: usize = 20;

/// Least and most part of its modulus that a thread gets: cloth whose diagonals alone are stiffer than it is has no such
/// mesh, and in an irregular one threads that lean want a little more.
const SHARES: [f64; 2] = [0.05, 1.5];

/// Stiffness of a mesh under uniform strains along warp and weft (N/m): as a membrane.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
struct Membrane {
    warp: f64,
    weft: f64,
    both: f64,
}

impl Membrane {
    /// What the links of a mesh come to together: a link at an angle t to the warp of modulus m over its share a of the
    /// area adds m a times cos^4 t, sin^4 t and sin^2 t cos^2 t.
    fn of(edges: &[Edge], roles: &[Direction], area: f64, fabric: &Fabric) -> Self {
        let mut sum = Self::default();
        for (edge, role) in edges.iter().zip(roles) {
            let modulus = f64::from(stretch(edge, *role, fabric) * edge.rest * edge.rest);
            let (sin, cos) = f64::from(edge.angle).sin_cos();
            let part = modulus / area;
            sum.warp += part * cos.powi(4);
            sum.weft += part * sin.powi(4);
            sum.both += part * (sin * cos).powi(2);
        }
        sum
    }

    /// Moduli along warp and weft of a strip that is free to narrow (N/m).
    fn moduli(&self) -> [f64; 2] {
        let narrowing = |other: f64| if other > 0.0 { self.both * self.both / other } else { 0.0 };
        [self.warp - narrowing(self.weft), self.weft - narrowing(self.warp)]
    }
}

/// The fabric with threads that are softer by as much as its diagonals pull along them, so that a strip of the mesh along warp or
/// weft has the modulus of the fabric: diagonals add about the shear stiffness, which in a knit is a tenth of it. `area`
/// is that of the whole cloth (m2). Threads that do not stretch at all stay as they are.
pub fn threads(edges: &[Edge], chains: &[Fiber], area: f64, fabric: &Fabric) -> Fabric {
    let mut found = fabric.clone();
    let wanted = [fabric.stretch_warp_n_m, fabric.stretch_weft_n_m].map(f64::from);
    if area <= 0.0 || wanted.iter().any(|e| !e.is_finite()) {
        return found;
    }
    let mut roles: Vec<Direction> = edges.iter().map(|e| e.direction).collect();
    for chain in chains {
        chain.edges.iter().for_each(|&e| roles[e as usize] = chain.direction);
    }
    let mut threads = wanted;
    for _ in 0..ROUNDS {
        let got = Membrane::of(edges, &roles, area, &found).moduli();
        for k in 0..2 {
            threads[k] = (threads[k] + wanted[k] - got[k]).clamp(SHARES[0] * wanted[k], SHARES[1] * wanted[k]);
        }
        (found.stretch_warp_n_m, found.stretch_weft_n_m) = (threads[0] as f32, threads[1] as f32);
    }
    found
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;
    use crate::fibers;
    use crate::shape::NO_VERTEX;

    /// Energy of a rectangle's edges under a small shear against G/2 gamma^2 area.
    fn shear_ratio(faces: &[[u32; 4]], width: f32, height: f32) -> f32 {
        let mut fabric = Fabric::cotton_lawn();
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
        let fabric = Fabric::cotton_lawn();
        let quarter = std::f32::consts::FRAC_PI_2;
        assert!((off_axis(0.0, &fabric) / fabric.stretch_warp_n_m - 1.0).abs() < 1e-6);
        assert!((off_axis(quarter, &fabric) / fabric.stretch_weft_n_m - 1.0).abs() < 1e-4);
        let diagonal = off_axis(0.5 * quarter, &fabric);
        assert!(diagonal < 4.0 * fabric.shear_n_m && diagonal > 3.0 * fabric.shear_n_m, "{diagonal}");
    }

    #[test]
    fn a_strip_of_any_mesh_has_the_modulus_of_its_fabric() {
        use crate::tests::meshes::{rough_sheet, sheet, split};
        for stretch in [60.0, 600.0, 6000.0] {
            let mut fabric = Fabric::cotton_lawn();
            (fabric.stretch_warp_n_m, fabric.stretch_weft_n_m, fabric.shear_n_m) = (stretch, 0.6 * stretch, 60.0);
            let grid = sheet(12, 16, 0.02, 0.03);
            for (positions, faces) in [split(grid.clone(), true), grid, rough_sheet(0.4, 0.4, 0.03, 3)] {
                let edges = fibers::edges(&positions, &faces);
                let chains = fibers::trace(&positions, &edges);
                let area = faces.iter().map(|f| f64::from(fibers::area(&positions, f))).sum();
                let threads = threads(&edges, &chains, area, &fabric);
                let mut roles: Vec<Direction> = edges.iter().map(|e| e.direction).collect();
                chains.iter().for_each(|c| c.edges.iter().for_each(|&e| roles[e as usize] = c.direction));
                let found = Membrane::of(&edges, &roles, area, &threads).moduli();
                for (got, wanted) in found.iter().zip([stretch, 0.6 * stretch]) {
                    assert!((got / f64::from(wanted) - 1.0).abs() < 0.01, "{stretch}: {found:?}");
                }
            }
        }
    }

    #[test]
    fn threads_that_do_not_stretch_stay_as_they_are() {
        let mut fabric = Fabric::cotton_lawn();
        fabric.stretch_warp_n_m = f32::INFINITY;
        assert_eq!(threads(&[], &[], 1.0, &fabric), fabric);
    }
}
