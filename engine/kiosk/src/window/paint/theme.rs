//! Theme: the sizes of everything that is painted, from the display's size alone, and its colours.

use egui::{Color32, FontFamily, FontId};

use super::palette::Palette;

/// White and black as marks have them on any colour.
pub const LIGHT: Color32 = Color32::from_rgb(250, 248, 244);

/// The same, dark.
pub const DARK: Color32 = Color32::from_rgb(24, 25, 28);

/// Least size of a touch target (mm).
pub const TARGET_MM: f32 = 20.0;

/// Least height of a line of the body's type, as a share of the display's height.
pub const LEAST_LINE: f32 = 1.0 / 60.0;

/// Least height of a line on a display that people look at from two metres (mm): its capitals are nine millimetres high, 16 minutes of arc
/// from there, the least that is read with ease (ISO 9241-303, 5.5.3).
pub const LINE_AT_TWO_METRES_MM: f32 = 13.0;

/// The same on a display that is too small for it, as a share of its height.
const MOST_LEAST_LINE: f32 = 1.0 / 45.0;

/// The family of the words, and of headings.
pub const BODY: FontFamily = FontFamily::Proportional;

/// Sizes in pixels, and colours.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ScreenStyle {
    /// The display's width and height.
    pub display: [f32; 2],
    /// Type of a paragraph.
    pub body: f32,
    /// Least width and height of what can be pressed.
    pub target: f32,
    /// Whether the panel stands beside the picture.
    pub landscape: bool,
    /// Whether the panel is a column beside a person who stands.
    pub narrow: bool,
    /// Height of the smallest type.
    pub least: f32,
    /// How much tighter than it likes to be everything stands, 0.6 .. 1.
    pub squeeze: f32,
    /// Its colours.
    pub palette: Palette,
}

impl ScreenStyle {
    /// Of a display of so many pixels, of which one measures so much (mm), with type so much larger than ordinary.
    pub fn of(display: [f32; 2], pixel_mm: f32, type_scale: f32, palette: Palette) -> Self {
        let [w, h] = display;
        let landscape = w > h;
        let least = (LINE_AT_TWO_METRES_MM / pixel_mm.max(1e-3)).clamp(h * LEAST_LINE, h * MOST_LEAST_LINE).ceil();
        let ordinary = (h / 42.0).min(w / 30.0).max(least);
        Self {
            display,
            body: (ordinary * type_scale.clamp(1.0, 2.0)).round(),
            target: (TARGET_MM / pixel_mm.max(1e-3)).min(h * 0.1).ceil(),
            landscape,
            narrow: false,
            least,
            squeeze: 1.0,
            palette,
        }
    }

    /// The same, tighter: less air first, then smaller type, never below the least.
    #[must_use]
    pub fn squeezed(self, share: f32) -> Self {
        Self { body: (self.body * share.max(0.75)).max(self.least.min(self.body)).round(), squeeze: share, ..self }
    }

    /// Type of the heading.
    pub fn heading(&self) -> FontId {
        FontId::new((self.body * 1.6).round(), FontFamily::Name("bold".into()))
    }

    /// Type of a paragraph.
    pub fn text(&self) -> FontId {
        FontId::new(self.body, BODY)
    }

    /// Type of a button.
    pub fn label(&self) -> FontId {
        FontId::new(self.body, FontFamily::Name("bold".into()))
    }

    /// Type of second lines: never below the least.
    pub fn small(&self) -> FontId {
        FontId::new((self.body * 0.84).max(self.least).round(), BODY)
    }

    /// Empty space between things (pixels).
    pub fn gap(&self) -> f32 {
        (self.body * 0.62 * self.squeeze).round()
    }

    /// Air between the panel's edge and what stands on it.
    pub fn margin(&self) -> f32 {
        (self.body * if self.narrow { 0.8 } else { 1.3 }).round()
    }

    /// Air between the display's edge and the panel.
    pub fn air(&self) -> f32 {
        (self.body * 0.8).round()
    }

    /// Radius of a button's corners.
    pub fn round(&self) -> f32 {
        (self.body * 0.55).round()
    }

    /// Width of a fine line.
    pub fn line(&self) -> f32 {
        (self.body / 16.0).round().max(1.0)
    }
}
