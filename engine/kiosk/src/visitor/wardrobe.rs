//! Wardrobe: the garments to choose from, in the order of dressing, their exclusions, sizes and colours.
//!
//! The eight layers, and the places that hold a garment on the body, are those of Ugur 2008, sections 6.1 and 6.2.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

use toile_assets::adapt::dress as own;
use toile_assets::catalogue::{CatalogueItem, ManifestColour, Price, ShopTheme, Words, word};
use toile_assets::drafting::{self, DraftStyle};
use toile_assets::file::{self, FileStamp};
use toile_assets::sizes::{GarmentKind, Population};
use toile_base::body::{Body, Measures, Sex};
use toile_fitting::dress::garment_source::{GarmentSource, SourceKind};
use toile_fitting::dress::offer::GarmentOffer;

use super::colours::{Colour, palette};
use super::texts::TextKey;
use crate::error::KioskError;
use crate::service::stock::{LeftOut, Stock};

/// The garments that hang where no shop brings its own, some of them in a print, each with its name in the pages' texts.
const STOCK: [(&str, TextKey); 12] = [
    ("strap-dress", TextKey::GarmentStrapDress),
    ("tee", TextKey::GarmentTee),
    ("wide-leg-trousers", TextKey::GarmentWideLegTrousers),
    ("mens-blazer", TextKey::GarmentMensBlazer),
    ("circle-skirt:lawn-flowers", TextKey::GarmentCircleSkirt),
    ("slim-trousers", TextKey::GarmentSlimTrousers),
    ("shirt:lawn-gingham", TextKey::GarmentShirt),
    ("jumper:jersey-breton", TextKey::GarmentJumper),
    ("mens-shirt", TextKey::GarmentMensShirt),
    ("mens-trousers", TextKey::GarmentMensTrousers),
    ("blazer", TextKey::GarmentBlazer),
    ("coat", TextKey::GarmentCoat),
];

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

impl Layer {
    /// By the number that garments have: 1 underwear, 2 skirts and trousers, 3 tops and dresses, 4 jackets, 5 coats, 6 scarves.
    const fn of(number: u8) -> Self {
        match number {
            1 => Self::Underwear,
            2 | 3 => Self::Shirt,
            4 => Self::Jacket,
            5 => Self::Coat,
            _ => Self::Scarf,
        }
    }
}

