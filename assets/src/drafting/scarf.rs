//! A scarf: a loop around the neck whose ends hang down in front.
//!
//! It is cut as it lies when it has been wound around the neck once: a soft band that stands around the neck, a part over the
//! shoulders that carries it, and two ends of unequal length.

use super::block::DraftBlock;
use super::bodice::SLOPE;
use super::collar;
use super::garment::DraftGarment;
use super::panel::{DraftPanel, DraftSide, Outline, at};

/// How much wider the neck is than the body's, each side (m), and how deep in front and behind (m).
const NECK_WIDER_M: f64 = 0.034;
const NECK_M: [f64; 2] = [0.085, 0.028];

/// How far it lies over the shoulder beyond that (m): short of the shoulder's tip in every size.
const OVER_SHOULDER_M: f64 = 0.05;

/// How far it hangs down behind below the neck (m).
const BEHIND_M: f64 = 0.085;

/// How far down its ends lie one on the other in front, below the neck (m): a seam holds them there.
const KNOT_M: f64 = 0.1;

/// Width of one of the ends at the knot, and at its hem (m).
const END_M: [f64; 2] = [0.09, 0.13];

/// Lengths of the left and the right end below the neck's point (part of stature).
const ENDS: [f64; 2] = [0.335, 0.285];

/// Height of the band around the neck (m), and how much longer its upper edge is (1): it sinks into folds.
const BAND: [f64; 2] = [0.095, 1.12];

/// What it leaves the chest (m), in every size alike: its size goes by the chest as a coat's does.
const CHEST_EASE_M: f64 = 0.4;

/// A scarf.
pub fn scarf(block: &DraftBlock) -> DraftGarment {
    let [left, right] = ENDS.map(|part| end(block, part * block.stature));
    let mut garment = DraftGarment::of([behind(block), left, right.mirrored("right front", DraftSide::Front)]);
    for (front, side) in [("left front", "left"), ("right front", "right")] {
        let shoulder = format!("{side} shoulder");
        garment.sew((front, &shoulder), ("back", &shoulder));
    }
    garment.sew(("left front", "middle"), ("right front", "middle"));
    collar::band(&mut garment, ["left front", "right front"], "back", BAND);
    garment.girths = [Some(block.chest + CHEST_EASE_M), None, None];
    garment
}

/// Where it leaves the neck on the shoulder, and how far it lies over that.
fn shoulder(block: &DraftBlock) -> [glam::DVec2; 2] {
    [0.0, OVER_SHOULDER_M].map(|out| NECK_WIDER_M + out).map(|out| at(block.neck + out, -SLOPE * out))
}

fn behind(block: &DraftBlock) -> DraftPanel {
    let [inner, outer] = shoulder(block);
    let [high, low] = [NECK_M[1], NECK_M[1] + BEHIND_M].map(|depth| at(0.0, -depth));
    Outline::from(low)
        .curve("right hem", [at(0.6 * outer.x, low.y), at(outer.x, 0.5 * (low.y + outer.y))], outer)
        .line("right shoulder", inner)
        .bow("right neck", at(0.85 * inner.x, high.y), high)
        .on_the_fold("back", DraftSide::Back)
}

/// The left end, so long.
fn end(block: &DraftBlock, length: f64) -> DraftPanel {
    let [inner, outer] = shoulder(block);
    let high = at(0.0, -NECK_M[0]);
    let knot = high - at(0.0, KNOT_M);
    let low = at(0.008, -length);
    let [tied, out] = [at(END_M[0], knot.y), at(low.x + END_M[1], low.y)];
    Outline::from(low)
        .line("left hem", out)
        .line("left side", tied)
        .curve("left fold", [tied + at(0.0, 0.04), outer - at(0.0, 0.05)], outer)
        .line("left shoulder", inner)
        .bow("left neck", at(0.9 * inner.x, high.y), high)
        .line("middle", knot)
        .line("left edge", low)
        .panel("left front", DraftSide::Front)
}
