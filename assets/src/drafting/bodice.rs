//! Bodices: fronts and backs that hang from the shoulders, with their armholes and necklines.
//!
//! Drawn from the neck's point at the shoulder: y = 0 there, x = 0 in the middle.

use glam::DVec2;

use super::block::DraftBlock;
use super::panel::{DraftPanel, DraftSide, Outline, at};
use toile_base::body::Sex;

/// How a bodice is cut.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BodiceStyle {
    /// Ease at the chest (m).
    pub chest_ease: f64,
    /// The same at the hip (m); what does not reach it takes its width there from the line to it.
    pub hip_ease: f64,
    /// How much the side is taken in at the waist, each of four times (m).
    pub waist_in: f64,
    /// Length below the waist (m).
    pub below_waist: f64,
    /// How much wider the hem is than the line to the hip, each of four times (m).
    pub flare: f64,
    /// How much wider the neck is than the body's, each side (m).
    pub neck_wider: f64,
    /// How deep the neck is in front below its point at the shoulder (m).
    pub front_neck: f64,
    /// The same behind (m).
    pub back_neck: f64,
    /// How far the shoulder reaches beyond its tip, negative where it ends before (m).
    pub shoulder_out: f64,
    /// How much deeper the armhole is than the block's (m).
    pub armhole_drop: f64,
    /// How square the neck's corner is: 0 a straight line, 1 a corner.
    pub neck_square: f64,
    /// How far the armhole is hollowed inwards of the shoulder's tip, in front and behind (m).
    pub hollow: [f64; 2],
}

/// Slope of the shoulders (tangent): drawn flatter than the body's 21 degrees, so that cloth lies on at the neck.
pub const SLOPE: f64 = 0.36;

/// How much lower the hem is in the middle of the front, women's and men's (m): the bust and the belly take that up.
const DIP_M: [f64; 2] = [0.03, 0.012];

/// What ends lower than this below the waist (m) has a corner in its side at the hip, in all sizes alike.
const LONG_M: f64 = 0.3;

/// How far an open front swings back from the middle at the hem (m).
const SWING_M: f64 = 0.035;

/// How much more of the width is in front than behind, each side (m): the bust is there.
pub const FORWARD_M: f64 = 0.004;

impl BodiceStyle {
    /// Depth of the armhole's lowest point (m).
    pub fn underarm(&self, block: &DraftBlock) -> f64 {
        block.armhole + self.armhole_drop
    }

    /// Finished girths at chest, waist and hip (m).
    pub fn girths(&self, block: &DraftBlock) -> [Option<f64>; 3] {
        let hip = block.neck_to_hip;
        let reaches = self.length(block) > hip;
        let around = |depth: f64| 2.0 * (self.half_width(block, depth, 0) + self.half_width(block, depth, 1));
        [Some(block.chest + self.chest_ease), Some(around(block.to_waist)), reaches.then(|| around(hip))]
    }

    /// From the neck's point to the hem (m).
    pub fn length(&self, block: &DraftBlock) -> f64 {
        block.to_waist + self.below_waist
    }

    /// Half of the front's width (`side` 0) or the back's (1) at a depth below the armhole (m).
    pub fn half_width(&self, block: &DraftBlock, depth: f64, side: usize) -> f64 {
        let [chest, hip] = [block.chest + self.chest_ease, block.hip + self.hip_ease].map(|girth| 0.25 * girth);
        let (top, bottom) = (self.underarm(block), block.neck_to_hip);
        let part = (depth - top) / (bottom - top);
        let flare = self.flare * ((depth - top) / (self.length(block) - top)).max(0.0);
        let straight = chest + (hip - chest) * part.min(1.0) + flare;
        // Taken in most at the waist, not at all at the armhole and the hip.
        let taken = if depth < block.to_waist {
            (depth - top) / (block.to_waist - top)
        } else {
            1.0 - (depth - block.to_waist) / (block.neck_to_hip - block.to_waist)
        };
        straight - self.waist_in * taken.clamp(0.0, 1.0) + if side == 0 { FORWARD_M } else { -FORWARD_M }
    }

    /// The front, cut on the fold.
    pub fn front(&self, block: &DraftBlock) -> DraftPanel {
        let [low, high] = self.middle(block, 0);
        self.half(block, 0, [low, high]).on_the_fold("front", DraftSide::Front)
    }

