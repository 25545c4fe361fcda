//! What is woven into a fabric or printed on it, as its file states it.

use glam::Vec2;

/// One repeat of a print, as its fabric file states it. The ground is the fabric's own colour.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Deserialize), serde(deny_unknown_fields))]
pub struct Print {
    /// What is drawn.
    pub pattern: PrintPattern,
    /// Its colours beside the ground's, sRGB 0..1.
    #[cfg_attr(feature = "serde", serde(default))]
    pub colours: Vec<[f32; 3]>,
    /// One repeat along the weft and along the warp (mm).
    pub repeat_mm: [f32; 2],
    /// Share of the repeat that is coloured (0..1).
    #[cfg_attr(feature = "serde", serde(default = "half"))]
    pub share: f32,
    /// A picture of one repeat in PNG or JPEG, for the pattern `picture`: a file beside the fabric's.
    pub picture: Option<String>,
}

#[cfg(feature = "serde")]
fn half() -> f32 {
    0.5
}

/// What a print shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum PrintPattern {
    /// Along the warp, one for each colour.
    Stripes,
    /// Along the weft, one for each colour.
    Hoops,
    /// Stripes and hoops of thread: where both cross the colour is full, elsewhere half.
    Gingham,
    /// Thin lines of both directions.
    Windowpane,
    /// Checks of four dark and four light threads in a twill.
    Houndstooth,
    /// A twill of two colours of thread that turns back after eight.
    Herringbone,
    /// Round dots, every second row shifted by half.
    Dots,
    /// Small flowers of five petals, every second row shifted by half; the second colour is their middle, the third leaves.
    Flowers,
    /// A picture of the fabric's own.
    Picture,
}

impl Print {
    /// One repeat along the weft and along the warp (m).
    pub fn repeat(&self) -> Vec2 {
        Vec2::from_array(self.repeat_mm) * 1e-3
    }
}
