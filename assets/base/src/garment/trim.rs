//! Trims on the cloth of a garment: buttons, stitches, edges, strips, zips. They are seen and weigh nothing.

use glam::Vec2;

/// Trims of one pattern: each is a bit of the word that says which of them a triangle may show.
pub const MAX_TRIMS: usize = 32;

/// What a trim is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TrimKind {
    /// A button with four holes at the first of its ends; the second is where its thread points to.
    Button,
    /// A line of stitches.
    Stitches,
    /// The edge of cloth that lies on the panel, to the left of the way from the first end to the second.
    Edge,
    /// A strip of the same cloth that lies on the panel, stitched down along both sides: a placket, a cuff, a welt, a loop.
    Strip,
    /// A zip: a tape with teeth along its middle.
    Zip,
}

impl TrimKind {
    /// All of them.
    pub const ALL: [Self; 5] = [Self::Button, Self::Stitches, Self::Edge, Self::Strip, Self::Zip];

    /// Its name in files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Button => "button",
            Self::Stitches => "stitches",
            Self::Edge => "edge",
            Self::Strip => "strip",
            Self::Zip => "zip",
        }
    }
}

/// A trim as it lies on the cloth, where faces have their flat corners.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ClothTrim {
    /// The panel that it is on.
    pub panel: u32,
    /// What it is.
    pub kind: TrimKind,
    /// Where it begins and ends (m): weft along x, warp along y.
    pub ends: [Vec2; 2],
    /// Half of its width: a button's radius (m).
    pub half: f32,
    /// Colour of buttons and zips (sRGB).
    pub colour: [f32; 3],
}

impl ClothTrim {
    /// The same with the cloth turned by half.
    #[must_use]
    pub fn upside_down(self) -> Self {
        Self { ends: self.ends.map(|p| -p), ..self }
    }

    /// The same seen from the other side of the cloth.
    #[must_use]
    pub fn from_behind(self) -> Self {
        let [a, b] = self.ends.map(|p| Vec2::new(-p.x, p.y));
        Self { ends: [b, a], ..self }
    }
}
