//! Tests whether a segment passes through a triangle, by exact signs of orientation.

use glam::DVec3;
use robust::{Coord3D, orient3d};

/// Whether an open segment passes through the interior of a triangle. What only touches (an end in the triangle's plane,
/// a line through a corner or an edge, all in one plane, a triangle without area) does not.
///
/// The ends lie on opposite sides of the triangle's plane, and the segment's line passes all three edges on the same
/// side: five signs of orientation (Segura and Feito 2001, "Algorithms to test ray-triangle intersection"), each exact as
/// long as nothing underflows, which no coordinate but 0 of at least 1e-80 m does (Shewchuk 1997, "Adaptive precision
/// floating-point arithmetic and fast robust geometric predicates").
pub(super) fn passes_through([p, q]: [DVec3; 2], [a, b, c]: [DVec3; 3]) -> bool {
    let [p, q, a, b, c] = [p, q, a, b, c].map(coordinates);
    if !differ(orient3d(a, b, c, p), orient3d(a, b, c, q)) {
        return false;
    }
    let side = orient3d(p, q, a, b);
    agree(side, orient3d(p, q, b, c)) && agree(side, orient3d(p, q, c, a))
}

fn coordinates(p: DVec3) -> Coord3D<f64> {
    Coord3D { x: p.x, y: p.y, z: p.z }
}

/// Whether one is positive and the other negative. Not by their product, which might underflow.
fn differ(a: f64, b: f64) -> bool {
    (a > 0.0 && b < 0.0) || (a < 0.0 && b > 0.0)
}

/// Whether both are positive or both negative.
fn agree(a: f64, b: f64) -> bool {
    differ(a, -b)
}
