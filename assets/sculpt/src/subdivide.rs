//! Catmull-Clark subdivision of a closed mesh of quads, and the cage whose limit surface passes through given points.
//!
//! Catmull and Clark 1978 for the refinement; Halstead, Kass and DeRose 1993, "Efficient, fair interpolation using
//! Catmull-Clark surfaces", for the limit of a vertex of valence n, `(n^2 v + 4 sum(e) + sum(f)) / (n (n + 5))`.

use glam::Vec3;

/// An edge: its two vertices and the two faces that share it.
#[derive(Debug, Clone, Copy)]
struct Edge {
    ends: [u32; 2],
    faces: [u32; 2],
}

/// The connectivity of one closed mesh of quads, with everything that refinement asks of it.
#[derive(Debug, Clone)]
pub(super) struct Quads {
    faces: Vec<[u32; 4]>,
    edges: Vec<Edge>,
    valence: Vec<f32>,
    /// Edge of each face's side `[faces]`, side k running from corner k to corner k + 1.
    sides: Vec<[u32; 4]>,
}

impl Quads {
    /// Joins faces to edges. Panics when an edge is not shared by exactly two faces: the cage is our own data.
    pub(super) fn new(vertices: usize, faces: Vec<[u32; 4]>) -> Self {
        let mut half: Vec<(u32, u32, u32, u32)> = Vec::with_capacity(faces.len() * 4);
        for (f, q) in faces.iter().enumerate() {
            for (k, &a) in q.iter().enumerate() {
                let b = q[(k + 1) % 4];
                half.push((a.min(b), a.max(b), f as u32, k as u32));
            }
        }
        half.sort_unstable();
        let mut valence = vec![0.0; vertices];
        let mut sides = vec![[0; 4]; faces.len()];
        let edges = half
            .chunks(2)
            .enumerate()
            .map(|(e, pair)| {
                assert!(pair.len() == 2 && (pair[0].0, pair[0].1) == (pair[1].0, pair[1].1), "the cage is not closed");
                for h in pair {
                    sides[h.2 as usize][h.3 as usize] = e as u32;
                }
                let ends = [pair[0].0, pair[0].1];
                ends.iter().for_each(|&v| valence[v as usize] += 1.0);
                Edge { ends, faces: [pair[0].2, pair[1].2] }
            })
            .collect();
        Self { faces, edges, valence, sides }
    }

    /// The connectivity after one refinement: old vertices first, then one vertex an edge, then one a face.
    pub(super) fn refined(&self) -> Self {
        let (first_edge, first_face) = (self.valence.len() as u32, (self.valence.len() + self.edges.len()) as u32);
        let mut faces = Vec::with_capacity(self.faces.len() * 4);
        for (f, q) in self.faces.iter().enumerate() {
            for (k, &corner) in q.iter().enumerate() {
                let (after, before) = (self.sides[f][k], self.sides[f][(k + 3) % 4]);
                faces.push([corner, first_edge + after, first_face + f as u32, first_edge + before]);
            }
        }
        Self::new(self.valence.len() + self.edges.len() + self.faces.len(), faces)
    }

    /// Each refined vertex's mirror image, from the mirror images of vertices and faces.
    pub(super) fn refined_mirrors(&self, mirrors: &[u32], faces: impl Fn(u32) -> u32) -> Vec<u32> {
        let (first_edge, first_face) = (self.valence.len() as u32, (self.valence.len() + self.edges.len()) as u32);
        let edge = |e: &Edge| {
            let [a, b] = e.ends.map(|v| mirrors[v as usize]);
            let ends = [a.min(b), a.max(b)];
            first_edge + self.edges.binary_search_by(|o| o.ends.cmp(&ends)).expect("a mirrored edge") as u32
        };
        let own = mirrors.iter().copied();
        own.chain(self.edges.iter().map(edge))
            .chain((0..self.faces.len() as u32).map(|f| first_face + faces(f)))
            .collect()
    }

    /// Vertex indices of each face `[faces]`.
    pub(super) fn faces(&self) -> &[[u32; 4]] {
        &self.faces
    }

    /// The two ends of each edge.
    pub(super) fn edges(&self) -> impl Iterator<Item = [u32; 2]> {
        self.edges.iter().map(|e| e.ends)
    }

    /// Values on the refined mesh's vertices, from values on this one's.
    pub(super) fn refine(&self, values: &[Vec3]) -> Vec<Vec3> {
        let at = |i: u32| values[i as usize];
        let centres: Vec<Vec3> =
            self.faces.iter().map(|q| (at(q[0]) + at(q[1]) + at(q[2]) + at(q[3])) * 0.25).collect();
        let mut out: Vec<Vec3> = vec![Vec3::ZERO; values.len()];
        for (q, &c) in self.faces.iter().zip(&centres) {
            for &v in q {
                out[v as usize] += c;
            }
        }
        let mut middles = Vec::with_capacity(self.edges.len());
        for e in &self.edges {
            let (sum, [f, g]) = (at(e.ends[0]) + at(e.ends[1]), e.faces);
            middles.push((sum + (centres[f as usize] + centres[g as usize])) * 0.25);
            for v in e.ends {
                out[v as usize] += sum;
            }
        }
        // (Q + 2 R + (n - 3) S) / n, where Q and R are means over n faces and n edge middles.
        for ((o, &v), &n) in out.iter_mut().zip(values).zip(&self.valence) {
            *o = (*o / n + (n - 3.0) * v) / n;
        }
        out.extend(middles);
        out.extend(centres);
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cube() -> (Quads, Vec<Vec3>) {
        let points = (0..8).map(|i| Vec3::new((i & 1) as f32, (i >> 1 & 1) as f32, (i >> 2) as f32) - 0.5).collect();
        let faces = vec![[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        (Quads::new(8, faces), points)
    }

    #[test]
    fn refinement_keeps_the_sphere_topology() {
        let (quads, points) = cube();
        let fine = quads.refined().refined();
        let vertices = quads.refined().refine(&quads.refine(&points)).len();
        assert_eq!(vertices + fine.faces.len(), fine.edges.len() + 2);
    }
}
