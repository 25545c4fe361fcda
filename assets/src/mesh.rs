//! Triangle meshes at rest: the type that body, garments and imports share, and its checks.

use glam::{Vec2, Vec3};

/// A triangle mesh, metres, counter-clockwise seen from outside.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Mesh {
    /// Vertex positions (m) `[vertices]`.
    pub positions: Vec<Vec3>,
    /// Texture coordinates `[vertices]`, or empty.
    pub uvs: Vec<Vec2>,
    /// Vertex indices `[triangles]`.
    pub triangles: Vec<[u32; 3]>,
}

/// Skin weights of one vertex: up to four bones, weights summing to 1, unused ones 0.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SkinWeights {
    /// Bone indices, below [`crate::skeleton::BONES`].
    pub bones: [u8; 4],
    /// Weights, same order.
    pub weights: [f32; 4],
}

/// Area-weighted vertex normals, unit length, written into `normals` (same length as `positions`).
/// A vertex without area keeps the zero vector.
pub fn vertex_normals(positions: &[Vec3], triangles: &[[u32; 3]], normals: &mut [Vec3]) {
    normals.fill(Vec3::ZERO);
    for t in triangles {
        let [a, b, c] = t.map(|i| positions[i as usize]);
        let n = (b - a).cross(c - a);
        for &i in t {
            normals[i as usize] += n;
        }
    }
    for n in normals {
        *n = n.normalize_or_zero();
    }
}
