//! The sun dress: a bodice on straps with darts to the waist, and a skirt of a part of a circle sewn to it.

use glam::DVec2;

use super::block::DraftBlock;
use super::bodice::{BodiceStyle, FORWARD_M};
use super::garment::DraftGarment;
use super::panel::{DraftPanel, DraftSide, Outline, at};
use super::{skirt, tops, trims};

/// How a dress is cut.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DressStyle {
    /// Its bodice; that ends at the waist.
    pub bodice: BodiceStyle,
    /// Ease at the waist's seam (m).
    pub waist_ease: f64,
    /// Length of the skirt (part of the way from the waist to the knee).
    pub length: f64,
    /// What its four quarters take of a circle, each (rad): a quarter of a turn makes it a full circle.
    pub quarter: f64,
}

/// The part of what a bodice is narrower at the waist than at the chest that its side takes (1); a dart takes the rest.
const SIDE: f64 = 0.35;

/// Least width of a dart (m): sizes that are hardly narrower at the waist have the same edges as the others.
const LEAST_M: f64 = 0.008;

/// How far from the middle a dart lies (part of the waist's quarter), and how far below the underarm it ends, in front and
/// behind (m).
const DART: f64 = 0.48;
const BELOW_UNDERARM_M: [f64; 2] = [0.08, 0.06];

/// How far below the underarm the bust dart begins, and how far from the other dart's tip it ends (m).
const UNDER_BUST_DART_M: f64 = 0.05;
const FROM_TIP_M: f64 = 0.035;

/// Panels of the bodice and of the skirt, in front and behind, and the half of each that is drawn.
const PANELS: [(&str, &str, &str, DraftSide); 2] =
    [("front", "front skirt", "left", DraftSide::Front), ("back", "back skirt", "right", DraftSide::Back)];

/// A dress with a seam at the waist and buttons down to it.
pub fn dress(block: &DraftBlock, style: &DressStyle) -> DraftGarment {
    let inner = (block.waist + style.waist_ease) / (4.0 * style.quarter);
    let outer = inner + style.length * block.to_knee;
    let mut garment = DraftGarment::of([1, 0].map(|side| bodice(block, style, side)));
    for (bodice, below, half, side) in PANELS {
        let length = |what: &str| garment.length(&(bodice, format!("{half} low {what}")));
        let split = length("middle") / (length("middle") + length("side"));
        garment.panels.push(skirt::part_of_a_circle(below, half, side, [inner, outer], [style.quarter, split]));
    }
    tops::sides(&mut garment, ["front"; 2]);
    garment.sew_alike(PANELS[0].1, PANELS[1].1, &["left side", "right side"]);
    for own in ["left", "right"] {
        garment.sew(("front", &format!("{own} bust dart low")), ("front", &format!("{own} bust dart high")));
        for (bodice, below, ..) in PANELS {
            garment.sew((bodice, &format!("{own} dart outer")), (bodice, &format!("{own} dart inner")));
            for what in ["middle", "side"] {
                garment.sew((bodice, &format!("{own} low {what}")), (below, &format!("{own} top {what}")));
            }
        }
    }
    let hip = 4.0 * style.quarter * (inner + block.neck_to_hip - block.to_waist);
    garment.girths = [Some(block.chest + style.bodice.chest_ease), Some(block.waist + style.waist_ease), Some(hip)];
    trims::blouse(&mut garment, block, &style.bodice);
    garment
}

/// The side of the bodice: where the waist's seam meets it, and the underarm.
fn side_line(block: &DraftBlock, style: &DressStyle, side: usize) -> [DVec2; 2] {
    let [low, _] = style.bodice.middle(block, side);
    let depth = style.bodice.underarm(block);
    let underarm = at(style.bodice.half_width(block, depth, side), -depth);
    let waist = quarter(block, style, side);
    [at(waist + dart_width(underarm.x - waist), low.y), underarm]
}

/// A quarter of the waist's finished girth (m).
fn quarter(block: &DraftBlock, style: &DressStyle, side: usize) -> f64 {
    0.25 * (block.waist + style.waist_ease) + [FORWARD_M, -FORWARD_M][side]
}

/// Width of the dart (m), by how much narrower the waist's quarter is than the chest's (m).
fn dart_width(spare: f64) -> f64 {
    ((1.0 - SIDE) * spare).max(LEAST_M)
}

/// The front (`side` 0) or the back (1) of the bodice.
fn bodice(block: &DraftBlock, style: &DressStyle, side: usize) -> DraftPanel {
    let (name, _, half, at_side) = PANELS[side];
    let edge = |what: &str| format!("{half} {what}");
    let [low, high] = style.bodice.middle(block, side);
    let waist = quarter(block, style, side);
    let [end, underarm] = side_line(block, style, side);
    let [inner, outer] = [0.0, end.x - waist].map(|x| at(DART * waist + x, low.y));
    let tip = at(0.5 * (inner.x + outer.x), underarm.y - BELOW_UNDERARM_M[side]);
    let outline = Outline::from(low)
        .line(&edge("low middle"), inner)
        .line(&edge("dart inner"), tip)
        .line(&edge("dart outer"), outer)
        .line(&edge("low side"), end);
    // In front the side is longer by what the bust takes up: a dart takes that out again.
    let (length, [behind_end, behind_underarm]) = (end.distance(underarm), side_line(block, style, 1));
    let spare = length - behind_end.distance(behind_underarm);
    let below = |m: f64| underarm.lerp(end, m / length);
    let outline = outline.line(&edge("side"), below(UNDER_BUST_DART_M + spare));
    let outline = match side {
        0 => {
            let mouth = [UNDER_BUST_DART_M + spare, UNDER_BUST_DART_M].map(below);
            let bust = bust_dart_tip(mouth, tip.x + FROM_TIP_M);
            outline.line(&edge("bust dart low"), bust).line(&edge("bust dart high"), mouth[1])
        }
        _ => outline,
    };
    style.bodice.above(block, side, outline.line(&edge("side above"), underarm), high).on_the_fold(name, at_side)
}

/// The point at so much x (m) that is equally far from both ends of a dart's mouth.
fn bust_dart_tip([low, high]: [DVec2; 2], x: f64) -> DVec2 {
    let inwards = (high - low).normalize_or_zero().perp();
    let middle = 0.5 * (low + high);
    middle + inwards * ((x - middle.x) / inwards.x)
}
