//! What a garment's mesh must be before it is baked: every index valid, no area lost, every edge between two faces at
//! most. Each refusal names the face or the edge.

use std::collections::BTreeMap;
use std::fmt;

use glam::{Vec2, Vec3};

use crate::shape::{Face, NO_VERTEX};

/// Faces smaller than this have no direction to bend or to stretch in (m2): a tenth of a millimetre squared.
pub const LEAST_AREA_M2: f32 = 1e-8;

/// Vertices a garment may have: the memory of one frame's garments stays under 64 MiB.
pub const MAX_VERTICES: usize = 262_144;

/// What is wrong with a mesh.
#[derive(Debug, Clone, PartialEq)]
pub enum MeshError {
    /// No vertex or no face.
    Empty,
    /// Too many vertices.
    TooLarge {
        /// Number of vertices found.
        count: usize,
    },
    /// A coordinate that is NaN or infinite.
    NotFinite {
        /// Index of the vertex, from 0.
        vertex: usize,
    },
    /// A face that names a vertex that is not there.
    Index {
        /// Index of the face, from 0.
        face: usize,
        /// The vertex it names, from 0.
        vertex: u32,
        /// How many there are.
        count: usize,
    },
    /// A face without area.
    Degenerate {
        /// Index of the face, from 0.
        face: usize,
    },
    /// Three or more faces at one edge, or two that run the same way round.
    NonManifold {
        /// Vertex at one end, from 0.
        a: u32,
        /// Other end, from 0.
        b: u32,
        /// Faces at the edge.
        faces: usize,
    },
    /// A vertex that no face uses: it would have no mass.
    Loose {
        /// Index of the vertex, from 0.
        vertex: usize,
    },
}

impl MeshError {
    /// The flaw and its cure in one sentence, with the names by which the maker of the mesh knows its vertices and faces.
    pub fn described(&self, vertex_name: impl Fn(u32) -> String, face_name: impl Fn(usize) -> String) -> String {
        match *self {
            Self::Empty => {
                "the mesh has no faces; export it with its faces as polygons of three or four corners".into()
            }
            Self::TooLarge { count } => {
                format!(
                    "the mesh has {count} vertices, more than the {MAX_VERTICES} that fit; reduce it before exporting"
                )
            }
            Self::NotFinite { vertex } => {
                let name = vertex_name(vertex as u32);
                format!("{name} is not finite; repair the mesh in the program that exported it")
            }
            Self::Index { face, vertex, count } => {
                format!("{} names vertex {vertex} of only {count}; export the mesh again", face_name(face))
            }
            Self::Degenerate { face } => {
                let name = face_name(face);
                format!("{name} has no area (two of its corners coincide or all lie on a line); merge or delete it")
            }
            Self::NonManifold { a, b, faces } => format!(
                "the edge between {} and {} is shared by {faces} faces that do not form one surface (non-manifold); \
                 separate the layers or turn the faces the same way round",
                vertex_name(a),
                vertex_name(b)
            ),
            Self::Loose { vertex } => {
                let name = vertex_name(vertex as u32);
                format!("{name} belongs to no face and would have no mass; delete loose vertices")
            }
        }
    }
}

impl fmt::Display for MeshError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.described(|v| format!("vertex {v}"), |i| format!("face {i}")))
    }
}

impl std::error::Error for MeshError {}

/// Whether a face has a fourth corner.
pub fn is_quad(face: &Face) -> bool {
    face[3] != NO_VERTEX
}

/// The corners of a face: three or four.
pub fn corners(face: &Face) -> &[u32] {
    if is_quad(face) { face } else { &face[..3] }
}

/// Checks a mesh as a garment.
pub fn check(positions: &[Vec3], faces: &[Face]) -> Result<(), MeshError> {
    if faces.is_empty() {
        return Err(MeshError::Empty);
    }
    if positions.len() > MAX_VERTICES {
        return Err(MeshError::TooLarge { count: positions.len() });
    }
    if let Some(vertex) = positions.iter().position(|p| !p.is_finite()) {
        return Err(MeshError::NotFinite { vertex });
    }
    check_faces(positions, faces)?;
    check_edges(faces)?;
    let mut used = vec![false; positions.len()];
    for &v in faces.iter().flat_map(corners) {
        used[v as usize] = true;
    }
    match used.iter().position(|u| !u) {
        Some(vertex) => Err(MeshError::Loose { vertex }),
        None => Ok(()),
    }
}

