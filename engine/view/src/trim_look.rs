//! Trims as drawn on the cloth: buttons, stitches, edges of pieces that lie on it, strips, zips.

use glam::{Vec2, Vec3};
use toile_base::garment::look::TRIM_SHADOW_M;
use toile_base::garment::trim::{ClothTrim, TrimKind};

use crate::image::linear;

/// Half the width of the line that an edge of cloth draws (m), and how dark it is (0..1).
pub(crate) const EDGE_HALF_M: f32 = 0.0009;
pub(crate) const EDGE_DARK: f32 = 0.5;

/// How dark the shadow beside an edge or a button begins (0..1); it ends [`TRIM_SHADOW_M`] away.
pub(crate) const SHADOW_DARK: f32 = 0.3;

/// How far inside the edge of a strip it is stitched down (m).
pub(crate) const STRIP_STITCH_M: f32 = 0.003;

/// Half the width of a line of stitches (m), and how dark it is (0..1).
pub(crate) const TRIM_STITCH_HALF_M: f32 = 0.0006;
pub(crate) const TRIM_STITCH_DARK: f32 = 0.34;

/// Part of a button's radius that its raised rim takes, how dark the groove inside of it is, and its holes: how far from the
/// middle they are along both diagonals, and how large (parts of the radius).
pub(crate) const RIM: f32 = 0.24;
pub(crate) const RIM_DARK: f32 = 0.28;
pub(crate) const HOLE_AWAY: f32 = 0.22;
pub(crate) const HOLE: f32 = 0.13;
pub(crate) const HOLE_DARK: f32 = 0.7;

/// A zip's teeth: half their width and the length of one with its gap (m).
pub(crate) const TEETH_HALF_M: f32 = 0.0022;
pub(crate) const TOOTH_M: f32 = 0.0026;

/// A trim as it is drawn, its numbers as the shader has them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DrawnTrim {
    /// Its ends on the cloth (m).
    pub ends: [Vec2; 2],
    /// Half of its width (m).
    pub half: f32,
    /// What it is: the place of its kind in [`TrimKind::ALL`].
    pub kind: u32,
    /// Its colour (linear RGB).
    pub colour: Vec3,
}

impl DrawnTrim {
    /// Of a garment's trim.
    pub fn of(trim: &ClothTrim) -> Self {
        let kind = TrimKind::ALL.iter().position(|k| *k == trim.kind).unwrap_or_default() as u32;
        let colour = Vec3::from_array(trim.colour.map(linear));
        Self { ends: trim.ends, half: trim.half, kind, colour }
    }
}

/// A point of cloth near trims, seen by a pixel so wide (m).
#[derive(Debug, Clone, Copy)]
pub(crate) struct TrimmedPoint {
    at: Vec2,
    pixel: f32,
}

impl TrimmedPoint {
    pub(crate) fn new(at: Vec2, pixel: f32) -> Self {
        Self { at, pixel: pixel.max(1e-6) }
    }

    /// How much of what reaches so far a pixel sees at a distance (m).
    fn inside(self, distance: f32, reach: f32) -> f32 {
        ((reach - distance) / self.pixel + 0.5).clamp(0.0, 1.0)
    }

    /// How much of a line of this half width it sees at a distance (m).
    fn line(self, distance: f32, half: f32) -> f32 {
        let seen = ((half + 0.5 * self.pixel - distance) / self.pixel).clamp(0.0, 1.0);
        seen * (2.0 * half / self.pixel).min(1.0)
    }

    /// How much of the seams beneath it the trims hide.
    pub(crate) fn covered(self, trims: impl Iterator<Item = DrawnTrim>) -> f32 {
        trims.fold(0.0, |covered, trim| covered.max(self.cover(&trim)))
    }

    fn cover(self, trim: &DrawnTrim) -> f32 {
        let (distance, off) = self.beside(trim);
        match TrimKind::ALL[trim.kind as usize] {
            TrimKind::Strip | TrimKind::Zip => self.inside(distance, trim.half),
            TrimKind::Edge if off > 0.0 => self.inside(distance, trim.half),
            _ => 0.0,
        }
    }

    /// Distance from a trim, and on which side: positive is to the left of its way.
    fn beside(self, trim: &DrawnTrim) -> (f32, f32) {
        let [a, b] = trim.ends;
        let (along, off) = (b - a, self.at - a);
        let t = (off.dot(along) / along.length_squared().max(1e-12)).clamp(0.0, 1.0);
        (self.at.distance(a + along * t), along.perp_dot(off))
    }