toile_base::named! {
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

/// What a garment is called.
#[derive(Debug, Clone, PartialEq)]
enum ItemName {
    /// A word of the pages.
    Word(TextKey),
    /// In one language.
    Title(String),
    /// What a shop calls it, by language.
    Words(Words),
}

/// A garment of the wardrobe.
#[derive(Debug, Clone, PartialEq)]
pub struct WardrobeItem {
    /// What it is asked for by: a garment that is built in, or the path of its file.
    pub name: String,
    /// A shop's article number.
    pub article: Option<String>,
    /// What it costs.
    pub price: Option<Price>,
    /// The photograph of its package that is shown.
    pub photograph: Option<String>,
    /// Its file as it was read; none of what is built in.
    pub stamp: Option<FileStamp>,
    title: ItemName,
    /// Its sizes, as one is chosen by; none where it is shown as it was made, its size unknown.
    pub offer: Option<GarmentOffer>,
    /// Whose bodies it is made for.
    pub population: Population,
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

/// Where a kind of garment is worn and held, and what it covers.
struct WornPlace {
    layer: Layer,
    place: u8,
    held: FittingLevel,
    covers: &'static [BodyHalf],
}

impl WornPlace {
    /// Of what is not known it is taken that nothing of its layer goes with it.
    const fn of(kind: Option<GarmentKind>) -> Self {
        let (layer, place, held, covers): (_, _, _, &'static [BodyHalf]) = match kind {
            Some(GarmentKind::Trousers | GarmentKind::Skirt) => {
                (Layer::Shirt, 0, FittingLevel::Waist, &[BodyHalf::Lower])
            }
            Some(GarmentKind::Tshirt) => (Layer::Shirt, 1, FittingLevel::Shoulders, &[BodyHalf::Upper]),
            Some(GarmentKind::Jacket) => (Layer::Jacket, 0, FittingLevel::Shoulders, &[BodyHalf::Upper]),
            Some(GarmentKind::Dress) | None => {
                (Layer::Shirt, 1, FittingLevel::Shoulders, &[BodyHalf::Upper, BodyHalf::Lower])
            }
        };
        Self { layer, place, held, covers }
    }
}

impl WardrobeItem {
    /// A garment that is built in, or the file of one.
    ///
    /// # Errors
    /// An unknown garment; a file, sizes or a fabric that cannot be used.
    pub fn new(name: &str) -> Result<Self, KioskError> {
        Self::of(&GarmentSource::find(name)?, &average()?)
    }

    /// A garment of a shop's catalogue, as it is judged on `average`.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn of_package(item: &CatalogueItem, average: &Body) -> Result<Self, KioskError> {
        let source = GarmentSource::open(&item.path)?;
        let manifest = &item.manifest;
        let mut hung = Self::of(&source, average)?;
        let own = |c: &ManifestColour| Colour { word: TextKey::ColourOwn, words: Some(c.name.clone()), srgb: c.srgb };
        if !manifest.colours.is_empty() {
            hung.colours = manifest.colours.iter().map(own).collect();
        }
        hung.title = ItemName::Words(manifest.names.clone());
        hung.article = Some(manifest.article.clone());
        hung.price.clone_from(&manifest.price);
        hung.photograph = manifest.photographs.first().cloned();
        hung.stamp = Some(item.stamp);
        hung.layer = manifest.layer.map_or(hung.layer, Layer::of);
        Ok(hung)
    }

    fn of(source: &GarmentSource, average: &Body) -> Result<Self, KioskError> {
        let offer = source.offer(average)?;
        let kind = match &source.kind {
            SourceKind::Mesh(own) => own.measures.kind,
            SourceKind::Pattern(_) => offer.as_ref().map(|offer| offer.kind),
        };
        let unsized_code = || vec![own::UNKNOWN.to_owned()];
        let sizes = offer.as_ref().map_or_else(unsized_code, |o| o.sizes.iter().map(|s| s.code.clone()).collect());
        let WornPlace { layer, place, held, covers } = WornPlace::of(kind);
        let layer = match &source.kind {
            SourceKind::Pattern(package) => package.layer.map_or(layer, Layer::of),
            SourceKind::Mesh(_) => layer,
        };
        let colours = palette(kind.unwrap_or(GarmentKind::Dress), source.fabric()?.colour);
        Ok(Self {
            name: source.name.clone(),
            article: None,
            price: None,
            photograph: None,
            stamp: file::stamp(Path::new(&source.name)),
            title: title(source),
            offer,
            population: source.population()?,
            sizes,
            colours,
            layer,
            place,
            held,
            covers,
        })
    }

    /// Its name in words of the pages; none for a garment that has no word there, which goes by its title.
    pub const fn word(&self) -> Option<TextKey> {
        match self.title {
            ItemName::Word(key) => Some(key),
            ItemName::Title(_) | ItemName::Words(_) => None,
        }
    }

    /// Its title in a language, where it has no word.
    pub fn title(&self, language: &str) -> &str {
        match &self.title {
            ItemName::Word(key) => key.name(),
            ItemName::Title(title) => title,
            ItemName::Words(words) => word(words, language),
        }
    }

    /// Whether it goes by a name or an article number.
    fn is(&self, name: &str) -> bool {
        self.name == name || self.article.as_deref() == Some(name)
    }

    /// Whether both cannot be worn at once: of one layer, over the same half of the body.
    pub fn excludes(&self, other: &Self) -> bool {
        self.layer == other.layer && self.covers.iter().any(|half| other.covers.contains(half))
    }
}

/// The average body, on which garments made for no particular body are judged.
fn average() -> Result<Body, KioskError> {
    toile_assets::body::build(Sex::Female, &Measures::average(Sex::Female)).map_err(KioskError::internal)
}

fn title(source: &GarmentSource) -> ItemName {
    let key = STOCK.iter().find(|(name, _)| *name == source.name).map(|(_, key)| *key);
    match (key, &source.kind) {
        (Some(key), _) => ItemName::Word(key),
        (None, SourceKind::Pattern(package)) => {
            let drafted = drafting::style(&package.name).map(DraftStyle::title);
            ItemName::Title(drafted.unwrap_or_else(|| package.name.clone()))
        }
        (None, SourceKind::Mesh(own)) => {
            let file = Path::new(&source.name).file_stem().map(|stem| stem.to_string_lossy().into_owned());
            ItemName::Title(own.measures.name.clone().or(file).unwrap_or_else(|| source.name.clone()))
        }
    }
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
    /// How a shop's screens look.
    pub theme: Option<Arc<ShopTheme>>,
}

impl Wardrobe {
    /// The garments that are built in, in the order of dressing.
    ///
    /// # Errors
    /// A garment whose file, sizes or fabric cannot be used.
    pub fn stock() -> Result<Self, KioskError> {
        let average = average()?;
        let hung = |(name, _): &(&str, TextKey)| WardrobeItem::of(&GarmentSource::find(name)?, &average);
        Ok(Self::hung(STOCK.iter().map(hung).collect::<Result<_, KioskError>>()?, None))
    }

    /// What hangs of a stock: a shop's own garments, or those that are built in, and what is worn first besides. What cannot be used
    /// is left out and added to the list; what hung before and has not changed is taken over.
    ///
    /// # Errors
    /// A garment that is worn first and cannot hang.
    pub fn of(stock: &Stock, before: Option<&Self>, left_out: &mut Vec<LeftOut>) -> Result<Self, KioskError> {
        let average = average()?;
        let mut items = Vec::new();
        match &stock.catalogue {
            Some(catalogue) => {
                let known: BTreeMap<&str, &WardrobeItem> =
                    before.into_iter().flat_map(|before| &before.items).map(|item| (&*item.name, item)).collect();
                for item in &catalogue.items {
                    let name = item.path.display().to_string();
                    let same = known.get(&*name).filter(|hung| hung.stamp == Some(item.stamp));
                    match same.map_or_else(|| WardrobeItem::of_package(item, &average), |hung| Ok((*hung).clone())) {
                        Ok(hung) => items.push(hung),
                        Err(why) => left_out.push(LeftOut::new(&name, &why)),
                    }
                }
            }
            None => items = Self::stock()?.items,
        }
        for garment in &stock.first.garments {
            if !items.iter().any(|item| item.is(&garment.name)) {
                items.push(WardrobeItem::of(&*garment.source()?, &average)?);
            }
        }
        Ok(Self::hung(items, stock.catalogue.as_ref().and_then(|catalogue| catalogue.theme.clone())))
    }

    fn hung(mut items: Vec<WardrobeItem>, theme: Option<Arc<ShopTheme>>) -> Self {
        items.sort_by_key(|item| (item.layer, item.place));
        Self { items, theme }
    }

    /// The place of a garment by its name or article number.
    pub fn find(&self, name: &str) -> Option<usize> {
        self.items.iter().position(|item| item.is(name))
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
    use crate::service::config::Config;

    fn wardrobe() -> Wardrobe {
        Wardrobe::stock().unwrap()
    }

    fn wear(names: &[&str]) -> Vec<String> {
        let wardrobe = wardrobe();
        let worn = |name: &&str| WornItem { item: wardrobe.find(name).unwrap(), size: 0, colour: 0 };
        let outfit = names.iter().map(worn).fold(Outfit::new(), |outfit, w| wardrobe.put_on(&outfit, w));
        outfit.iter().map(|w| wardrobe.items[w.item].name.clone()).collect()
    }

    #[test]
    fn the_order_of_putting_on_does_not_change_the_order_of_wearing() {
        assert_eq!(wear(&["tee", "wide-leg-trousers"]), ["wide-leg-trousers", "tee"]);
        assert_eq!(wear(&["wide-leg-trousers", "tee"]), ["wide-leg-trousers", "tee"]);
    }

    #[test]
    fn a_dress_takes_the_place_of_shirt_and_trousers_and_they_of_it() {
        assert_eq!(wear(&["tee", "wide-leg-trousers", "strap-dress"]), ["strap-dress"]);
        assert_eq!(wear(&["strap-dress", "wide-leg-trousers"]), ["wide-leg-trousers"]);
        assert_eq!(wear(&["tee", "tee"]), ["tee"], "nothing is worn twice");
    }

    #[test]
    fn a_jacket_goes_over_whatever_else_is_worn() {
        assert_eq!(wear(&["blazer", "tee", "wide-leg-trousers"]), ["wide-leg-trousers", "tee", "blazer"]);
        assert_eq!(wear(&["blazer", "strap-dress"]), ["strap-dress", "blazer"]);
    }

    #[test]
    fn layers_that_differ_never_exclude_each_other() {
        let mut wardrobe = wardrobe();
        for item in &mut wardrobe.items {
            let mut coat = item.clone();
            coat.layer = Layer::Scarf;
            assert!(!coat.excludes(item) && !item.excludes(&coat));
        }
    }

    #[test]
    fn every_garment_has_sizes_a_word_and_colours_with_names_of_their_own() {
        for item in wardrobe().items {
            assert!(item.word().is_some() && item.sizes.len() >= 3, "{}", item.name);
            assert!((4..=5).contains(&item.colours.len()));
            let fabric = GarmentSource::find(&item.name).unwrap().fabric().unwrap();
            assert_eq!(item.colours[0].srgb, fabric.colour, "the first is the fabric's");
            // Only a colour that is none of ours has no name of its own.
            let woven = usize::from(item.colours[0].word == TextKey::ColourOwn);
            for (i, colour) in item.colours.iter().enumerate().skip(woven) {
                assert_ne!(colour.word, TextKey::ColourOwn, "{} has a colour without a name", item.name);
                assert!(item.colours[..i].iter().all(|c| c.word != colour.word));
            }
        }
        let strange = palette(GarmentKind::Dress, [0.1, 0.9, 0.1]);
        assert_eq!((strange[0].word, strange.len()), (TextKey::ColourOwn, 5));
    }

    /// A shop's folder with two packages, made for this test.
    fn shop(name: &str) -> std::path::PathBuf {
        let folder = std::env::temp_dir().join(format!("toile-hung-{name}-{}", std::process::id()));
        _ = std::fs::remove_dir_all(&folder);
        for (article, garment, more) in [
            ("DR-1", "strap-dress", "price = \"99.00 EUR\"\n"),
            (
                "JA-2",
                "blazer",
                "layer = 5\ncolours = [{ name = { en = \"Moss\", de = \"Moos\" }, srgb = [0.3, 0.4, 0.2] }]\n",
            ),
        ] {
            let source = folder.join(article);
            std::fs::create_dir_all(&source).unwrap();
            let text = format!(
                "article = \"{article}\"\ngarment = \"{garment}\"\nname = {{ en = \"Ours\", de = \"Unser\" }}\n{more}"
            );
            std::fs::write(source.join("garment.toml"), text).unwrap();
            let (bytes, _) = toile_assets::catalogue::package::pack(&source).unwrap();
            std::fs::write(folder.join(format!("{article}.toile")), bytes).unwrap();
        }
        std::fs::write(folder.join("broken.toile"), "nothing").unwrap();
        std::fs::write(folder.join("catalogue.toml"), "shop = \"Corner shop\"\n").unwrap();
        folder
    }

    #[test]
    fn a_shops_own_garments_hang_in_place_of_the_stock() {
        let folder = shop("own");
        let stock = |named: &[&str]| {
            let mut config = Config::default();
            config.wear.catalogue = Some(folder.clone());
            config.wear.garments = named.iter().map(|name| (*name).to_owned()).collect();
            config.wear.is_named = true;
            Stock::read(&config)
        };
        let own = stock(&["DR-1"]).unwrap();
        let hung = Wardrobe::of(&own, None, &mut Vec::new()).unwrap();
        assert_eq!((hung.items.len(), own.left_out.len()), (2, 1), "{:?}", own.left_out);
        assert_eq!(own.left_out[0].name, "broken.toile");
        let [dress, coat] = ["DR-1", "JA-2"].map(|article| &hung.items[hung.find(article).unwrap()]);
        assert_eq!((dress.title("de"), dress.title("tr"), dress.word()), ("Unser", "Ours", None));
        assert_eq!(
            (dress.price.as_ref().map(ToString::to_string).as_deref(), dress.layer),
            (Some("99.00 EUR"), Layer::Shirt)
        );
        assert_eq!((coat.layer, coat.colours.len()), (Layer::Coat, 1));
        assert_eq!(coat.colours[0].words.as_ref().map(|words| word(words, "de")), Some("Moos"));
        assert!(dress.sizes.len() > 3 && dress.name.ends_with("DR-1.toile"));
        // Garments that are named besides hang there as well; an unknown name is refused.
        let more = Wardrobe::of(&stock(&["tee"]).unwrap(), Some(&hung), &mut Vec::new()).unwrap();
        assert_eq!(more.items.len(), 3);
        assert!(stock(&["DR-9"]).is_err());
        std::fs::remove_dir_all(&folder).unwrap();
    }
}
