//! Waistbands: shaped bands of two panels, as wide below as what is sewn to them and closer at the waist.

use super::block::BAND_M;
use super::garment::DraftGarment;
use super::panel::{DraftPanel, DraftSide, Outline, at};

/// What a waistband is wider than the waist (m): the cloth's distance from the skin all around, and no more.
pub const WAIST_EASE_M: f64 = 0.015;

/// The half of a band: lengths of its lower edge from the middle to the side (m), and of its upper edge.
fn band(name: &'static str, side: DraftSide, half: &str, lower: [f64; 2], upper: f64) -> DraftPanel {
    let end = lower[0] + lower[1];
    Outline::from(at(0.0, 0.0))
        .line(&format!("{half} low middle"), at(lower[0], 0.0))
        .line(&format!("{half} low side"), at(end, 0.0))
        .line(&format!("{half} end"), at(upper, BAND_M))
        .line(&format!("{half} top"), at(0.0, BAND_M))
        .on_the_fold(name, side)
}

/// Adds a band to panels whose upper edges are `top middle` and `top side`: the panels that have the left and right half of the
/// front, then those of the back. `girth` is that of its upper edge (m).
pub fn add(garment: &mut DraftGarment, girth: f64, fronts: [&'static str; 2], backs: [&'static str; 2]) {
    let upper = 0.25 * girth;
    for (name, side, half, panels) in
        [("front band", DraftSide::Front, "left", fronts), ("back band", DraftSide::Back, "right", backs)]
    {
        let of = |what: &str| {
            let own = panels[usize::from(half == "right")];
            garment.length(&(own, format!("{half} top {what}")))
        };
        garment.panels.push(band(name, side, half, [of("middle"), of("side")], upper));
        for (panel, own) in panels.into_iter().zip(["left", "right"]) {
            for what in ["middle", "side"] {
                garment.sew((panel, &format!("{own} top {what}")), (name, &format!("{own} low {what}")));
            }
        }
    }
    garment.sew_alike("front band", "back band", &["left end", "right end"]);
}
