//! Garments that hang from the shoulders: tees, jumpers, shirts, dresses, jackets, coats.

use super::block::DraftBlock;
use super::bodice::BodiceStyle;
use super::collar;
use super::garment::DraftGarment;
use super::panel::DraftSide;
use super::sleeve::{self, SleeveStyle};
use super::trims;

/// Sides and shoulders of a front and a back in one panel each.
fn closed(block: &DraftBlock, style: &BodiceStyle) -> DraftGarment {
    let mut garment = DraftGarment::of([style.back(block), style.front(block)]);
    sides(&mut garment, ["front"; 2]);
    garment.girths = style.girths(block);
    garment
}

/// The same with a front in two panels; down the middle they are not sewn yet.
fn in_halves(block: &DraftBlock, style: &BodiceStyle, open: Option<f64>) -> DraftGarment {
    let left = style.left_front(block, open);
    let right = left.mirrored("right front", DraftSide::Front);
    let mut garment = DraftGarment::of([style.back(block), left, right]);
    sides(&mut garment, FRONTS);
    garment.girths = style.girths(block);
    garment
}

/// The panels of a front in two.
const FRONTS: [&str; 2] = ["left front", "right front"];

/// Sews sides and shoulders.
pub fn sides(garment: &mut DraftGarment, fronts: [&'static str; 2]) {
    for (front, side) in fronts.into_iter().zip(["left", "right"]) {
        for edge in ["side below", "side", "side above", "shoulder"] {
            let edge = format!("{side} {edge}");
            // Straight sides are one edge, shaped ones up to three.
            if garment.length(&(front, edge.clone())) > 0.0 {
                garment.sew((front, &edge), ("back", &edge));
            }
        }
    }
}

/// A garment with sleeves and a front in one panel.
pub fn pullover(block: &DraftBlock, style: &BodiceStyle, sleeve: &SleeveStyle) -> DraftGarment {
    let mut garment = closed(block, style);
    sleeve::set_in(&mut garment, sleeve, ["front"; 2], "back");
    garment
}

/// The same with buttons down to the waist.
pub fn blouse(block: &DraftBlock, style: &BodiceStyle, sleeve: &SleeveStyle) -> DraftGarment {
    let mut garment = pullover(block, style, sleeve);
    trims::blouse(&mut garment, block, style);
    garment
}

/// A garment without sleeves, with a zip in its back.
pub fn zipped(block: &DraftBlock, style: &BodiceStyle) -> DraftGarment {
    let mut garment = closed(block, style);
    trims::dress_zip(&mut garment, block, style);
    garment
}

/// A shirt: closed down the front by a seam, with a stand around the neck.
pub fn shirt(block: &DraftBlock, style: &BodiceStyle, sleeve: &SleeveStyle) -> DraftGarment {
    let mut garment = in_halves(block, style, None);
    sleeve::set_in(&mut garment, sleeve, FRONTS, "back");
    garment.sew((FRONTS[0], "middle"), (FRONTS[1], "middle"));
    collar::stand(&mut garment, FRONTS, "back");
    trims::shirt(&mut garment, block, style);
    garment
}

/// How far below the waist the lowest button of a jacket is (m).
const BUTTON_M: f64 = 0.03;

/// A jacket or coat, its front in two panels, closed down to the lowest of so many buttons: a seam holds it there.
pub fn jacket(block: &DraftBlock, style: &BodiceStyle, sleeve: &SleeveStyle, buttons: usize) -> DraftGarment {
    let open = block.to_waist + BUTTON_M;
    let mut garment = in_halves(block, style, Some(open));
    sleeve::set_in(&mut garment, sleeve, FRONTS, "back");
    garment.sew((FRONTS[0], "middle"), (FRONTS[1], "middle"));
    trims::jacket(&mut garment, block, style, open, buttons);
    garment
}
