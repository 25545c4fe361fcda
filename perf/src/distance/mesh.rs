//! A closed mesh that distances are measured to.

use std::collections::BTreeMap;

use glam::DVec3;

use super::closest::{TrianglePart, closest_point};
use super::tree::TriangleTree;

/// A closed mesh that distances are measured to, its triangles counter-clockwise seen from outside.
#[derive(Debug)]
pub struct DistanceMesh {
    corners: Vec<[DVec3; 3]>,
    tree: TriangleTree,
    /// Of each triangle the normal of its inside, those of its three edges and of its three corners. Of any length: only their
    /// directions count.
    normals: Vec<[DVec3; 7]>,
}

impl DistanceMesh {
    /// Of triangles by the positions of their vertices (m).
    ///
    /// # Panics
    /// Where a triangle names a vertex that is not given.
    pub fn new(positions: &[DVec3], triangles: &[[u32; 3]]) -> Self {
        let corners: Vec<[DVec3; 3]> = triangles.iter().map(|t| t.map(|v| positions[v as usize])).collect();
        let flat = |[a, b, c]: [DVec3; 3]| (b - a).cross(c - a).normalize_or_zero();
        let mut edges: BTreeMap<[u32; 2], DVec3> = BTreeMap::new();
        let mut vertices = vec![DVec3::ZERO; positions.len()];
        for (t, corners) in triangles.iter().zip(&corners) {
            let normal = flat(*corners);
            for k in 0..3 {
                let [here, next, last] = [k, (k + 1) % 3, (k + 2) % 3];
                let (from, to) = (t[here], t[next]);
                *edges.entry([from.min(to), from.max(to)]).or_default() += normal;
                let (u, v) = (corners[next] - corners[here], corners[last] - corners[here]);
                let angle = u.cross(v).length().atan2(u.dot(v));
                vertices[from as usize] += normal * angle;
            }
        }
        let normals = triangles.iter().zip(&corners).map(|(t, corners)| {
            let edge = |k: usize| edges[&[t[k].min(t[(k + 1) % 3]), t[k].max(t[(k + 1) % 3])]];
            let vertex = |k: usize| vertices[t[k] as usize];
            [flat(*corners), edge(0), edge(1), edge(2), vertex(0), vertex(1), vertex(2)]
        });
        let normals = normals.collect();
        Self { tree: TriangleTree::new(&corners), corners, normals }
    }

    /// Distance of a point (m), negative inside; infinite where there are no triangles.
    pub fn signed(&self, p: DVec3) -> f64 {
        self.nearest(p).0
    }

    /// The same, with the nearest triangle; the first one where there are none.
    pub fn nearest(&self, p: DVec3) -> (f64, u32) {
        let (mut nearest2, mut sign, mut nearest) = (f64::INFINITY, 1.0, 0);
        self.tree.each_nearer(p, &mut nearest2, |t, nearest2| {
            let (q, part) = closest_point(p, self.corners[t as usize]);
            let distance2 = p.distance_squared(q);
            if distance2 < *nearest2 {
                let normals = &self.normals[t as usize];
                let normal = match part {
                    TrianglePart::Inside => normals[0],
                    TrianglePart::Edge(k) => normals[1 + k],
                    TrianglePart::Corner(k) => normals[4 + k],
                };
                (*nearest2, nearest) = (distance2, t);
                sign = if (p - q).dot(normal) < 0.0 { -1.0 } else { 1.0 };
            }
        });
        (sign * nearest2.sqrt(), nearest)
    }
}
