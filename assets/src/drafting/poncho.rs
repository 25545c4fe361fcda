//! A poncho: two panels sewn over shoulders and arms, open at the sides.

use super::block::DraftBlock;
use super::bodice::SLOPE;
use super::garment::DraftGarment;
use super::panel::{DraftPanel, DraftSide, Outline, at};

/// How much wider the neck is than the body's, each side (m), and how deep in front and behind (m).
const NECK_WIDER_M: f64 = 0.03;
const NECK_M: [f64; 2] = [0.09, 0.02];

/// From the neck's point to the hem in the middle (part of stature).
const LENGTH: f64 = 0.36;

/// How far it reaches over an arm beyond the shoulder's tip (part of the arm).
const OVER_ARM: f64 = 0.42;

/// How far its side falls from there before the hem begins (m): a sharp corner would hang on the elbow.
const CUFF_M: f64 = 0.12;

/// A poncho.
pub fn poncho(block: &DraftBlock) -> DraftGarment {
    let mut garment = DraftGarment::of([panel(block, 1), panel(block, 0)]);
    garment.sew_alike("front", "back", &["left shoulder", "right shoulder"]);
    garment.sew_alike("front", "back", &["left arm", "right arm"]);
    // It is as wide as the arms are long; what it leaves the chest is the same in all sizes.
    garment.girths = [Some(block.chest + 2.0 * OVER_ARM * block.arm), None, None];
    garment
}

fn panel(block: &DraftBlock, side: usize) -> DraftPanel {
    let (name, half, at_side) = [("front", "left", DraftSide::Front), ("back", "right", DraftSide::Back)][side];
    let label = |what: &str| format!("{half} {what}");
    let inner = at(block.neck + NECK_WIDER_M, -SLOPE * NECK_WIDER_M);
    let tip = at(block.shoulder, -SLOPE * (block.shoulder - block.neck));
    // Over the arm at half the slope of a lifted one.
    let out = OVER_ARM * block.arm;
    let end = tip + at(0.83, -0.56) * out;
    let (low, high) = (at(0.0, -LENGTH * block.stature), at(0.0, -NECK_M[side]));
    Outline::from(low)
        .curve(&label("hem"), [at(0.6 * end.x, low.y), at(end.x, 0.5 * (low.y + end.y) - 0.1)], end - at(0.0, CUFF_M))
        .line(&label("cuff"), end)
        .line(&label("arm"), tip)
        .line(&label("shoulder"), inner)
        .bow(&label("neck"), at(0.85 * inner.x, high.y), high)
        .on_the_fold(name, at_side)
}
