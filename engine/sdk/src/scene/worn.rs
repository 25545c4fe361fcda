//! The garments of a scene, and their state.

use serde::Serialize;
use toile_engine::cloth::Cloth;
use toile_engine::cloth::step::measure::Strain;

use crate::error::Error;
use crate::fit::Recommendation;

/// A garment of a scene.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct WornGarment {
    /// What it was opened by, or the name that the scene file gives it.
    pub name: String,
    /// Code of its size; empty in a scene file.
    pub size: String,
    /// Its fabric.
    pub fabric: String,
    /// Vertices in the caller's order.
    pub vertices: usize,
    /// Triangles.
    pub faces: usize,
    /// Layers of a mesh that lie over each other; 1 of all else.
    pub layers: usize,
    /// How its size fits over what is worn beneath; none of a mesh without sizes and in a scene file.
    pub fit: Option<Recommendation>,
    /// What was repaired in a mesh and what became of its pieces, a sentence each.
    pub notes: Vec<String>,
}

/// How a garment does at the moment.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct GarmentStats {
    /// Mean strain of warp and weft edges, |length / rest - 1| (1); of a mesh in layers the worst layer's, as all of these.
    pub strain_mean: f32,
    /// 99th percentile of it (1).
    pub strain_p99: f32,
    /// The worst edge's (1).
    pub strain_max: f32,
    /// Deepest point of a free particle inside of the body or the colliders (mm).
    pub penetration_mm: f32,
    /// Steps so far that were not finite and were rolled back.
    pub rolled_back: u64,
}

impl GarmentStats {
    /// With one more layer.
    pub(super) fn add(&mut self, strain: Strain, penetration_m: f32, cloth: &Cloth) {
        self.strain_mean = self.strain_mean.max(strain.mean);
        self.strain_p99 = self.strain_p99.max(strain.p99);
        self.strain_max = self.strain_max.max(strain.max);
        self.penetration_mm = self.penetration_mm.max(penetration_m * 1e3);
        self.rolled_back += cloth.events.rolled_back;
    }
}

/// The error that a scene file has no body.
pub(super) fn no_body(what: &str) -> Error {
    Error::usage(format!("there is no {what}, because a scene file has no body; dress a body to have one"))
}
