//! The surface that is skinned: the scene's shopper in the middle of a step, as often as vertices are asked for.

use glam::{Affine3A, Vec3};
use toile_assets::body::{Body, BodyError};
use toile_assets::mesh::SkinWeights;
use toile_assets::scene;
use toile_assets::skeleton::BONES;
use toile_engine::body::palette;

/// A moment of the scene in which arms, legs and trunk are all bent (s).
const MOMENT_S: f32 = 4.6;

/// Vertices at rest with their weights, and the palette that poses them.
#[derive(Debug, Clone)]
pub(crate) struct Surface {
    /// Rest position (m) `[vertices]`.
    pub positions: Vec<Vec3>,
    /// Rest normal, unit `[vertices]`.
    pub normals: Vec<Vec3>,
    /// Weights `[vertices]`.
    pub weights: Vec<SkinWeights>,
    /// Skin matrices.
    pub palette: [Affine3A; BONES],
}

impl Surface {
    /// The shopper's vertices in their order, repeated until there are `vertices`.
    pub fn new(vertices: usize) -> Result<Self, BodyError> {
        let (sex, measures) = scene::SHOPPER;
        let body = Body::build(sex, &measures)?;
        let mut bones = [Affine3A::IDENTITY; BONES];
        palette(&body.skeleton, &scene::shopper(&body.skeleton, MOMENT_S), &mut bones);
        Ok(Self {
            positions: body.mesh.positions.iter().copied().cycle().take(vertices).collect(),
            normals: body.normals.iter().copied().cycle().take(vertices).collect(),
            weights: body.weights.iter().copied().cycle().take(vertices).collect(),
            palette: bones,
        })
    }
}
