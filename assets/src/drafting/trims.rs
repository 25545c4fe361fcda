//! Trims of drafted panels: plackets and buttons, lapels, pockets, flies, zips, belt loops, cuffs.

use glam::DVec2;

use super::block::{BAND_M, DraftBlock};
use super::bodice::BodiceStyle;
use super::garment::DraftGarment;
use super::panel::{across, at};
use crate::pattern::Trim;
use toile_base::garment::trim::TrimKind;

/// Colours of buttons and zips (sRGB).
const PEARL: [f32; 3] = [0.9, 0.88, 0.83];
const HORN: [f32; 3] = [0.25, 0.18, 0.12];
const METAL: [f32; 3] = [0.42, 0.42, 0.43];

/// Radius of a shirt's, a jacket's and a coat's buttons (m): lines 18, 32 and 44.
const SHIRT_BUTTON_M: f64 = 0.0058;
const JACKET_BUTTON_M: f64 = 0.0102;
const COAT_BUTTON_M: f64 = 0.014;

/// Half the width of a placket (m).
const PLACKET_M: f64 = 0.016;

/// Width of a shirt's cuff (m).
const CUFF_M: f64 = 0.06;

/// How far one front of a jacket lies over the other (m).
const LAP_M: f64 = 0.02;

/// Length of a zip (m).
const ZIP_M: f64 = 0.17;

/// Width of a lapel's cloth within which seams are hidden (m).
const PLY_M: f64 = 0.03;

fn button(p: DVec2, radius: f64, colour: [f32; 3]) -> Trim {
    Trim { kind: TrimKind::Button, ends: [p, p + at(0.0, 0.001)], half: radius, colour }
}

fn strip(from: DVec2, to: DVec2, half: f64) -> Trim {
    Trim { kind: TrimKind::Strip, ends: [from, to], half, colour: PEARL }
}

fn edge(from: DVec2, to: DVec2, ply: f64) -> Trim {
    Trim { kind: TrimKind::Edge, ends: [from, to], half: ply, colour: PEARL }
}

fn stitches(from: DVec2, to: DVec2) -> Trim {
    Trim { kind: TrimKind::Stitches, ends: [from, to], half: 0.0006, colour: PEARL }
}

fn zip(from: DVec2, to: DVec2) -> Trim {
    Trim { kind: TrimKind::Zip, ends: [from, to], half: 0.005, colour: METAL }
}

/// So many points from one to another, both included.
fn along(from: DVec2, to: DVec2, count: usize) -> impl Iterator<Item = DVec2> {
    (0..count).map(move |i| from.lerp(to, i as f64 / (count - 1).max(1) as f64))
}

impl DraftGarment {
    fn put(&mut self, panel: &str, trims: impl IntoIterator<Item = Trim>) {
        if let Some(panel) = self.panels.iter_mut().find(|p| p.name == panel) {
            panel.trims.extend(trims);
        }
    }

    /// On a left panel, and in the mirror on the right one.
    fn put_both(&mut self, [left, right]: [&str; 2], trims: &[Trim]) {
        self.put(left, trims.iter().copied());
        self.put(right, trims.iter().map(across));
    }
}

/// A placket with buttons down the middle, in every panel that meets there.
fn placket(garment: &mut DraftGarment, panels: &[&str], [high, low]: [DVec2; 2], buttons: usize, gaps: [f64; 2]) {
    let ends = [high - at(0.0, gaps[0]), low + at(0.0, gaps[1])];
    let own: Vec<Trim> = along(ends[0], ends[1], buttons).map(|p| button(p, SHIRT_BUTTON_M, PEARL)).collect();
    for panel in panels {
        garment.put(panel, [strip(high, low, PLACKET_M)].into_iter().chain(own.iter().copied()));
    }
}

/// Seven buttons, a pocket on the left breast, cuffs.
pub fn shirt(garment: &mut DraftGarment, block: &DraftBlock, style: &BodiceStyle) {
    let [low, high] = style.middle(block, 0);
    placket(garment, &["left front", "right front"], [high, low], 7, [0.035, 0.13]);
    let (top, width, height) = (-style.underarm(block) + 0.02, 0.1, 0.12);
    let inner = 0.3 * block.shoulder;
    let [a, b] = [at(inner, top), at(inner + width, top)];
    let [c, d] = [b, a].map(|p| p - at(0.0, height));
    garment.put("left front", [strip(a, b, 0.011), stitches(b, c), stitches(c, d), stitches(d, a)]);
    cuffs(garment, CUFF_M);
}

/// Five buttons to the waist, for a front in one panel.
pub fn blouse(garment: &mut DraftGarment, block: &DraftBlock, style: &BodiceStyle) {
    let [_, high] = style.middle(block, 0);
    placket(garment, &["front"], [high, at(0.0, -block.to_waist)], 5, [0.025, 0.02]);
}

fn cuffs(garment: &mut DraftGarment, width: f64) {
    for name in ["left sleeve", "right sleeve"] {
        let Some(hem) = garment.panel(name).and_then(|p| p.edges.iter().find(|e| e.label == "hem")) else { continue };
        let [from, to] = [hem.curve.start(), hem.curve.end()].map(|p| p + at(0.0, 0.5 * width));
        let behind = if name == "left sleeve" { 0.86 } else { 0.14 };
        garment.put(name, [strip(from, to, 0.5 * width), button(from.lerp(to, behind), SHIRT_BUTTON_M, PEARL)]);
    }
}

