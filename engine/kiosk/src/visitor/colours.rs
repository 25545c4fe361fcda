//! The colours that garments of the stock come in.

use toile_assets::catalogue::Words;
use toile_assets::sizes::GarmentKind;

use super::texts::TextKey;

/// A colour that a garment comes in, with its name, because not all people tell colours apart.
#[derive(Debug, Clone, PartialEq)]
pub struct Colour {
    /// Key of the colour's name in the pages' texts.
    pub word: TextKey,
    /// What a shop calls it in each language, in place of that.
    pub words: Option<Words>,
    /// sRGB, 0 .. 1.
    pub srgb: [f32; 3],
}

const fn colour(word: TextKey, srgb: [f32; 3]) -> Colour {
    Colour { word, words: None, srgb }
}

/// Summer clothes; the first is that of the fabric.
const LAWN: [Colour; 5] = [
    colour(TextKey::ColourCoral, [0.80, 0.36, 0.28]),
    colour(TextKey::ColourIvory, [0.93, 0.90, 0.82]),
    colour(TextKey::ColourSky, [0.52, 0.70, 0.84]),
    colour(TextKey::ColourMoss, [0.38, 0.44, 0.24]),
    colour(TextKey::ColourNavy, [0.13, 0.17, 0.32]),
];

/// Colours of T-shirts; the first is that of the fabric.
const JERSEY: [Colour; 5] = [
    colour(TextKey::ColourDenim, [0.22, 0.42, 0.58]),
    colour(TextKey::ColourWhite, [0.95, 0.95, 0.94]),
    colour(TextKey::ColourOchre, [0.85, 0.63, 0.22]),
    colour(TextKey::ColourBrick, [0.62, 0.24, 0.19]),
    colour(TextKey::ColourCharcoal, [0.19, 0.20, 0.22]),
];

/// Colours of trousers; the first is that of the fabric.
const LINEN: [Colour; 5] = [
    colour(TextKey::ColourSand, [0.66, 0.60, 0.48]),
    colour(TextKey::ColourIvory, [0.93, 0.90, 0.82]),
    colour(TextKey::ColourMoss, [0.38, 0.44, 0.24]),
    colour(TextKey::ColourNavy, [0.13, 0.17, 0.32]),
    colour(TextKey::ColourCharcoal, [0.19, 0.20, 0.22]),
];

/// Colours of jackets; the first is that of the fabric.
const WOOL: [Colour; 5] = [
    colour(TextKey::ColourCharcoal, [0.19, 0.20, 0.22]),
    colour(TextKey::ColourNavy, [0.13, 0.17, 0.32]),
    colour(TextKey::ColourMoss, [0.38, 0.44, 0.24]),
    colour(TextKey::ColourSand, [0.66, 0.60, 0.48]),
    colour(TextKey::ColourBrick, [0.62, 0.24, 0.19]),
];

/// The colours of a garment, first its fabric's own, which has no name of its own where it is none of ours.
pub(super) fn palette(kind: GarmentKind, own: [f32; 3]) -> Vec<Colour> {
    let ours = match kind {
        GarmentKind::Dress => LAWN,
        GarmentKind::Tshirt => JERSEY,
        GarmentKind::Jacket => WOOL,
        GarmentKind::Trousers | GarmentKind::Skirt => LINEN,
    };
    if ours[0].srgb == own {
        return ours.to_vec();
    }
    std::iter::once(colour(TextKey::ColourOwn, own)).chain(ours[..4].iter().cloned()).collect()
}