    /// The left front alone, with an edge down the middle; below a depth (m), where there is one, it has another and swings back
    /// from the middle.
    pub fn left_front(&self, block: &DraftBlock, open: Option<f64>) -> DraftPanel {
        let [low, high] = self.middle(block, 0);
        let low = if open.is_some() { low + at(SWING_M, 0.0) } else { low };
        let outline = self.half(block, 0, [low, high]);
        let outline = match open {
            Some(depth) => {
                outline.line("middle", at(0.0, -depth)).bow("front edge", at(0.0, 0.6 * low.y - 0.4 * depth), low)
            }
            None => outline.line("middle", low),
        };
        outline.panel("left front", DraftSide::Front)
    }

    /// The back, cut on the fold.
    pub fn back(&self, block: &DraftBlock) -> DraftPanel {
        let [low, high] = self.middle(block, 1);
        self.half(block, 1, [low, high]).on_the_fold("back", DraftSide::Back)
    }

    /// The lower and the upper end of the middle.
    pub fn middle(&self, block: &DraftBlock, side: usize) -> [DVec2; 2] {
        let dip = if side == 0 { DIP_M[usize::from(block.sex == Sex::Male)] } else { 0.0 };
        [at(0.0, -self.length(block) - dip), at(0.0, -[self.front_neck, self.back_neck][side])]
    }

    /// The neck's point at the shoulder, and the shoulder's tip.
    pub fn shoulder(&self, block: &DraftBlock) -> [DVec2; 2] {
        let (inner, outer) = (block.neck + self.neck_wider, block.shoulder + self.shoulder_out);
        [inner, outer].map(|x| at(x, -SLOPE * (x - block.neck)))
    }

    fn neck_corner(&self, block: &DraftBlock, middle: DVec2) -> DVec2 {
        let [inner, _] = self.shoulder(block);
        let straight = 0.5 * (inner + middle);
        straight.lerp(at(inner.x, middle.y), self.neck_square)
    }

    /// The half from the lower end of the middle around to its upper end; the wearer's left one in front, the right one behind.
    fn half(&self, block: &DraftBlock, side: usize, [low, high]: [DVec2; 2]) -> Outline {
        let name = |what: &str| format!("{} {what}", ["left", "right"][side]);
        let wide = |depth: f64| at(self.half_width(block, depth, side), -depth);
        let (underarm, hip) = (wide(self.underarm(block)), block.neck_to_hip);
        let hem = wide(self.length(block));
        let mut outline = Outline::from(low).bow(&name("hem"), at(0.5 * hem.x, low.y), hem);
        if self.waist_in != 0.0 {
            if self.below_waist > LONG_M {
                outline = outline.line(&name("side below"), wide(hip));
            }
            let start = outline.end();
            let [rise, fall] = [start.y + block.to_waist, -block.to_waist - underarm.y].map(f64::abs);
            let waist = wide(block.to_waist);
            outline = outline
                .curve(&name("side"), [at(start.x, start.y + 0.45 * rise), at(waist.x, waist.y - 0.3 * rise)], waist)
                .curve(
                    &name("side above"),
                    [at(waist.x, waist.y + 0.35 * fall), underarm - 0.3 * (underarm - waist)],
                    underarm,
                );
        } else {
            outline = outline.line(&name("side"), underarm);
        }
        self.above(block, side, outline, high)
    }

    /// Goes on from the underarm over the armhole, the shoulder and the neck to the upper end of the middle.
    pub fn above(&self, block: &DraftBlock, side: usize, outline: Outline, high: DVec2) -> Outline {
        let name = |what: &str| format!("{} {what}", ["left", "right"][side]);
        let ([inner, tip], underarm) = (self.shoulder(block), outline.end());
        let depth = tip.y - underarm.y;
        let hollow = tip.x.min(underarm.x) - self.hollow[side];
        outline
            .curve(
                &name("armhole"),
                [
                    at(hollow.max(underarm.x - 0.6 * (underarm.x - hollow) - 0.03), underarm.y),
                    at(hollow, tip.y - 0.6 * depth),
                ],
                tip,
            )
            .line(&name("shoulder"), inner)
            .bow(&name("neck"), self.neck_corner(block, high), high)
    }
}
