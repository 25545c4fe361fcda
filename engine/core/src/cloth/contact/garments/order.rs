//! Wearing order: which garment lies over which.

use toile_base::garment::Garment;

/// Which garment lies over which: indices of the garments from the innermost outwards, by their layers, and where these are
/// the same, in the order in which they are worn.
pub fn wearing_order(garments: &[Garment]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..garments.len()).collect();
    order.sort_by_key(|&g| garments[g].layer);
    order
}

/// How high each garment lies: one more than the highest that lies under it and may meet it; 0 is on nothing but the body.
pub fn heights(order: &[usize], meet: impl Fn(usize, usize) -> bool) -> Vec<usize> {
    let mut height = vec![0; order.len()];
    for (k, &outer) in order.iter().enumerate() {
        let under = order[..k].iter().filter(|&&inner| meet(inner, outer));
        height[outer] = under.map(|&inner| height[inner] + 1).max().unwrap_or(0);
    }
    height
}
