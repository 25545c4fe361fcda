//! The garments that are stepped together, with the surroundings of each.

use toile_base::garment::Garment;
use toile_engine::cloth::{Cloth, Step};

/// Garments that are stepped together.
#[derive(Debug)]
pub struct ClothBatch<'a, 'b> {
    /// States of the garments.
    pub cloths: &'a mut [Cloth],
    /// Their baked garments `[cloths]`.
    pub garments: &'a [&'b Garment],
    /// Their surroundings `[cloths]`; the settings are those of the first.
    pub steps: &'a [Step<'b>],
}