/// Checks faces that are laid flat, each by its own corners: of all of them, none without area or turned over.
pub fn check_flat(flat: &[[Vec2; 4]], faces: &[Face]) -> Result<(), MeshError> {
    if flat.len() != faces.len() {
        return Err(MeshError::Degenerate { face: flat.len().min(faces.len()) });
    }
    for (i, (laid, face)) in flat.iter().zip(faces).enumerate() {
        let wrong = |k: usize| (laid[k - 1] - laid[0]).perp_dot(laid[k] - laid[0]) * 0.5 < LEAST_AREA_M2;
        if laid.iter().any(|p| !p.is_finite()) || (2..corners(face).len()).any(wrong) {
            return Err(MeshError::Degenerate { face: i });
        }
    }
    Ok(())
}

fn check_faces(positions: &[Vec3], faces: &[Face]) -> Result<(), MeshError> {
    for (i, face) in faces.iter().enumerate() {
        let ring = corners(face);
        if let Some(&vertex) = ring.iter().find(|&&v| v as usize >= positions.len()) {
            return Err(MeshError::Index { face: i, vertex, count: positions.len() });
        }
        let repeated = (0..ring.len()).any(|k| (0..k).any(|j| ring[j] == ring[k]));
        let p = |k: usize| positions[ring[k] as usize];
        let thin = (2..ring.len()).any(|k| (p(k - 1) - p(0)).cross(p(k) - p(0)).length() * 0.5 < LEAST_AREA_M2);
        if repeated || thin {
            return Err(MeshError::Degenerate { face: i });
        }
    }
    Ok(())
}

fn check_edges(faces: &[Face]) -> Result<(), MeshError> {
    let mut sides: BTreeMap<(u32, u32), (usize, usize)> = BTreeMap::new();
    for face in faces {
        let ring = corners(face);
        for (k, &a) in ring.iter().enumerate() {
            let b = ring[(k + 1) % ring.len()];
            let count = sides.entry((a.min(b), a.max(b))).or_default();
            if a < b {
                count.0 += 1;
            } else {
                count.1 += 1;
            }
        }
    }
    match sides.into_iter().find(|(_, (forth, back))| *forth > 1 || *back > 1) {
        Some(((a, b), (forth, back))) => Err(MeshError::NonManifold { a, b, faces: forth + back }),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn quad() -> (Vec<Vec3>, Vec<Face>) {
        (vec![Vec3::ZERO, Vec3::X, Vec3::new(1.0, 1.0, 0.0), Vec3::Y], vec![[0, 1, 2, 3]])
    }

    #[test]
    fn a_sound_mesh_passes() {
        let (p, f) = quad();
        assert_eq!(check(&p, &f), Ok(()));
    }

    #[test]
    fn each_flaw_is_named() {
        let (p, f) = quad();
        assert_eq!(check(&p, &[]), Err(MeshError::Empty));
        assert_eq!(check(&p, &[[0, 1, 9, 3]]), Err(MeshError::Index { face: 0, vertex: 9, count: 4 }));
        assert_eq!(check(&p, &[[0, 1, 1, 3]]), Err(MeshError::Degenerate { face: 0 }));
        let mut nan = p.clone();
        nan[2].y = f32::NAN;
        assert_eq!(check(&nan, &f), Err(MeshError::NotFinite { vertex: 2 }));
        let mut loose = p.clone();
        loose.push(Vec3::Z);
        assert_eq!(check(&loose, &f), Err(MeshError::Loose { vertex: 4 }));
        let fin = [p.clone(), vec![Vec3::Z, Vec3::NEG_Z]].concat();
        let three = [[0, 1, 2, NO_VERTEX], [1, 0, 4, NO_VERTEX], [0, 1, 5, NO_VERTEX], [0, 2, 3, NO_VERTEX]];
        assert_eq!(check(&fin, &three), Err(MeshError::NonManifold { a: 0, b: 1, faces: 3 }));
    }
}
