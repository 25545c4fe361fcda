//! Trims in the drawing of a panel: buttons, lines of stitches, the edges of lapels, plackets and cuffs, zips.

use glam::{DMat2, DVec2, Vec2};
use toile_base::garment::trim::{ClothTrim, TrimKind};

/// A trim in the plane of its panel's drawing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Trim {
    /// What it is.
    pub kind: TrimKind,
    /// Where it begins and ends (m).
    pub ends: [DVec2; 2],
    /// Half of its width: a button's radius (m).
    pub half: f64,
    /// Colour of buttons and zips (sRGB).
    pub colour: [f32; 3],
}

impl Trim {
    /// Between two of a kind, at `t` from 0 (this one) to 1 (the other); this one where the other is something else.
    #[must_use]
    pub fn between(&self, other: &Self, t: f64) -> Self {
        if self.kind != other.kind {
            return *self;
        }
        let ends = [0, 1].map(|k| self.ends[k].lerp(other.ends[k], t));
        Self { ends, half: self.half + (other.half - self.half) * t, ..*self }
    }

    /// On the cloth of a panel: along its weft and its warp, `axes`, and turned over where its drawing shows the inside.
    pub fn on_cloth(&self, panel: u32, axes: [DVec2; 2], inside: bool) -> ClothTrim {
        let turn = DMat2::from_cols(axes[0], axes[1]).transpose();
        let at = |p: DVec2| {
            let flat = turn * p;
            Vec2::new(if inside { -flat.x } else { flat.x } as f32, flat.y as f32)
        };
        let Self { kind, ends, half, colour } = *self;
        let trim = ClothTrim { panel, kind, ends: ends.map(at), half: half as f32, colour };
        // Seen in a mirror, left is on the other side.
        if inside { ClothTrim { ends: [trim.ends[1], trim.ends[0]], ..trim } } else { trim }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn trim(kind: TrimKind, x: f64) -> Trim {
        Trim { kind, ends: [DVec2::new(x, 0.0), DVec2::new(x, 0.2)], half: x, colour: [0.5; 3] }
    }

    #[test]
    fn between_two_drafts_a_trim_moves_in_proportion() {
        let half = trim(TrimKind::Zip, 0.1).between(&trim(TrimKind::Zip, 0.3), 0.5);
        assert!((half.ends[1] - DVec2::new(0.2, 0.2)).length() < 1e-12 && (half.half - 0.2).abs() < 1e-12);
        assert_eq!(trim(TrimKind::Zip, 0.1).between(&trim(TrimKind::Edge, 0.3), 0.5), trim(TrimKind::Zip, 0.1));
    }

    #[test]
    fn what_is_left_of_an_edge_stays_left_of_it_from_behind() {
        let edge = trim(TrimKind::Edge, 0.1);
        let left = |t: &ClothTrim, p: Vec2| (t.ends[1] - t.ends[0]).perp_dot(p - t.ends[0]) > 0.0;
        let plain = edge.on_cloth(0, [DVec2::X, DVec2::Y], false);
        let turned = edge.on_cloth(0, [DVec2::X, DVec2::Y], true);
        assert!(left(&plain, Vec2::new(0.0, 0.1)) && left(&turned, Vec2::new(0.0, 0.1)));
        assert_eq!(turned, plain.from_behind());
        assert!(left(&plain.upside_down(), Vec2::new(0.0, -0.1)));
    }
}
