//! Batch: the garments of a scene and what surrounds each in a step.

use toile_assets::garment::Garment;
use toile_engine::cloth::{Cloth, Step};

/// Some garments, each with what the coming step does around it.
#[derive(Debug)]
pub struct Batch<'a, 'b> {
    /// Their states.
    pub cloths: &'a mut [Cloth],
    /// What they are made of `[cloths]`.
    pub garments: &'a [&'b Garment],
    /// Their surroundings `[cloths]`; the settings are those of the first.
    pub steps: &'a [Step<'b>],
}
