//! The cone that the skirt lies on, however it is meshed.

use std::ops::Range;

use glam::{DVec3, Vec3};

use toile_bake::Shape;
use toile_base::garment::Part;
use toile_base::mesh::SkinWeights;

/// Radius at the pinned ring (m), and how much wider the hem is.
pub(super) const RADIUS: [f64; 2] = [0.18, 0.24];

/// Height of the pinned ring (m), and how far below it the hem starts.
pub(super) const HEIGHT: [f64; 2] = [1.08, 0.78];

/// The vertices of the hem in their order around it, of the grid and of the irregular mesh alike.
pub fn hem(n: usize) -> Range<usize> {
    n * n - n..n * n
}

/// The point of the cone at `u` (0 ring, 1 hem) and an angle (rad).
pub(super) fn point(u: f64, angle: f64) -> DVec3 {
    let r = RADIUS[0] + RADIUS[1] * u;
    DVec3::new(r * angle.cos(), HEIGHT[0] - HEIGHT[1] * u, r * angle.sin())
}

pub(super) fn push(shape: &mut Shape, p: DVec3, fixed: bool) {
    let p: Vec3 = p.as_vec3();
    shape.push(p, p, fixed, Part::All);
    shape.weights.push(SkinWeights { bones: [0; 4], weights: [1.0, 0.0, 0.0, 0.0] });
}
