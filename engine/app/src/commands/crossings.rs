//! Crossings of what is played, counted every tenth step for the reports.

use glam::Vec3;
use toile_assets::garment::Garment;
use toile_engine::cloth::Cloth;
use toile_perf::crossings::{CrossingFigures, CrossingWatch};

use crate::report::CrossingReport;

/// Counts edges that pass through faces while garments are played.
#[derive(Debug)]
pub struct CrossingCount(CrossingWatch);

impl CrossingCount {
    /// Of garments in steps of so many seconds.
    pub fn new(garments: &[Garment], step_seconds: f64) -> Self {
        let faces: Vec<&[[u32; 3]]> = garments.iter().map(|g| &*g.triangles).collect();
        Self(CrossingWatch::new(&faces, step_seconds))
    }

    /// Looks at the garments after a step, if it is one of those that are looked at.
    pub fn after(&mut self, step: u64, cloths: &[Cloth]) {
        if CrossingWatch::wants(step) {
            let at = |cloth: &Cloth| cloth.positions.iter().map(|p| Vec3::from(*p)).collect();
            self.0.look(&cloths.iter().map(at).collect::<Vec<_>>());
        }
    }

    /// What was seen.
    pub fn report(&self) -> CrossingReport {
        let CrossingFigures { frames, frames_with, max, max_between, longest_s, .. } = self.0.figures();
        CrossingReport { frames, frames_with, max, max_between, longest_s }
    }
}
