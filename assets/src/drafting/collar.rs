//! Collars: a stand of three panels around the neck.

use super::garment::DraftGarment;
use super::panel::{DraftPanel, DraftSide, Outline, at};

/// Height of a stand (m).
const STAND_M: f64 = 0.038;

/// How much shorter its upper edge is (1): necks narrow upwards.
const CLOSER: f64 = 0.93;

/// Adds a stand to fronts in two panels and a back, closed in front where the fronts are.
pub fn stand(garment: &mut DraftGarment, fronts: [&'static str; 2], back: &'static str) {
    band(garment, fronts, back, [STAND_M, CLOSER]);
}

/// The same so high (m), its upper edge so many times as long as its lower one.
pub fn band(garment: &mut DraftGarment, fronts: [&'static str; 2], back: &'static str, [high, closer]: [f64; 2]) {
    let [before, behind] =
        [(fronts[0], "left neck"), (back, "left neck")].map(|(p, e)| garment.length(&(p, e.to_owned())));
    let left = left(before, [high, closer]);
    garment.panels.push(left.mirrored("right collar", DraftSide::Front));
    garment.panels.push(left);
    let half =
        Outline::from(at(0.0, 0.0)).line("right low", at(behind, 0.0)).line("right end", at(closer * behind, high));
    garment.panels.push(half.line("right top", at(0.0, high)).on_the_fold("back collar", DraftSide::Back));
    for (side, front, collar) in [("left", fronts[0], "left collar"), ("right", fronts[1], "right collar")] {
        let [neck, low, end] = ["neck", "low", "end"].map(|edge| format!("{side} {edge}"));
        garment.sew((front, &neck), (collar, &low));
        garment.sew((back, &neck), ("back collar", &low));
        garment.sew((collar, &end), ("back collar", &end));
    }
    garment.sew(("left collar", "middle"), ("right collar", "middle"));
}

fn left(length: f64, [high, closer]: [f64; 2]) -> DraftPanel {
    Outline::from(at(0.0, 0.0))
        .line("left low", at(length, 0.0))
        .line("left end", at(closer * length, high))
        .line("left top", at(0.0, high))
        .line("middle", at(0.0, 0.0))
        .panel("left collar", DraftSide::Front)
}