/// Lapels, pockets with flaps, buttons from the break of the lapels to the lowest, `open` below the neck's point.
pub fn jacket(garment: &mut DraftGarment, block: &DraftBlock, style: &BodiceStyle, open: f64, buttons: usize) {
    let fronts = ["left front", "right front"];
    let [_, high] = style.middle(block, 0);
    let coat = style.front_neck < 0.25;
    let radius = if coat { COAT_BUTTON_M } else { JACKET_BUTTON_M };
    let ends = [high - at(0.0, radius + 0.012), at(0.0, -open + radius + 0.004)];
    let lap = edge(at(-LAP_M, high.y - LAP_M), at(-LAP_M, -open), LAP_M + 0.004);
    for panel in fronts {
        garment.put(panel, along(ends[0], ends[1], buttons).map(|p| button(p, radius, HORN)).chain([lap]));
    }
    garment.put_both(fronts, &lapel(block, style, high));
    let [inner, outer] = [0.4, 1.05].map(|part| part * block.shoulder);
    let down = -block.to_waist - if coat { 0.12 } else { 0.08 };
    garment.put_both(fronts, &[strip(at(inner, down), at(outer, down + 0.006), 0.022)]);
    if !coat {
        let breast = -style.underarm(block) + 0.015;
        garment.put(
            "left front",
            [strip(at(0.55 * block.shoulder, breast), at(0.98 * block.shoulder, breast + 0.012), 0.01)],
        );
    }
    for (name, behind) in [("left sleeve", 0.88), ("right sleeve", 0.12)] {
        let Some(hem) = garment.panel(name).and_then(|p| p.edges.iter().find(|e| e.label == "hem")) else { continue };
        let cuff = hem.curve.start().lerp(hem.curve.end(), behind);
        garment.put(name, [0.03, 0.05].map(|up| button(cuff + at(0.0, up), 0.72 * JACKET_BUTTON_M, HORN)));
    }
}

/// The left lapel and its half of the collar, from the break to the shoulder.
fn lapel(block: &DraftBlock, style: &BodiceStyle, rolls_at: DVec2) -> [Trim; 6] {
    let [inner, tip] = style.shoulder(block);
    let deep = -rolls_at.y;
    let [point, belly] = [at(0.66 * block.shoulder, -0.5 * deep), at(0.42 * block.shoulder, -0.8 * deep)];
    let [notch, collar] = [at(0.52 * block.shoulder, -0.43 * deep), at(0.68 * block.shoulder, -0.34 * deep)];
    let ends = inner.lerp(tip, 0.3);
    let gorge = at(0.62 * inner.x, -0.46 * deep);
    let start = rolls_at - at(0.0, LAP_M);
    [
        edge(start, belly, PLY_M),
        edge(belly, point, PLY_M),
        edge(point, notch, PLY_M),
        edge(notch, collar, PLY_M),
        edge(collar, ends, PLY_M),
        stitches(notch, gorge),
    ]
}

/// A fly, slanted pockets, welts behind, a button, belt loops. `hip` is the front's width
/// there, each side (m).
pub fn trousers(garment: &mut DraftGarment, hip: f64) {
    let fronts = ["left front", "right front"];
    garment.put(
        "left front",
        [stitches(at(0.034, -0.004), at(0.034, -0.12)), stitches(at(0.034, -0.12), at(0.004, -0.165))],
    );
    garment.put_both(fronts, &[edge(at(0.97 * hip, -0.15), at(0.62 * hip, -0.004), 0.0)]);
    let welt = [at(0.3 * hip, -0.075), at(0.78 * hip, -0.08)];
    let behind =
        [strip(welt[0], welt[1], 0.006), button(0.5 * (welt[0] + welt[1]) - at(0.0, 0.012), SHIRT_BUTTON_M, HORN)];
    // The back is drawn as the right one.
    garment.put_both(["right back", "left back"], &behind);
    garment.put("front band", [button(at(0.0, 0.5 * BAND_M), 1.3 * SHIRT_BUTTON_M, HORN)]);
    let loops = |x: f64| strip(at(x, 0.002), at(x, BAND_M - 0.002), 0.005);
    garment.put("front band", [-1.0, 1.0].map(|side| loops(side * 0.55 * hip)));
    garment.put("back band", [-1.0, 0.0, 1.0].map(|side| loops(side * 0.6 * hip)));
}

/// A zip down the middle of the back from `high` (m), and of the band above it.
pub fn back_zip(garment: &mut DraftGarment, high: f64, length: f64) {
    garment.put("back", [zip(at(0.0, high), at(0.0, high - length))]);
    garment.put("back band", [zip(at(0.0, 0.0), at(0.0, BAND_M - 0.006))]);
}

/// The zip of a skirt, from the lower edge of its band at `high` (m).
pub fn skirt_zip(garment: &mut DraftGarment, high: f64) {
    back_zip(garment, high, ZIP_M);
}

/// The zip of a dress, from the neck to below the waist.
pub fn dress_zip(garment: &mut DraftGarment, block: &DraftBlock, style: &BodiceStyle) {
    let [_, high] = style.middle(block, 1);
    back_zip(garment, high.y, block.to_waist + 0.12 + high.y);
}