    /// The colour with a trim on it.
    pub(crate) fn with(self, trim: &DrawnTrim, colour: Vec3) -> Vec3 {
        let (distance, off) = self.beside(trim);
        let shadow = |far: f32| 1.0 - SHADOW_DARK * (1.0 - far / TRIM_SHADOW_M).clamp(0.0, 1.0);
        match TrimKind::ALL[trim.kind as usize] {
            TrimKind::Button => self.button(trim, colour),
            TrimKind::Stitches => colour * (1.0 - TRIM_STITCH_DARK * self.line(distance, trim.half)),
            TrimKind::Edge => {
                let beneath = if off > 0.0 { 1.0 } else { shadow(distance) };
                colour * beneath * (1.0 - EDGE_DARK * self.line(distance, EDGE_HALF_M))
            }
            TrimKind::Strip => {
                let edge = (distance - trim.half).abs();
                let beneath = if distance < trim.half { 1.0 } else { shadow(distance - trim.half) };
                let sewn = self.line((trim.half - STRIP_STITCH_M - distance).abs(), TRIM_STITCH_HALF_M);
                colour
                    * beneath
                    * (1.0 - EDGE_DARK * self.line(edge, EDGE_HALF_M))
                    * (1.0 - 0.6 * TRIM_STITCH_DARK * sewn)
            }
            TrimKind::Zip => self.zip(trim, colour, distance),
        }
    }

    fn zip(self, trim: &DrawnTrim, colour: Vec3, distance: f32) -> Vec3 {
        let tape = colour * (1.0 - EDGE_DARK * self.line((distance - trim.half).abs(), EDGE_HALF_M));
        let along = (trim.ends[1] - trim.ends[0]).normalize_or(Vec2::Y);
        let at = (self.at - trim.ends[0]).dot(along) / TOOTH_M;
        // From afar single teeth are not seen.
        let tooth = if at - at.floor() < 0.6 { 1.0 } else { 0.35 };
        let seen = tooth + (0.75 - tooth) * (self.pixel / TOOTH_M).min(1.0);
        tape.lerp(trim.colour * seen, self.inside(distance, TEETH_HALF_M.min(trim.half)))
    }

    fn button(self, trim: &DrawnTrim, colour: Vec3) -> Vec3 {
        let (middle, radius) = (trim.ends[0], trim.half);
        let along = (trim.ends[1] - middle).normalize_or(Vec2::Y);
        let from = self.at - middle;
        let far = from.length();
        // Light comes from above: the shadow lies below, the rim is lighter above.
        let below = (from + along * 0.25 * radius).length() - radius;
        let beneath = colour * (1.0 - SHADOW_DARK * 1.6 * (1.0 - below.max(0.0) / (0.5 * radius)).clamp(0.0, 1.0));
        let up = from.dot(along) / radius.max(1e-6);
        let mut face = trim.colour * (0.92 + 0.16 * up);
        face *= 1.0 - RIM_DARK * self.line((far - (1.0 - RIM) * radius).abs(), 0.1 * radius);
        let own = Vec2::new(from.dot(along.perp()).abs(), from.dot(along).abs());
        let hole = own.distance(Vec2::splat(HOLE_AWAY * radius));
        face *= 1.0 - HOLE_DARK * self.inside(hole, HOLE * radius) * (2.0 * HOLE * radius / self.pixel).min(1.0);
        beneath.lerp(face, self.inside(far, radius))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn trim(kind: TrimKind, half: f32) -> DrawnTrim {
        let ends = [Vec2::ZERO, Vec2::new(0.0, 0.1)];
        DrawnTrim::of(&ClothTrim { panel: 0, kind, ends, half, colour: [1.0, 0.0, 0.0] })
    }

    #[test]
    fn a_button_is_of_its_own_colour_and_ends_at_its_radius() {
        let button = trim(TrimKind::Button, 0.006);
        let at = |x: f32| TrimmedPoint::new(Vec2::new(x, 0.0), 1e-4).with(&button, Vec3::splat(0.5));
        assert!(at(0.003).x > 0.8 && at(0.003).y == 0.0);
        assert_eq!(at(0.02), Vec3::splat(0.5));
        // From afar what is left of it is its share of the pixel.
        let afar = TrimmedPoint::new(Vec2::new(0.02, 0.0), 0.05).with(&button, Vec3::splat(0.5));
        assert!((afar.y - 0.5).abs() < 0.3, "{afar}");
    }

    #[test]
    fn an_edge_darkens_what_is_beneath_it_and_hides_seams_on_its_own_side() {
        let edge = trim(TrimKind::Edge, 0.02);
        let at = |x: f32| TrimmedPoint::new(Vec2::new(x, 0.05), 1e-4);
        // Left of the way up is -x.
        assert_eq!(at(-0.004).with(&edge, Vec3::ONE), Vec3::ONE);
        assert!(at(0.002).with(&edge, Vec3::ONE).x < 0.9 && at(0.0).with(&edge, Vec3::ONE).x < 0.6);
        assert_eq!((at(-0.01).covered([edge].into_iter()), at(0.01).covered([edge].into_iter())), (1.0, 0.0));
    }

    #[test]
    fn strips_and_zips_hide_the_seam_under_them() {
        for kind in [TrimKind::Strip, TrimKind::Zip] {
            let strip = trim(kind, 0.01);
            let covered = |x: f32| TrimmedPoint::new(Vec2::new(x, 0.05), 1e-4).covered([strip].into_iter());
            assert_eq!((covered(0.005), covered(-0.005), covered(0.02)), (1.0, 1.0, 0.0));
        }
    }
}
