//! Wardrobe: the garments to choose from, in the order of dressing, which of them exclude each other, their sizes and colours.
//!
//! The eight layers, and where a garment is held on the body, are those of Ugur 2008, sections 6.1 and 6.2.

use toile_assets::fabric::Fabric;
use toile_assets::sizes::{GarmentKind, SizeTable};
use toile_assets::wardrobe;
use toile_assets::wardrobe::style::Style;

use super::texts::TextKey;
use crate::error::KioskError;

/// Garments that are worn at once, at most: one over each half of the body, in each of eight layers.
pub const MOST_WORN: usize = 16;

/// A layer of clothes, in the order of dressing (Ugur 2008, section 6.1).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Layer {
    /// Underwear, next to the skin.
    Underwear,
    /// Tank tops and slips.
    Slip,
    /// Shirts, skirts, trousers and dresses.
    Shirt,
    /// Jackets and cardigans.
    Jacket,
    /// Belts and jewellery.
    Belt,
    /// Coats, over jackets.
    Coat,
    /// Scarves and shawls.
    Scarf,
    /// Shoes and bags.
    Shoe,
}

toile_assets::named! {
    /// Where a garment is held, and does not slip on the body: the seven fitting levels of Ugur 2008, section 6.2.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
    pub enum FittingLevel {
        /// At the neck.
        Neck = "neck",
        /// On the shoulders.
        Shoulders = "shoulders",
        /// At the bust.
        Bust = "bust",
        /// Below the bust.
        Underbust = "underbust",
        /// At the waist.
        Waist = "waist",
        /// At the crotch.
        Crotch = "crotch",
        /// At the feet.
        Feet = "feet",
    }
}

/// A half of the body; two garments of one layer never cover the same.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum BodyHalf {
    Upper,
    Lower,
}

/// A colour that a garment comes in, with its name, for not everybody tells colours apart.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Colour {
    /// Key of the colour's name in the pages' texts.
    pub word: TextKey,
    /// sRGB, 0 .. 1.
    pub srgb: [f32; 3],
}

const fn colour(word: TextKey, srgb: [f32; 3]) -> Colour {
    Colour { word, srgb }
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

/// A garment of the wardrobe.
#[derive(Debug, Clone, PartialEq)]
pub struct WardrobeItem {
    /// How it is cut and what it is made of.
    pub style: Style,
    /// Size table that it is cut by.
    pub table: SizeTable,
    /// The codes of its sizes, smallest first.
    pub sizes: Vec<String>,
    /// The colours that it comes in, first that of its fabric.
    pub colours: Vec<Colour>,
    /// Layer in which it is worn.
    pub layer: Layer,
    /// Its place in the layer: what is tucked in comes first.
    place: u8,
    /// Level of the body at which it is held.
    pub held: FittingLevel,
    covers: &'static [BodyHalf],
}

impl WardrobeItem {
    fn new(name: &str) -> Result<Self, KioskError> {
        let style = wardrobe::style(name).map_err(KioskError::input)?;
        let table = style.sizes().map_err(KioskError::input)?;
        let sizes: Vec<String> = table.codes().into_iter().map(str::to_owned).collect();
        let (layer, place, held, covers): (_, _, _, &'static [BodyHalf]) = match style.kind {
            GarmentKind::Trousers | GarmentKind::Skirt => (Layer::Shirt, 0, FittingLevel::Waist, &[BodyHalf::Lower]),
            GarmentKind::Tshirt => (Layer::Shirt, 1, FittingLevel::Shoulders, &[BodyHalf::Upper]),
            GarmentKind::Jacket => (Layer::Jacket, 0, FittingLevel::Shoulders, &[BodyHalf::Upper]),
            GarmentKind::Dress => (Layer::Shirt, 1, FittingLevel::Shoulders, &[BodyHalf::Upper, BodyHalf::Lower]),
        };
        let own = Fabric::built_in(&style.fabric).map_err(KioskError::input)?.colour;
        Ok(Self { colours: palette(style.kind, own), style, table, sizes, layer, place, held, covers })
    }

    /// Its name in words; none for a garment that has no word, which goes by its title.
    pub fn word(&self) -> Option<TextKey> {
        match self.style.name.as_str() {
            "sun-dress" => Some(TextKey::GarmentSunDress),
            "t-shirt" => Some(TextKey::GarmentTShirt),
            "jacket" => Some(TextKey::GarmentJacket),
            "wide-trousers" => Some(TextKey::GarmentWideTrousers),
            _ => None,
        }
    }

    /// Whether both cannot be worn at once: of one layer, over the same half of the body.
    pub fn excludes(&self, other: &Self) -> bool {
        self.layer == other.layer && self.covers.iter().any(|half| other.covers.contains(half))
    }
}

/// The colours of a garment, first its fabric's own, which has no name of its own where it is none of ours.
fn palette(kind: GarmentKind, own: [f32; 3]) -> Vec<Colour> {
    let ours = match kind {
        GarmentKind::Dress => LAWN,
        GarmentKind::Tshirt => JERSEY,
        GarmentKind::Jacket => WOOL,
        GarmentKind::Trousers | GarmentKind::Skirt => LINEN,
    };
    if ours[0].srgb == own {
        return ours.to_vec();
    }
    [&[colour(TextKey::ColourOwn, own)], &ours[..4]].concat()
}

/// A garment that is worn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct WornItem {
    /// Index in the wardrobe.
    pub item: usize,
    /// The place of its size among those that are made.
    pub size: usize,
    /// The place of its colour.
    pub colour: usize,
}

