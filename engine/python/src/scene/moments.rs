//! Positions as they were after a step, in memory that is used again once no array refers to it.

use std::sync::Arc;

use toile_sdk::Scene;
use toile_sdk::glam::Vec3;

/// Buffers that a garment keeps: one that is shown, one that the caller still has from the step before, one to write.
const MOST_BUFFERS: usize = 3;

/// The positions of one garment.
#[derive(Debug, Default)]
pub struct Moments {
    buffers: Vec<Arc<Vec<Vec3>>>,
    /// After how many steps the last buffer was written.
    step: Option<u64>,
}

impl Moments {
    /// Positions as they are now (m). What was given before stays as it was: a buffer is written again only where no array shows
    /// it any more, and otherwise another one is taken.
    pub fn now(&mut self, scene: &Scene, garment: usize) -> toile_sdk::Result<Arc<Vec<Vec3>>> {
        if self.step == Some(scene.steps())
            && let Some(shown) = self.buffers.last()
        {
            return Ok(Arc::clone(shown));
        }
        self.step = None;
        let unseen = self.buffers.iter_mut().position(|buffer| Arc::get_mut(buffer).is_some());
        let mut buffer = match unseen {
            Some(at) => self.buffers.remove(at),
            None => Arc::default(),
        };
        if self.buffers.len() == MOST_BUFFERS {
            self.buffers.remove(0);
        }
        match Arc::get_mut(&mut buffer).filter(|to| !to.is_empty()) {
            Some(to) => scene.read_positions(garment, to)?,
            None => buffer = Arc::new(scene.positions(garment)?),
        }
        self.step = Some(scene.steps());
        self.buffers.push(Arc::clone(&buffer));
        Ok(buffer)
    }
}
