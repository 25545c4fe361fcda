//! The nearest point of one triangle, and which part of the triangle it is on.

use glam::DVec3;

/// A part of a triangle.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum TrianglePart {
    /// Its inside.
    Inside,
    /// The edge from this corner to the next.
    Edge(usize),
    /// This corner.
    Corner(usize),
}

/// The nearest point of a triangle to `p`, by the region of the triangle's plane that `p` lies over (Ericson 2005, "Real-time
/// collision detection", section 5.1.5).
pub(super) fn closest_point(p: DVec3, [a, b, c]: [DVec3; 3]) -> (DVec3, TrianglePart) {
    use TrianglePart::{Corner, Edge, Inside};
    let (ab, ac) = (b - a, c - a);
    let [to_a, to_b, to_c] = [p - a, p - b, p - c];
    let (a1, a2) = (ab.dot(to_a), ac.dot(to_a));
    if a1 <= 0.0 && a2 <= 0.0 {
        return (a, Corner(0));
    }
    let (b1, b2) = (ab.dot(to_b), ac.dot(to_b));
    if b1 >= 0.0 && b2 <= b1 {
        return (b, Corner(1));
    }
    let over_ab = a1 * b2 - b1 * a2;
    if over_ab <= 0.0 && a1 >= 0.0 && b1 <= 0.0 {
        return (a + ab * (a1 / (a1 - b1)), Edge(0));
    }
    let (c1, c2) = (ab.dot(to_c), ac.dot(to_c));
    if c2 >= 0.0 && c1 <= c2 {
        return (c, Corner(2));
    }
    let over_ca = c1 * a2 - a1 * c2;
    if over_ca <= 0.0 && a2 >= 0.0 && c2 <= 0.0 {
        return (a + ac * (a2 / (a2 - c2)), Edge(2));
    }
    let over_bc = b1 * c2 - c1 * b2;
    if over_bc <= 0.0 && b2 - b1 >= 0.0 && c1 - c2 >= 0.0 {
        return (b + (c - b) * ((b2 - b1) / ((b2 - b1) + (c1 - c2))), Edge(1));
    }
    let all = over_ab + over_bc + over_ca;
    (a + ab * (over_ca / all) + ac * (over_ab / all), Inside)
}
