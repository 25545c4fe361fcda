//! Skirts: after the straight skirt block with darts, and of two half circles.

use std::f64::consts::TAU;

use glam::DVec2;

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

/// A skirt of two half circles: its waist is a whole circle's girth.
pub fn circle(block: &DraftBlock) -> DraftGarment {
    let inner = (block.below_waist + WAIST_EASE_M) / TAU;
    let outer = inner + CIRCLE_LENGTH * block.to_knee - BAND_M;
    let half = |name, own, side| part_of_a_circle(name, own, side, [inner, outer], [0.25 * TAU, 0.5]);
    let mut garment =
        DraftGarment::of([half("front", "left", DraftSide::Front), half("back", "right", DraftSide::Back)]);
    garment.sew_alike("front", "back", &["left side", "right side"]);
    finished(garment, block, None, -inner)
}

/// A panel between two circles around (0, 0), cut on the fold: radii of its waist and its hem (m); the angle of each half (rad),
/// and the part of it at which `top middle` becomes `top side`.
pub fn part_of_a_circle(
    name: &'static str,
    half: &str,
    side: DraftSide,
    [inner, outer]: [f64; 2],
    [angle, split]: [f64; 2],
) -> DraftPanel {
    let label = |what: &str| format!("{half} {what}");
    let [waist, hem] = [inner, outer].map(|radius| move |from, to| arc(radius, [from, to]));
    Outline::from(at(0.0, -outer))
        .curve(&label("hem"), hem(0.0, angle).0, hem(0.0, angle).1)
        .line(&label("side"), on_circle(inner, angle))
        .curve(&label("top side"), waist(angle, split * angle).0, waist(angle, split * angle).1)
        .curve(&label("top middle"), waist(split * angle, 0.0).0, waist(split * angle, 0.0).1)
        .on_the_fold(name, side)
}

/// The point of a circle around (0, 0) at an angle from below (rad).
fn on_circle(radius: f64, angle: f64) -> DVec2 {
    radius * at(angle.sin(), -angle.cos())
}

/// Control points of an arc from one angle to another, a quarter of a turn at most, and its end: off the circle by 3e-4 of the
/// radius at most.
fn arc(radius: f64, [from, to]: [f64; 2]) -> ([DVec2; 2], DVec2) {
    let reach = radius * (4.0 / 3.0) * (0.25 * (to - from)).tan();
    let along = |angle: f64| at(angle.cos(), angle.sin());
    let [start, end] = [from, to].map(|angle| on_circle(radius, angle));
    ([start + reach * along(from), end - reach * along(to)], end)
}
