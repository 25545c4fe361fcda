//! Darts at a waist, and the side's curve: what a panel is wider at the hip than above.

use super::panel::{Outline, at};

/// Least width of a dart (m): sizes whose hip is hardly wider than the waist keep it, so that all sizes have the same edges.
const LEAST_M: f64 = 0.008;

/// The part of the difference that the side's curve takes (1), as in the usual skirt block; the dart takes the rest.
const SIDE: f64 = 0.5;

/// How far the waist rises towards the side (m).
const RISE_M: f64 = 0.008;

/// A quarter of a waist: half girths of it and of the hip (m), and how the dart lies.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WaistQuarter {
    /// Where the waist begins in the middle (m), and how high (m).
    pub middle: [f64; 2],
    /// A quarter of the waist's finished girth (m).
    pub waist: f64,
    /// Where the hip's side lies (m), and how far below the waist (m).
    pub hip: [f64; 2],
    /// Length of the dart (m).
    pub dart: f64,
}

impl WaistQuarter {
    /// Goes on from the hip's side over the side, the waist with its dart, to the middle.
    pub fn draw(&self, outline: Outline, half: &str) -> Outline {
        let name = |what: &str| format!("{half} {what}");
        let [middle, up] = self.middle;
        let spare = (self.hip[0] - middle - self.waist) * (1.0 - SIDE);
        let width = spare.max(LEAST_M);
        let (top, low) = (at(middle + self.waist + width, RISE_M), at(self.hip[0], -self.hip[1]));
        let [inner, outer] =
            [0.55 * self.waist, 0.55 * self.waist + width].map(|x| at(middle + x, 0.3 * RISE_M + 0.45 * up));
        let tip = at(0.5 * (inner.x + outer.x), inner.y - self.dart);
        let lean = top.x - low.x;
        outline
            .curve(&name("hip"), [at(low.x, 0.6 * low.y), at(top.x - 0.35 * lean, 0.3 * low.y)], top)
            .line(&name("top side"), outer)
            .line(&name("dart outer"), tip)
            .line(&name("dart inner"), inner)
            .line(&name("top middle"), at(middle, up))
    }
}
