//! Crossings of the played garments, counted every tenth step for the reports.

use glam::Vec3;
use toile_base::garment::Garment;
use toile_engine::cloth::Cloth;
use toile_fitting::crossings::{CrossingFigures, CrossingWatch};

use crate::report::CrossingReport;

/// Counts edges that pass through faces while garments are played.
#[derive(Debug)]
pub struct CrossingCount {
    watch: CrossingWatch,
    /// When there were most (s).
    worst_s: Option<f64>,
    step_seconds: f64,
}

impl CrossingCount {
    /// Of garments in steps of so many seconds.
    pub fn new(garments: &[Garment], step_seconds: f64) -> Self {
        let faces: Vec<&[[u32; 3]]> = garments.iter().map(|g| &*g.triangles).collect();
        Self { watch: CrossingWatch::new(&faces, step_seconds), worst_s: None, step_seconds }
    }

    /// Looks at the garments after a step, if it is one of those that are looked at; gives whether more crossed than ever before.
    pub fn after(&mut self, step: u64, cloths: &[Cloth]) -> bool {
        if !CrossingWatch::wants(step) {
            return false;
        }
        let at = |cloth: &Cloth| cloth.positions.iter().map(|p| Vec3::from(*p)).collect();
        let most = self.watch.figures().max;
        let [within, between] = self.watch.look(&cloths.iter().map(at).collect::<Vec<_>>());
        let worst = within + between > most;
        if worst {
            self.worst_s = Some(step as f64 * self.step_seconds);
        }
        worst
    }

    /// What was seen.
    pub fn report(&self) -> CrossingReport {
        let CrossingFigures { frames, frames_with, max, max_between, longest_s, .. } = self.watch.figures();
        CrossingReport { frames, frames_with, max, max_between, longest_s, worst_s: self.worst_s }
    }
}
