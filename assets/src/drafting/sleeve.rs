//! Set-in sleeves: a cap as high as a part of the armhole, and as wide as it takes to be as long as it.

use super::garment::DraftGarment;
use super::panel::{DraftPanel, DraftSide, Outline, at};

/// How a sleeve is cut.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SleeveStyle {
    /// Height of the cap (part of the armhole's whole length): a third in a jacket, a quarter or less where arms are lifted.
    pub cap: f64,
    /// How much longer the cap is than the armhole (1).
    pub cap_ease: f64,
    /// From the shoulder's tip to the hem (m).
    pub length: f64,
    /// Girth of the hem (m), at most that of the sleeve at the underarm.
    pub hem: f64,
}

/// Steps in which the width of a cap is looked for: to a hundredth of a millimetre.
const STEPS: usize = 24;

/// The outline of a left sleeve between given half widths, in front and behind.
fn drawn(style: &SleeveStyle, height: f64, [front, back]: [f64; 2]) -> DraftPanel {
    let low = -(style.length - height).max(0.02);
    // Both sides taper alike, so that the underarm's edges are as long as each other.
    let taper = (0.5 * (front + back - style.hem)).max(0.0);
    let top = at(0.0, height);
    Outline::from(at(taper - front, low))
        .line("hem", at(back - taper, low))
        .line("back underarm", at(back, 0.0))
        .curve("back cap", [at(0.55 * back, 0.0), at(0.5 * back, height)], top)
        .curve("front cap", [at(-0.5 * front, height), at(-0.55 * front, 0.0)], at(-front, 0.0))
        .line("front underarm", at(taper - front, low))
        .panel("left sleeve", DraftSide::LeftArm)
}

/// The left sleeve for armholes of these lengths in front and behind (m).
pub fn left(style: &SleeveStyle, armholes: [f64; 2]) -> DraftPanel {
    let height = style.cap * (armholes[0] + armholes[1]);
    let wanted = armholes.map(|length| length * (1.0 + style.cap_ease));
    let width = |side: usize| {
        let label = ["front cap", "back cap"][side];
        let (mut low, mut high) = (0.01, wanted[side]);
        for _ in 0..STEPS {
            let middle = 0.5 * (low + high);
            let long = drawn(style, height, [middle; 2]).length(label) > wanted[side];
            if long { high = middle } else { low = middle }
        }
        0.5 * (low + high)
    };
    drawn(style, height, [width(0), width(1)])
}

/// Adds both sleeves to a garment whose armholes are called so on its front and back panels, and sews them in.
pub fn set_in(garment: &mut DraftGarment, style: &SleeveStyle, fronts: [&'static str; 2], back: &'static str) {
    let armholes = [(fronts[0], "left armhole"), (back, "left armhole")]
        .map(|(panel, label)| garment.length(&(panel, label.to_owned())));
    let sleeve = left(style, armholes);
    garment.panels.push(sleeve.mirrored("right sleeve", DraftSide::RightArm));
    garment.panels.push(sleeve);
    for (side, name, front) in [("left", "left sleeve", fronts[0]), ("right", "right sleeve", fronts[1])] {
        let hole = format!("{side} armhole");
        garment.sew((front, &hole), (name, "front cap"));
        garment.sew((back, &hole), (name, "back cap"));
        garment.sew((name, "front underarm"), (name, "back underarm"));
    }
}
