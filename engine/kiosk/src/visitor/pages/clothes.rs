//! The fitted body and the garments to choose from.

use super::super::colours::Colour;
use super::super::screen::{Block, ControlStyle, Page};
use super::super::size_fit::{OutOfRange, SizeChoice};
use super::super::texts::{TextKey, TextValue};
use super::PageWriter;
use toile_assets::catalogue::{Price, word};
use toile_view::image::linear;

/// As sure as this, a size is simply the best.
const SURE: f32 = toile_track::recommend::SURE;

/// What is said where there is no size to choose.
const fn only(choice: SizeChoice) -> Option<TextKey> {
    match choice {
        SizeChoice::Several => None,
        SizeChoice::One => Some(TextKey::FittingOneSize),
        SizeChoice::Unknown => Some(TextKey::FittingSizeUnknown),
    }
}

impl PageWriter<'_> {
    pub(super) fn worn_heading(&self) -> String {
        let (Some(item), Some(worn)) = (self.item(), self.model.worn()) else { return self.words(TextKey::DoGarments) };
        let name = self.garment(item);
        if self.model.visit.fit.as_ref().is_some_and(|fit| only(fit.choice).is_some()) {
            return name;
        }
        self.format(
            TextKey::FittingSize,
            &[("garment", TextValue::Text(&name)), ("size", TextValue::Text(self.size(worn.size)))],
        )
    }

    pub(super) fn fitting(&self) -> Vec<Block> {
        let mut blocks = Vec::new();
        let visit = &self.model.visit;
        if visit.dressing.is_some() {
            blocks.push(Block::Progress { share: 0.5, label: self.words(TextKey::FittingDressing) });
        }
        if visit.refused {
            blocks.push(self.paragraph(TextKey::FittingRefused));
        }
        let Some(fit) = &visit.fit else { return blocks };
        let percent = ("percent", TextValue::Count((100.0 * fit.probability).round() as u32));
        if let Some(key) = only(fit.choice) {
            blocks.push(self.paragraph(key));
        } else if fit.size == fit.best {
            let size = TextValue::Text(self.size(fit.size));
            // What is tight or loose somewhere is the best there is, and no more.
            let best = if fit.is_comfortable() { TextKey::FittingBest } else { TextKey::FittingNearest };
            let best = self.format(best, &[("size", size)]);
            let how = if fit.probability >= SURE { TextKey::FittingSure } else { TextKey::FittingUnsure };
            blocks.push(Block::Text(format!("{best} {}", self.format(how, &[percent]))));
        } else {
            let size = TextValue::Text(self.size(fit.best));
            blocks.push(Block::Text(self.format(TextKey::FittingBetter, &[("size", size)])));
        }
        // Who sees themselves reads less beside: the word on their picture, and what to take by tape only without one, where the page leads on to it.
        let has_room = self.own_picture(Page::Fitting).is_none() && !self.model.is_crowded();
        if let Some(zone) = fit.girth_to_take.filter(|_| has_room) {
            let zone = self.part(zone);
            blocks.push(Block::Text(self.format(TextKey::FittingTape, &[("zone", TextValue::Text(&zone))])));
        }
        match fit.outside {
            Some(OutOfRange::Smaller) => blocks.push(self.paragraph(TextKey::FittingSmaller)),
            Some(OutOfRange::Larger) => blocks.push(self.paragraph(TextKey::FittingLarger)),
            None => {}
        }
        blocks.extend(fit.zones.iter().map(|zone| self.fit_block(zone)));
        blocks
    }

    pub(super) fn garments(&self) -> Vec<Block> {
        let worn = self.model.worn();
        let Some(colour) = worn.map(|w| self.colour_name(w.colour)) else { return Vec::new() };
        let mut blocks = vec![Block::Text(self.worn_heading())];
        blocks.push(Block::Text(self.format(TextKey::ColourOf, &[("colour", TextValue::Text(&colour))])));
        if self.model.visit.refused {
            blocks.push(self.paragraph(TextKey::FittingRefused));
        }
        blocks
    }

    pub(super) fn colour_name(&self, colour: usize) -> String {
        let language = self.translation.language().tag();
        let named = |c: &Colour| match &c.words {
            Some(words) => word(words, language).to_owned(),
            None => self.words(c.word),
        };
        self.item().and_then(|item| item.colours.get(colour)).map(named).unwrap_or_default()
    }

    /// A garment's name, and what pressing it does.
    pub(super) fn garment_label(&self, place: usize) -> (String, Option<String>) {
        let wardrobe = &self.model.wardrobe.items;
        let Some(item) = wardrobe.get(place) else { return Default::default() };
        let visit = &self.model.visit;
        let worn = visit.outfit.iter().any(|w| w.item == place);
        let detail = if worn && visit.in_hand == place && visit.outfit.len() > 1 {
            Some(self.words(TextKey::GarmentsTakeOff))
        } else if worn {
            Some(self.words(TextKey::GarmentsWorn))
        } else {
            let off = visit.outfit.iter().filter_map(|w| wardrobe.get(w.item)).filter(|other| other.excludes(item));
            let names: Vec<String> = off.map(|other| self.garment(other)).collect();
            let others = self.translation.list(&names);
            let instead = || self.format(TextKey::GarmentsInstead, &[("others", TextValue::Text(&others))]);
            (!names.is_empty()).then(instead)
        };
        let price = item.price.as_ref().map(|price| self.price(price));
        // A tile has no room for what its check mark says, nor for what comes off.
        let is_tile = matches!(self.garment_style(place), ControlStyle::Tile(_));
        let detail = detail.filter(|_| !is_tile || price.is_none() || (worn && visit.in_hand == place));
        let both: Vec<String> = price.into_iter().chain(detail).collect();
        (self.garment(item), (!both.is_empty()).then(|| both.join(" \u{b7} ")))
    }

    /// Garments are tiles where one of those that are shown has a photograph.
    pub(super) fn garment_style(&self, place: usize) -> ControlStyle {
        let items = &self.model.wardrobe.items;
        let shown = || self.model.shelf().filter_map(|place| items.get(place));
        let colour = items.get(place).and_then(|item| item.colours.first()).map(|colour| colour.srgb.map(linear));
        match colour {
            Some(colour) if shown().any(|item| item.photograph.is_some()) => ControlStyle::Tile(colour),
            _ => ControlStyle::Plain,
        }
    }

    /// The garments before or after, and which of all those are.
    pub(super) fn shelf_label(&self, step: i8) -> (String, Option<String>) {
        let key = if step < 0 { TextKey::DoGarmentsBefore } else { TextKey::DoGarmentsMore };
        let place = format!("{} / {}", self.model.visit.shelf + 1, self.model.shelves());
        (self.words(key), (step > 0).then_some(place))
    }

    /// A price as the language writes it.
    pub(super) fn price(&self, price: &Price) -> String {
        price.to_string().replace('.', &self.translation.language().decimal_mark().to_string())
    }

    /// The size before or after, and which that is.
    pub(super) fn size_label(&self, page: Page, step: i8) -> (String, Option<String>) {
        let worn = self.model.worn().map(|w| w.size);
        let pair = self.model.visit.pair.as_ref();
        let (from, but) = if page == Page::Compare { (pair.map(|p| p.other.size), worn) } else { (worn, None) };
        let key = if step < 0 { TextKey::DoSmaller } else { TextKey::DoLarger };
        let next = from.and_then(|from| self.model.beside(from, step, but));
        let named = |size| self.format(TextKey::DoSize, &[("size", TextValue::Text(self.size(size)))]);
        (self.words(key), next.map(named))
    }

    pub(super) fn wear_label(&self) -> (String, Option<String>) {
        let size = self.model.visit.pair.as_ref().map_or("", |pair| self.size(pair.other.size));
        (self.format(TextKey::DoWear, &[("size", TextValue::Text(size))]), None)
    }
}
