//! A mesh as the crossing test has it.

use glam::DVec3;

/// Greatest coordinate (m) that is tested: of larger ones a product of three would overflow.
const LARGEST: f64 = 1e90;

/// A mesh as the crossing test has it: positions (m) and triangles.
#[derive(Debug, Clone, Copy)]
pub struct CrossingMesh<'a> {
    /// Positions of the vertices (m).
    pub positions: &'a [DVec3],
    /// Vertices of each triangle.
    pub triangles: &'a [[u32; 3]],
}

impl CrossingMesh<'_> {
    /// The corners of a triangle (m).
    pub(super) fn corners(&self, triangle: u32) -> [DVec3; 3] {
        self.triangles[triangle as usize].map(|v| self.positions[v as usize])
    }

    /// The ends of an edge (m).
    pub(super) fn ends(&self, edge: [u32; 2]) -> [DVec3; 2] {
        edge.map(|v| self.positions[v as usize])
    }
}

/// Whether all points have coordinates that signs can be computed of: finite, and no larger than 1e90 m.
pub(super) fn are_testable(points: &[DVec3]) -> bool {
    points.iter().all(|p| p.abs().max_element() <= LARGEST && !p.is_nan())
}

/// The edges of triangles, each once, lower vertex first, in ascending order. An edge from a vertex to itself is none.
pub(super) fn unique_edges(triangles: &[[u32; 3]]) -> Vec<[u32; 2]> {
    let sides = triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
    let mut edges: Vec<[u32; 2]> = sides.filter(|[a, b]| a != b).map(|[a, b]| [a.min(b), a.max(b)]).collect();
    edges.sort_unstable();
    edges.dedup();
    edges
}
