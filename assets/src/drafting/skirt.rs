//! Skirts: after the straight skirt block with darts, and of two half circles.

use std::f64::consts::TAU;

use super::block::{BAND_M, DraftBlock};
use super::dart::WaistQuarter;
use super::garment::DraftGarment;
use super::panel::{DraftPanel, DraftSide, Outline, at};
use super::trims;
use super::waistband::{self, WAIST_EASE_M};

/// How a straight skirt is cut.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SkirtStyle {
    /// What it is wider than the hip (m).
    pub hip_ease: f64,
    /// From the waist to the hem (part of the way to the knee).
    pub length: f64,
    /// How much wider the hem is than the hip, each of four times (m); negative of a pencil skirt.
    pub flare: f64,
}

/// Lengths of the darts in front and behind (part of the way from waist to hip).
const DARTS: [f64; 2] = [0.4, 0.6];

/// A straight skirt.
pub fn straight(block: &DraftBlock, style: &SkirtStyle) -> DraftGarment {
    let mut garment = DraftGarment::of([0, 1].map(|side| panel(block, style, side)));
    for side in ["left", "right"] {
        for edge in ["side", "hip"] {
            let edge = format!("{side} {edge}");
            garment.sew(("front", &edge), ("back", &edge));
        }
        for panel in ["front", "back"] {
            garment.sew((panel, &format!("{side} dart outer")), (panel, &format!("{side} dart inner")));
        }
    }
    finished(garment, block, Some(block.hip + style.hip_ease), 0.0)
}

fn panel(block: &DraftBlock, style: &SkirtStyle, side: usize) -> DraftPanel {
    let (name, half, at_side) = [("front", "left", DraftSide::Front), ("back", "right", DraftSide::Back)][side];
    let hip = [0.25 * (block.hip + style.hip_ease), block.to_hip - BAND_M];
    let hem = at(hip[0] + style.flare, BAND_M - style.length * block.to_knee);
    let waist = 0.25 * (block.below_waist + WAIST_EASE_M);
    let quarter = WaistQuarter { middle: [0.0; 2], waist, hip, dart: DARTS[side] * block.to_hip };
    let outline = Outline::from(at(0.0, hem.y))
        .line(&format!("{half} hem"), hem)
        .line(&format!("{half} side"), at(hip[0], -hip[1]));
    quarter.draw(outline, half).on_the_fold(name, at_side)
}

/// The band, its zip below `high` (m), and what is judged.
fn finished(mut garment: DraftGarment, block: &DraftBlock, hip: Option<f64>, high: f64) -> DraftGarment {
    waistband::add(&mut garment, block.waist + WAIST_EASE_M, ["front"; 2], ["back"; 2]);
    trims::skirt_zip(&mut garment, high);
    garment.girths = [None, Some(block.waist + WAIST_EASE_M), hip];
    garment
}

/// Length of a circle skirt (part of the way from waist to knee).
const CIRCLE_LENGTH: f64 = 0.92;

/// A control point of a quarter circle lies so far along its tangent (part of the radius).
const QUARTER: f64 = 0.552_285;

/// A skirt of two half circles: its waist is a whole circle's girth.
pub fn circle(block: &DraftBlock) -> DraftGarment {
    let inner = (block.below_waist + WAIST_EASE_M) / TAU;
    let outer = inner + CIRCLE_LENGTH * block.to_knee - BAND_M;
    let eighth = std::f64::consts::FRAC_1_SQRT_2;
    let half = |name: &'static str, own: &str, side: DraftSide| {
        let label = |what: &str| format!("{own} {what}");
        let bend = inner * (4.0 / 3.0) * (TAU / 32.0).tan();
        let between = at(inner * eighth, -inner * eighth);
        Outline::from(at(0.0, -outer))
            .curve(&label("hem"), [at(QUARTER * outer, -outer), at(outer, -QUARTER * outer)], at(outer, 0.0))
            .line(&label("side"), at(inner, 0.0))
            .curve(&label("top side"), [at(inner, -bend), between + at(bend, bend) * eighth], between)
            .curve(&label("top middle"), [between - at(bend, bend) * eighth, at(bend, -inner)], at(0.0, -inner))
            .on_the_fold(name, side)
    };
    let mut garment =
        DraftGarment::of([half("front", "left", DraftSide::Front), half("back", "right", DraftSide::Back)]);
    garment.sew_alike("front", "back", &["left side", "right side"]);
    finished(garment, block, None, -inner)
}
