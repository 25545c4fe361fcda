//! The surface that is skinned: the scene's shopper in the middle of a step, repeated up to the wanted number of vertices.

use glam::{Affine3A, Vec3};
use toile_assets::body::BodyError;
use toile_assets::scene;
use toile_base::mesh::SkinWeights;
use toile_base::skeleton::{BONE_CHAIN, BONES};
use toile_engine::body::palette;

/// A moment of the scene in which arms, legs and trunk are all bent (s).
const MOMENT_S: f32 = 4.6;

/// Weight of a bone that is added to a vertex so that it has four, before all are divided by their sum.
const ADDED_WEIGHT: f32 = 0.08;

/// Vertices at rest with their weights, and the palette that poses them.
#[derive(Debug, Clone)]
pub struct SkinnedSurface {
    /// Rest position (m) `[vertices]`.
    pub positions: Vec<Vec3>,
    /// Rest normal, unit `[vertices]`.
    pub normals: Vec<Vec3>,
    /// Bones that carry each vertex `[vertices]`.
    pub weights: Vec<SkinWeights>,
    /// Matrix of each bone, from the rest pose to the world.
    pub palette: [Affine3A; BONES],
}

impl SkinnedSurface {
    /// The shopper's vertices in their order, each once.
    ///
    /// # Errors
    /// Where the scene's shopper cannot be built.
    pub fn body() -> Result<Self, BodyError> {
        let (sex, measures) = scene::SHOPPER;
        let body = toile_assets::body::build(sex, &measures)?;
        let mut bones = [Affine3A::IDENTITY; BONES];
        palette(&body.skeleton, &scene::shopper(&body.skeleton, MOMENT_S), &mut bones);
        Ok(Self { positions: body.mesh.positions, normals: body.normals, weights: body.weights, palette: bones })
    }

    /// The shopper's vertices, repeated until there are `vertices`.
    ///
    /// # Errors
    /// As [`Self::body`].
    pub fn new(vertices: usize) -> Result<Self, BodyError> {
        Ok(Self::body()?.repeated(vertices))
    }

    /// The same vertices in their order, repeated or cut until there are `vertices`.
    pub fn repeated(self, vertices: usize) -> Self {
        Self {
            positions: self.positions.into_iter().cycle().take(vertices).collect(),
            normals: self.normals.into_iter().cycle().take(vertices).collect(),
            weights: self.weights.into_iter().cycle().take(vertices).collect(),
            palette: self.palette,
        }
    }

    /// The same vertices with exactly four influences each: those of fewer follow a little the bones around their own.
    pub fn with_four_influences(mut self) -> Self {
        self.weights.iter_mut().for_each(|w| *w = four(w));
        self
    }
}

/// Adds the bones nearest in the skeleton until there are four.
fn four(weights: &SkinWeights) -> SkinWeights {
    let mut all: Vec<(u8, f32)> = weights.iter().collect();
    let mut from = 0;
    while all.len() < 4 && from < all.len() {
        let own = usize::from(all[from].0);
        for (bone, parent) in BONE_CHAIN {
            let near = if bone == own { parent } else { Some(bone).filter(|_| parent == Some(own)) };
            if let Some(near) = near
                && all.len() < 4
                && all.iter().all(|(b, _)| usize::from(*b) != near)
            {
                all.push((near as u8, ADDED_WEIGHT));
            }
        }
        from += 1;
    }
    SkinWeights::strongest(all).0
}
