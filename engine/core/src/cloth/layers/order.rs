//! Wearing order: which garment lies over which.

use toile_assets::garment::Garment;

/// Which garment lies over which: indices of the garments from the innermost outwards, by their layers, and where these are
/// the same, in the order in which they are worn.
pub fn wearing_order(garments: &[Garment]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..garments.len()).collect();
    order.sort_by_key(|&g| garments[g].layer);
    order
}
