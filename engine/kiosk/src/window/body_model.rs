//! The meshes of a dressed body, for the renderer; made where it is dressed, handed to the render thread in one piece.

use std::sync::Arc;

use glam::Vec3;
use toile_assets::sizes::Girth;
use toile_base::body::Levels;
use toile_base::mesh::vertex_normals;
use toile_engine::cloth::step::measure;
use toile_engine::world::{Snapshot, World};
use toile_view::figure::{Appearance, Figure, OwnHead, PlacedHead};
use toile_view::hidden_skin::CoveringCloth;
use toile_view::own_picture::OwnPictureModel;
use toile_view::raster::Model;

/// Skin under a garment counts as so much farther off (m): how far a bent body stands out of its capsules.
const RECESS_M: f32 = 0.04;

/// Two sizes of the same outfit on the same body, draped: left and right.
pub type ModelPair = [BodyModel; 2];

/// The meshes of a body and its garments.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct BodyModel {
    /// The body with its hair, then the garments, inner first.
    pub meshes: Model,
    /// What brings the head along with the posed skin.
    pub head: PlacedHead,
    /// How much farther off each vertex counts `[surfaces][vertices]` (m): what lies under something.
    pub recess: Vec<Vec<f32>>,
    /// How tight each garment sits, -1 .. 1 `[garments][particles]`.
    pub fit: Vec<Vec<f32>>,
    /// The zone that each particle of a garment counts to, by its height `[garments][particles]`.
    pub zones: Vec<Vec<Girth>>,
    /// Height at which each particle is put on (m) `[garments][particles]`.
    pub heights: Vec<Vec<f32>>,
    /// Heights of chest, waist and hip (m).
    pub levels: [f32; 3],
    /// Height of the body (m).
    pub stature: f32,
    /// The same body for the shopper's own picture; none of the mannequin before the first shopper was dressed.
    pub own: Option<Arc<OwnPictureModel>>,
}

/// The zone whose level is nearest to a height (m). What hangs lower counts to the hip, what lies higher to the chest.
fn zone(levels: &Levels, height: f32) -> Girth {
    let middle = |a: f32, b: f32| 0.5 * (a + b);
    match height {
        y if y > middle(levels.chest, levels.waist) => Girth::Chest,
        y if y > middle(levels.waist, levels.hip) => Girth::Waist,
        _ => Girth::Hip,
    }
}

impl BodyModel {
    /// How tight a garment sits, -1 .. 1 `[particles]`: NaN, which has no colour, in zones whose fit is not known.
    pub fn known_fit(fit: &[f32], zones: &[Girth], unknown: [bool; 3]) -> Vec<f32> {
        let is_unknown = |zone: &Girth| Girth::ALL.iter().zip(unknown).any(|(of, unknown)| of == zone && unknown);
        fit.iter().zip(zones).map(|(fit, zone)| if is_unknown(zone) { f32::NAN } else { *fit }).collect()
    }

    /// Of a frame that was dressed, in rest as it lies in a snapshot of its own.
    pub fn draped(world: &World, snapshot: &Snapshot, appearance: Appearance, face: Option<&OwnHead>) -> Self {
        let mut model = Self::of(world, appearance, face);
        let mut normals = vec![Vec3::ZERO; snapshot.skin.vertices() + model.head.hair()];
        let points = snapshot.garments.iter().map(|g| g.to_vec());
        for (surface, points) in model.meshes.surfaces.iter_mut().skip(1).zip(points) {
            surface.rest = points;
        }
        if let Some(body) = model.meshes.surfaces.first_mut() {
            snapshot.skin.read(&mut body.rest, &mut normals);
            model.head.place(&mut body.rest, &mut normals);
        }
        model
    }

    /// Of a frame that was dressed, with the shopper's own head where it is on.
    pub fn of(world: &World, appearance: Appearance, face: Option<&OwnHead>) -> Self {
        let (body, garments) = (world.body(), world.garments());
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
        let figure = Figure::with_head(body, appearance, face);
        let mut recesses: Vec<Vec<f32>> = vec![recess(0, &body.mesh.positions, &body.normals)];
        // Hair lies over everything.
        recesses[0].resize(figure.rest.len(), 0.0);
        for (i, garment) in garments.iter().enumerate() {
            let mut normals = vec![Vec3::ZERO; garment.particles()];
            vertex_normals(&garment.start, &garment.triangles, &mut normals);
            recesses.push(recess(i + 1, &garment.start, &normals));
        }
        let tight = |(cloth, garment)| measure::tightness(cloth, garment, world.colliders());
        Self {
            meshes: Model::of_outfit(&figure, garments),
            head: figure.head,
            recess: recesses,
            fit: world.cloths().iter().zip(garments).map(tight).collect(),
            zones: garments.iter().map(|g| g.start.iter().map(|p| zone(&body.levels, p.y)).collect()).collect(),
            heights: garments.iter().map(|g| g.start.iter().map(|p| p.y).collect()).collect(),
            levels: [body.levels.chest, body.levels.waist, body.levels.hip],
            stature: body.measures.stature,
            own: Some(OwnPictureModel::of(body, garments)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_zone_that_is_not_known_has_no_colour_and_the_others_keep_theirs() {
        let zones = [Girth::Chest, Girth::Waist, Girth::Hip, Girth::Hip];
        let fit = BodyModel::known_fit(&[0.1, 0.2, 0.3, -0.4], &zones, [false, false, true]);
        assert!(fit[..2] == [0.1, 0.2] && fit[2].is_nan() && fit[3].is_nan(), "{fit:?}");
        assert_eq!(BodyModel::known_fit(&[0.1; 4], &zones, [false; 3]), [0.1; 4]);
    }
}