/// What is worn, inner first.
pub type Outfit = heapless::Vec<WornItem, MOST_WORN>;

/// The garments to choose from, inner first.
#[derive(Debug, Clone, PartialEq)]
pub struct Wardrobe {
    /// Garments in the order of dressing.
    pub items: Vec<WardrobeItem>,
}

impl Wardrobe {
    /// The garments of the wardrobe in the order of dressing.
    ///
    /// # Errors
    /// A garment whose file, sizes or fabric cannot be used.
    pub fn stock() -> Result<Self, KioskError> {
        let mut items = wardrobe::names().into_iter().map(WardrobeItem::new).collect::<Result<Vec<_>, _>>()?;
        items.sort_by_key(|item| (item.layer, item.place));
        Ok(Self { items })
    }

    /// The place of a garment by its name.
    pub fn find(&self, name: &str) -> Option<usize> {
        self.items.iter().position(|item| item.style.name == name)
    }

    /// Puts a garment on: what it excludes comes off, and the rest stays in the order of dressing.
    pub fn put_on(&self, outfit: &Outfit, worn: WornItem) -> Outfit {
        let keeps = |w: &&WornItem| w.item != worn.item && !self.items[w.item].excludes(&self.items[worn.item]);
        let mut next: Outfit = outfit.iter().filter(keeps).copied().collect();
        let at = next.iter().position(|w| w.item > worn.item).unwrap_or(next.len());
        // There is a place: what is worn covers different halves, or lies in different layers.
        let _ = next.insert(at, worn);
        next
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wardrobe() -> Wardrobe {
        Wardrobe::stock().unwrap()
    }

    fn wear(names: &[&str]) -> Vec<String> {
        let wardrobe = wardrobe();
        let worn = |name: &&str| WornItem { item: wardrobe.find(name).unwrap(), size: 0, colour: 0 };
        let outfit = names.iter().map(worn).fold(Outfit::new(), |outfit, w| wardrobe.put_on(&outfit, w));
        outfit.iter().map(|w| wardrobe.items[w.item].style.name.clone()).collect()
    }

    #[test]
    fn the_order_of_putting_on_does_not_change_the_order_of_wearing() {
        assert_eq!(wear(&["t-shirt", "wide-trousers"]), ["wide-trousers", "t-shirt"]);
        assert_eq!(wear(&["wide-trousers", "t-shirt"]), ["wide-trousers", "t-shirt"]);
    }

    #[test]
    fn a_dress_takes_the_place_of_shirt_and_trousers_and_they_of_it() {
        assert_eq!(wear(&["t-shirt", "wide-trousers", "sun-dress"]), ["sun-dress"]);
        assert_eq!(wear(&["sun-dress", "wide-trousers"]), ["wide-trousers"]);
        assert_eq!(wear(&["t-shirt", "t-shirt"]), ["t-shirt"], "nothing is worn twice");
    }

    #[test]
    fn a_jacket_goes_over_whatever_else_is_worn() {
        assert_eq!(wear(&["jacket", "t-shirt", "wide-trousers"]), ["wide-trousers", "t-shirt", "jacket"]);
        assert_eq!(wear(&["jacket", "sun-dress"]), ["sun-dress", "jacket"]);
    }

    #[test]
    fn layers_that_differ_never_exclude_each_other() {
        let mut wardrobe = wardrobe();
        for item in &mut wardrobe.items {
            let mut coat = item.clone();
            coat.layer = Layer::Coat;
            assert!(!coat.excludes(item) && !item.excludes(&coat));
        }
    }

    #[test]
    fn every_garment_has_sizes_a_word_and_colours_with_names_of_their_own() {
        for item in wardrobe().items {
            assert!(item.word().is_some() && item.sizes.len() >= 3, "{}", item.style.name);
            assert!((4..=5).contains(&item.colours.len()));
            let own = Fabric::built_in(&item.style.fabric).unwrap().colour;
            assert_eq!(item.colours[0].srgb, own, "the first is the fabric's");
            for (i, colour) in item.colours.iter().enumerate() {
                assert_ne!(colour.word, TextKey::ColourOwn, "{} has a colour without a name", item.style.name);
                assert!(item.colours[..i].iter().all(|c| c.word != colour.word));
            }
        }
        let strange = palette(GarmentKind::Dress, [0.1, 0.9, 0.1]);
        assert_eq!((strange[0].word, strange.len()), (TextKey::ColourOwn, 5));
    }
}
