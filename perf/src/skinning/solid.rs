//! Volume of a part of a surface: its triangles, and a fan over each hole that they leave.

use std::collections::{BTreeMap, BTreeSet};

use glam::{DVec3, Vec3};

/// A part of a closed surface and the rims where it was cut out.
#[derive(Debug, Clone)]
pub struct ClosedSurface {
    triangles: Vec<[u32; 3]>,
    /// Edges that have the part on their left, a rim each.
    rims: Vec<Vec<[u32; 2]>>,
}

impl ClosedSurface {
    /// The triangles whose vertices are all inside.
    pub fn cut(triangles: &[[u32; 3]], inside: impl Fn(u32) -> bool) -> Self {
        Self::of(triangles.iter().copied().filter(|t| t.iter().all(|&v| inside(v))).collect())
    }

    /// All of these triangles.
    pub fn of(kept: Vec<[u32; 3]>) -> Self {
        let edges = |t: &[u32; 3]| [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]];
        let all: BTreeSet<[u32; 2]> = kept.iter().flat_map(edges).collect();
        let open: Vec<[u32; 2]> = all.iter().copied().filter(|[a, b]| !all.contains(&[*b, *a])).collect();
        Self { triangles: kept, rims: joined(&open) }
    }

    /// The same part, each triangle in four; `halfway` makes the vertex in the middle of an edge and says its index.
    pub fn refined(&self, mut halfway: impl FnMut([u32; 2]) -> u32) -> Self {
        let mut made: BTreeMap<[u32; 2], u32> = BTreeMap::new();
        let mut middle = |a: u32, b: u32| {
            let edge = [a.min(b), a.max(b)];
            *made.entry(edge).or_insert_with(|| halfway(edge))
        };
        let mut triangles = Vec::with_capacity(4 * self.triangles.len());
        for &[a, b, c] in &self.triangles {
            let [ab, bc, ca] = [middle(a, b), middle(b, c), middle(c, a)];
            triangles.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
        }
        Self::of(triangles)
    }

    /// Volume within the part and the fans over its rims (m^3).
    pub fn volume(&self, positions: &[Vec3]) -> f64 {
        let at = |v: u32| positions[v as usize].as_dvec3();
        let wedge = |a: DVec3, b: DVec3, c: DVec3| a.dot(b.cross(c)) / 6.0;
        let skin: f64 = self.triangles.iter().map(|t| wedge(at(t[0]), at(t[1]), at(t[2]))).sum();
        let fan = |rim: &Vec<[u32; 2]>| -> f64 {
            let middle = rim.iter().map(|e| at(e[0])).sum::<DVec3>() / rim.len() as f64;
            rim.iter().map(|e| wedge(at(e[1]), at(e[0]), middle)).sum()
        };
        skin + self.rims.iter().map(fan).sum::<f64>()
    }
}

/// Edges that are connected by their ends.
fn joined(edges: &[[u32; 2]]) -> Vec<Vec<[u32; 2]>> {
    let next: BTreeMap<u32, u32> = edges.iter().map(|e| (e[0], e[1])).collect();
    let mut left: BTreeSet<u32> = next.keys().copied().collect();
    let mut rims = Vec::new();
    while let Some(first) = left.pop_first() {
        let mut rim = Vec::new();
        let mut at = first;
        while let Some(&to) = next.get(&at) {
            rim.push([at, to]);
            if to == first || !left.remove(&to) {
                break;
            }
            at = to;
        }
        rims.push(rim);
    }
    rims
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tube_cut_out_of_a_tower_has_its_volume() {
        // Four storeys of unit squares, open at neither end.
        let mut points: Vec<Vec3> = Vec::new();
        for y in 0..5 {
            points.extend([[0.0, 0.0], [0.0, 1.0], [1.0, 1.0], [1.0, 0.0]].map(|[x, z]| Vec3::new(x, y as f32, z)));
        }
        let mut triangles = vec![[0, 2, 1], [0, 3, 2], [16, 17, 18], [16, 18, 19]];
        for y in 0..4u32 {
            for k in 0..4 {
                let [a, b] = [4 * y + k, 4 * y + (k + 1) % 4];
                triangles.extend([[a, b, b + 4], [a, b + 4, a + 4]]);
            }
        }
        let whole = ClosedSurface::cut(&triangles, |_| true);
        assert_eq!(whole.rims.len(), 0);
        assert!((whole.volume(&points).abs() - 4.0).abs() < 1e-9);
        let part = ClosedSurface::cut(&triangles, |v| (4..16).contains(&v));
        assert_eq!(part.rims.len(), 2);
        assert!((part.volume(&points).abs() - 2.0).abs() < 1e-9, "{}", part.volume(&points));
        let fine = part.refined(|[a, b]| {
            points.push((points[a as usize] + points[b as usize]) * 0.5);
            points.len() as u32 - 1
        });
        assert_eq!((fine.triangles.len(), fine.rims.len()), (4 * part.triangles.len(), 2));
        assert!((fine.volume(&points).abs() - 2.0).abs() < 1e-6, "{}", fine.volume(&points));
    }
}
