//! Trousers: after the usual trouser block, two panels a leg.
//!
//! Drawn from the lower edge of the waistband: y = 0 there, x = 0 where the middle of front or back meets the hip.

use super::block::{BAND_M, DraftBlock};
use super::dart::WaistQuarter;
use super::garment::DraftGarment;
use super::panel::{DraftPanel, DraftSide, Outline, at};
use super::trims;
use super::waistband::{self, WAIST_EASE_M};

/// How trousers are cut.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TrouserStyle {
    /// What they are wider than the hip (m).
    pub hip_ease: f64,
    /// How far below the crotch their own lies (m).
    pub rise_ease: f64,
    /// Girth of a leg at the knee (part of the hip's).
    pub knee: f64,
    /// Girth at the hem (part of the hip's).
    pub hem: f64,
    /// From the waist to the hem (part of the way to the floor); shorts end above the knee.
    pub length: f64,
}

/// How far the crotch reaches beyond the middle in front and behind (part of the hip's girth).
const CROTCH: [f64; 2] = [0.055, 0.12];

/// How much wider the back is than the front at hip, knee and hem (m).
const BACK_M: f64 = 0.01;

/// How far the middle leans at the waist, and how much higher it is there, in front and behind (m).
const LEAN_M: [f64; 2] = [0.006, 0.022];
const HIGHER_M: [f64; 2] = [0.0, 0.016];

/// Lengths of the darts in front and behind (part of the way from waist to hip).
const DARTS: [f64; 2] = [0.35, 0.55];

/// Trousers or shorts.
pub fn trousers(block: &DraftBlock, style: &TrouserStyle) -> DraftGarment {
    let [front, back] = [0, 1].map(|side| leg(block, style, side));
    let mut garment = DraftGarment::of([
        back.mirrored("left back", DraftSide::Back),
        front.clone(),
        back,
        front.mirrored("right front", DraftSide::Front),
    ]);
    for (front, back, half) in [("left front", "left back", "left"), ("right front", "right back", "right")] {
        for edge in ["outseam", "hip", "inseam"] {
            let edge = format!("{half} {edge}");
            garment.sew((front, &edge), (back, &edge));
        }
        if !is_short(block, style) {
            let low = ["outseam low", "inseam low"].map(|edge| format!("{half} {edge}"));
            low.iter().for_each(|edge| garment.sew((front, edge), (back, edge)));
        }
        for panel in [front, back] {
            garment.sew((panel, &format!("{half} dart outer")), (panel, &format!("{half} dart inner")));
        }
    }
    for [left, right] in [["left front", "right front"], ["left back", "right back"]] {
        for edge in ["middle", "crotch"] {
            garment.sew((left, &format!("left {edge}")), (right, &format!("right {edge}")));
        }
    }
    let girth = block.waist + WAIST_EASE_M;
    waistband::add(&mut garment, girth, ["left front", "right front"], ["left back", "right back"]);
    garment.girths = [None, Some(girth), Some(block.hip + style.hip_ease)];
    trims::trousers(&mut garment, 0.25 * (block.hip + style.hip_ease) - BACK_M);
    garment
}

fn is_short(block: &DraftBlock, style: &TrouserStyle) -> bool {
    style.length * block.to_floor < block.to_knee + 0.05
}

/// The left front or the right back.
fn leg(block: &DraftBlock, style: &TrouserStyle, side: usize) -> DraftPanel {
    let (name, half, at_side) =
        [("left front", "left", DraftSide::Front), ("right back", "right", DraftSide::Back)][side];
    let label = |what: &str| format!("{half} {what}");
    let wider = [-BACK_M, BACK_M][side];
    let hip = [0.25 * (block.hip + style.hip_ease) + wider, block.to_hip - BAND_M];
    let crotch = at(-CROTCH[side] * block.hip, BAND_M - block.to_crotch - style.rise_ease);
    let [knee, hem] = [style.knee, style.hem].map(|part| 0.25 * part * block.hip + 0.5 * wider);
    let (down, at_knee) = (BAND_M - style.length * block.to_floor, BAND_M - block.to_knee);
    // The crease runs midway between the crotch's point and the hip's side.
    let crease = 0.5 * (hip[0] + crotch.x);
    let side_hip = at(hip[0], -hip[1]);
    let outline = Outline::from(at(crease - hem, down)).line(&label("hem"), at(crease + hem, down));
    let outline = if is_short(block, style) {
        outline.line(&label("outseam"), side_hip)
    } else {
        let outer = at(crease + knee, at_knee);
        let controls = [
            at(outer.x, outer.y + 0.45 * (side_hip.y - outer.y)),
            at(hip[0], side_hip.y - 0.35 * (side_hip.y - outer.y)),
        ];
        outline.line(&label("outseam low"), outer).curve(&label("outseam"), controls, side_hip)
    };
    let quarter = WaistQuarter {
        middle: [LEAN_M[side], HIGHER_M[side]],
        waist: 0.25 * (block.below_waist + WAIST_EASE_M),
        hip,
        dart: DARTS[side] * block.to_hip,
    };
    let (turn, drop) = (at(0.0, -0.92 * hip[1]), crotch.y + 0.92 * hip[1]);
    let outline = quarter.draw(outline, half).line(&label("middle"), turn).curve(
        &label("crotch"),
        [at(0.0, turn.y + 0.75 * drop), at(0.45 * crotch.x, crotch.y)],
        crotch,
    );
    let inner = at(crease - hem, down);
    let outline = if is_short(block, style) {
        outline.line(&label("inseam"), inner)
    } else {
        let knee = at(crease - knee, at_knee);
        let controls =
            [crotch + (knee - crotch) * 0.3 + at(0.012, 0.0), at(knee.x, knee.y + 0.35 * (crotch.y - knee.y))];
        outline.curve(&label("inseam"), controls, knee).line(&label("inseam low"), inner)
    };
    outline.panel(name, at_side)
}
