//! Checks that a surface is closed: vertices that lie in the same place are one (files repeat them along texture seams),
//! and an edge with a triangle on one side alone is a boundary.

use std::collections::BTreeMap;

use glam::Vec3;

/// Places closer than this are one (m): a hundredth of a millimetre.
const SAME_M: f32 = 1e-5;

/// Parts of a surface.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SurfaceCheck {
    /// Places with a vertex that a triangle uses.
    pub places: usize,
    /// Number of connected pieces of the surface.
    pub parts: usize,
    /// Edges with a triangle on one side alone.
    pub boundary: Vec<[u32; 2]>,
    /// Edges of more than two triangles.
    pub crowded: usize,
    /// For every vertex the first one in its place `[vertices]`.
    pub first: Vec<u32>,
}

impl SurfaceCheck {
    /// Looks at a mesh. Boundary edges are in the order of their vertices.
    pub fn of(positions: &[Vec3], triangles: &[[u32; 3]]) -> Self {
        let first = first_in_place(positions);
        let mut edges = Vec::with_capacity(3 * triangles.len());
        let mut parts = VertexSets::new(positions.len());
        let mut used = vec![false; positions.len()];
        for t in triangles {
            let [a, b, c] = t.map(|v| first[v as usize]);
            if a == b || b == c || c == a {
                continue;
            }
            for (p, q) in [(a, b), (b, c), (c, a)] {
                edges.push([p.min(q), p.max(q)]);
                parts.join(p, q);
                used[p as usize] = true;
            }
        }
        edges.sort_unstable();
        let (mut boundary, mut crowded) = (Vec::new(), 0);
        for same in edges.chunk_by(|a, b| a == b) {
            match same.len() {
                1 => boundary.push(same[0]),
                2 => {}
                _ => crowded += 1,
            }
        }
        let places: Vec<u32> = (0..positions.len() as u32).filter(|v| used[*v as usize]).collect();
        let parts = places.iter().filter(|v| parts.root(**v) == **v).count();
        Self { places: places.len(), parts, boundary, crowded, first }
    }
}

fn first_in_place(positions: &[Vec3]) -> Vec<u32> {
    let mut seen = BTreeMap::new();
    let cell = |p: &Vec3| (*p / SAME_M).round().to_array().map(|x| x as i64);
    positions.iter().enumerate().map(|(v, p)| *seen.entry(cell(p)).or_insert(v as u32)).collect()
}

/// Disjoint sets of vertices; the least vertex stands for its set.
struct VertexSets(Vec<u32>);

impl VertexSets {
    fn new(count: usize) -> Self {
        Self((0..count as u32).collect())
    }

    fn root(&mut self, mut v: u32) -> u32 {
        while self.0[v as usize] != v {
            let above = self.0[v as usize];
            self.0[v as usize] = self.0[above as usize];
            v = above;
        }
        v
    }

    fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.root(a), self.root(b));
        self.0[a.max(b) as usize] = a.min(b);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A tetrahedron whose corners are repeated in each triangle.
    fn tetrahedron() -> (Vec<Vec3>, Vec<[u32; 3]>) {
        let corners = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];
        let faces = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]];
        let positions = faces.iter().flatten().map(|&i: &usize| corners[i]).collect();
        (positions, (0..4).map(|f| [3 * f, 3 * f + 1, 3 * f + 2]).collect())
    }

    #[test]
    fn seams_are_no_holes_and_a_missing_triangle_is_one() {
        let (positions, mut triangles) = tetrahedron();
        let whole = SurfaceCheck::of(&positions, &triangles);
        assert_eq!((whole.places, whole.parts, whole.boundary.len(), whole.crowded), (4, 1, 0, 0));
        triangles.pop();
        assert_eq!(SurfaceCheck::of(&positions, &triangles).boundary.len(), 3);
    }

    #[test]
    fn two_solids_are_two_parts() {
        let (mut positions, mut triangles) = tetrahedron();
        let far: Vec<Vec3> = positions.iter().map(|p| *p + Vec3::splat(9.0)).collect();
        triangles.extend(triangles.clone().iter().map(|t| t.map(|v| v + positions.len() as u32)));
        positions.extend(far);
        assert_eq!(SurfaceCheck::of(&positions, &triangles).parts, 2);
    }
}
