//! The JSON of `toile bench skinning`.

use serde::Serialize;
use toile_engine::skin::Blend;
use toile_fitting::scene::yardstick;
use toile_perf::skinning::table::SkinningRow;
use toile_perf::skinning::{Skinning, Timing};

/// The body of `toile bench skinning`.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SkinningReport {
    /// The blend that the next four figures are of.
    pub blend: &'static str,
    /// Time of one pass over all vertices (us, median).
    pub us: f64,
    /// The same for one vertex (ns).
    pub ns_per_vertex: f64,
    /// The same over the yardstick of as many vertices.
    pub y_ratio: f64,
    /// Largest distance from an f64 oracle (m).
    pub max_error_m: f64,
    /// Vertices of the plain scalar loop, always the same.
    pub yardstick_verts: usize,
    /// What was skinned, its lanes, and the figures of both blends.
    #[serde(flatten)]
    pub found: SkinningRow,
}

impl SkinningReport {
    /// What was found, with the figures of one blend first.
    pub fn new(found: Skinning, blend: Blend) -> Self {
        let Timing { us, ns_per_vertex, y_ratio, max_error_m, .. } = match blend {
            Blend::Linear => found.linear,
            Blend::Dual => found.dual,
        };
        let yardstick_verts = yardstick::VERTICES;
        Self { blend: blend.name(), us, ns_per_vertex, y_ratio, max_error_m, yardstick_verts, found: found.into() }
    }
}
