//! The mean body of a sex, from which morphs start: its surface at rest, and what is tied to the surface.
//!
//! The surface is drawn once by the crate `toile-sculpt` and stored; here it is read, skinned and given its landmarks.

#[cfg(test)]
mod tests;

use std::sync::LazyLock;

use glam::{Vec2, Vec3};

use super::landmarks::Landmarks;
use super::stored::StoredBodies;
use super::{shares, skin};
use toile_base::body::{Region, Sex};
use toile_base::mesh::{Mesh, SkinWeights};
use toile_base::skeleton::Skeleton;

/// One sex's body as drawn: closed, symmetric about x = 0, facing +z, soles on y = 0, arms half raised.
///
/// Texture: one atlas for both sexes. Each corner of a face has its own texture point, so that the surface stays one
/// closed manifold: the vertices of a seam have one position and several texture points.
#[derive(Debug, Clone)]
pub struct BaseBody {
    /// Sex of the body.
    pub sex: Sex,
    /// Surface points (m) `[vertices]`.
    pub positions: Vec<Vec3>,
    /// Faces, counter-clockwise from outside, the same for both sexes `[quads]`.
    pub quads: Vec<[u32; 4]>,
    /// Vertex indices, two triangles a face in the order of the faces, counter-clockwise from outside `[2 quads]`.
    pub triangles: Vec<[u32; 3]>,
    /// Texture points, 0 to 1, v upwards `[texture points]`.
    pub uvs: Vec<Vec2>,
    /// Texture point of each corner of each face `[quads]`.
    pub corners: Vec<[u32; 4]>,
    /// Piece of the atlas of each face, by number `[quads]`.
    pub charts: Vec<u8>,
    /// Mirror image of each vertex `[vertices]`.
    pub mirrors: Vec<u32>,
    /// Part of the body `[vertices]`.
    pub regions: Vec<Region>,
    /// Joint centres (m).
    pub skeleton: Skeleton,
    /// Bones that carry each vertex `[vertices]`.
    pub weights: Vec<SkinWeights>,
    /// Landmarks at which the tape is laid.
    pub landmarks: Landmarks,
}

/// Read by a test, so a failure here is a build that never passed its tests.
static STORED: LazyLock<StoredBodies> = LazyLock::new(|| {
    StoredBodies::decode(include_bytes!("../../data/body/base.bin")).expect("the embedded bodies are whole")
});

impl BaseBody {
    /// The mean body of a sex.
    pub fn new(sex: Sex) -> Self {
        let all = &*STORED;
        let positions = all.positions[StoredBodies::index(sex)].clone();
        let skeleton = all.skeletons[StoredBodies::index(sex)].clone();
        let triangles: Vec<[u32; 3]> = split(&all.quads);
        let left = shares::left(&positions, &all.quads, &all.regions, &skeleton);
        let right = shares::right(&left, &all.mirrors);
        let stature = positions.iter().map(|p| p.y).fold(0.0, f32::max);
        let skinning = skin::Skinning::new(&skeleton, stature);
        let sides = left.iter().zip(&right);
        let weights = positions.iter().zip(sides).map(|(&p, (&l, &r))| skinning.weights(p, l, r)).collect();
        let landmarks = Landmarks::place(&positions, &triangles, &all.regions, &Landmarks::drawn(sex));
        Self {
            sex,
            positions,
            quads: all.quads.clone(),
            triangles,
            uvs: all.uvs.clone(),
            corners: all.corners.clone(),
            charts: all.charts.clone(),
            mirrors: all.mirrors.clone(),
            regions: all.regions.clone(),
            skeleton,
            weights,
            landmarks,
        }
    }

    /// Texture points of the triangles' corners `[2 quads]`.
    pub fn triangle_corners(&self) -> Vec<[u32; 3]> {
        split(&self.corners)
    }
}

/// Whether a mesh is that of a drawn body, of whatever size.
pub fn is_drawn(mesh: &Mesh) -> bool {
    let all = &*STORED;
    mesh.positions.len() == all.regions.len() && mesh.triangles == split(&all.quads)
}

/// Each face split along the diagonal from its first corner: the same split on both sides of the body.
fn split(quads: &[[u32; 4]]) -> Vec<[u32; 3]> {
    quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect()
}
