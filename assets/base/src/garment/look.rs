//! How a garment shows its cloth: where each triangle lies on the fabric, how far from hems and seams, and a mesh's picture.

use std::sync::Arc;

use glam::Vec2;

use super::trim::ClothTrim;
use crate::texture::Texture;

/// Farther from a hem or a seam nothing of either is seen (m).
pub const EDGE_REACH_M: f32 = 0.06;

/// What pictures need of a garment beside its places; all of it is empty for one that shows its fabric's colour alone.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct GarmentAppearance {
    /// Where the corners of each triangle lie on the cloth (m): weft along x, warp along y, up the garment `[triangles]`; or
    /// empty, where no pattern says it.
    pub cloth: Box<[[Vec2; 3]]>,
    /// How far the corners of each triangle are from the nearest hem (x) and the nearest seam (y), [`EDGE_REACH_M`] at most
    /// (m) `[triangles]`; empty where `cloth` is.
    pub edges: Box<[[Vec2; 3]]>,
    /// What is put on the cloth: buttons, edges, strips, at most [`MAX_TRIMS`](super::trim::MAX_TRIMS).
    pub trims: Box<[ClothTrim]>,
    /// Which of them each triangle may show, a bit for each `[triangles]`; empty where there are none.
    pub near: Box<[u32]>,
    /// The picture that a mesh brings.
    pub picture: Option<MeshPicture>,
}

/// A picture on a mesh.
#[derive(Debug, Clone, PartialEq)]
pub struct MeshPicture {
    /// The picture.
    pub texture: Arc<Texture>,
    /// Where the corners of each triangle lie in it: 0 to 1 across, v upwards `[triangles]`.
    pub corners: Box<[[Vec2; 3]]>,
}

/// How far beyond its own width a trim casts a shadow (m).
pub const TRIM_SHADOW_M: f32 = 0.006;

impl GarmentAppearance {
    /// Bytes that it takes, without the picture, which garments share.
    pub fn bytes(&self) -> usize {
        let corners = self.picture.as_ref().map_or(0, |p| size_of_val(&*p.corners));
        let trims = size_of_val(&*self.trims) + size_of_val(&*self.near);
        size_of_val(&*self.cloth) + size_of_val(&*self.edges) + trims + corners
    }
}
