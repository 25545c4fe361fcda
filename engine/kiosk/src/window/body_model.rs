//! The meshes of a dressed body, for the renderer; made where it is dressed, handed to the render thread in one piece.

use glam::Vec3;
use toile_assets::mesh::vertex_normals;
use toile_engine::cloth::measure;
use toile_engine::frame::{Frame, Snapshot};
use toile_view::hidden_skin::CoveringCloth;
use toile_view::raster::Model;

/// Skin under a garment counts as so much farther off (m): how far a bent body stands out of its capsules.
const RECESS_M: f32 = 0.04;

/// Two sizes of the same outfit on the same body, draped: left and right.
pub type ModelPair = [BodyModel; 2];

/// The meshes of a body and its garments.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct BodyModel {
    /// The body, then the garments, inner first.
    pub meshes: Model,
    /// How much farther off each vertex counts `[surfaces][vertices]` (m): what lies under something.
    pub recess: Vec<Vec<f32>>,
    /// How tight each garment sits, -1 .. 1 `[garments][particles]`.
    pub fit: Vec<Vec<f32>>,
    /// Height of the body (m).
    pub stature: f32,
}

impl BodyModel {
    /// Of a frame that was dressed, in rest as it lies in a snapshot of its own.
    pub fn draped(frame: &Frame, snapshot: &Snapshot) -> Self {
        let mut model = Self::of(frame);
        let mut normals = vec![Vec3::ZERO; snapshot.skin.vertices()];
        let points = snapshot.garments.iter().map(|g| g.to_vec());
        for (surface, points) in model.meshes.surfaces.iter_mut().skip(1).zip(points) {
            surface.rest = points;
        }
        if let Some(body) = model.meshes.surfaces.first_mut() {
            snapshot.skin.read(&mut body.rest, &mut normals);
        }
        model
    }

    /// Of a frame that was dressed.
    pub fn of(frame: &Frame) -> Self {
        let (body, garments) = (frame.body(), frame.garments());
        let over = |first: usize| {
            let worn = garments.iter().skip(first);
            CoveringCloth::new(worn.flat_map(|g| g.triangles.iter().map(|t| t.map(|i| g.start[i as usize]))))
        };
        let recess = |first: usize, positions: &[Vec3], normals: &[Vec3]| {
            let dressed = over(first).dressed(positions, normals);
            // Each layer lies deeper than the one over it.
            let depth = RECESS_M * (garments.len() + 1 - first) as f32 / (garments.len() + 1) as f32;
            dressed.into_iter().map(|d| if d { depth.max(RECESS_M * 0.25) } else { 0.0 }).collect()
        };
        let mut recesses = vec![recess(0, &body.mesh.positions, &body.normals)];
        for (i, garment) in garments.iter().enumerate() {
            let mut normals = vec![Vec3::ZERO; garment.particles()];
            vertex_normals(&garment.start, &garment.triangles, &mut normals);
            recesses.push(recess(i + 1, &garment.start, &normals));
        }
        let tight = |(cloth, garment)| measure::tightness(cloth, garment, frame.colliders());
        Self {
            meshes: Model::of_outfit(body, garments),
            recess: recesses,
            fit: frame.cloths().iter().zip(garments).map(tight).collect(),
            stature: body.measures.stature,
        }
    }
}
