//! Pages: the machine's page as a screen, in words.

mod clothes;
mod fit;
mod visit;

use super::fitting::Part;
use super::layout::Mount;
use super::model::Model;
use super::screen::{Action, Block, Control, Look, Page, Screen, Stage};
use super::shelf::Item;
use super::visit::Taking;
use super::words::{Key, Language, Value, Voice, Words};
use toile_view::image::linear;

/// Large type, as a multiple of the ordinary one.
const LARGE: f32 = 1.35;

impl Screen {
    /// The screen of a moment, in the shopper's language, with its controls where they reach them.
    pub fn of(model: &Model, words: &Words, mount: &Mount) -> Self {
        let teller = Teller { model, words, voice: words.of(model.language()) };
        let band = mount.band(model.visit.head_mm);
        let page = model.page();
        Self {
            page,
            heading: teller.heading(page),
            blocks: teller.blocks(page),
            controls: model.actions().iter().map(|action| teller.control(page, *action)).collect(),
            focus: model.focus,
            stage: model.stage(page),
            type_scale: if model.visit.large { LARGE } else { 1.0 },
            reach: band.high,
            reach_low: band.low,
            colours: model.colours(),
            language: model.language().tag(),
        }
    }
}

impl Model {
    /// What stands behind a page.
    fn stage(&self, page: Page) -> Stage {
        let visit = &self.visit;
        let yaw = self.yaw();
        let shown = visit.dressed && !visit.hidden;
        match page {
            Page::Compare if shown && visit.pair.as_ref().is_some_and(|p| p.asked.is_none() && !p.refused) => {
                Stage::Two { yaw }
            }
            Page::Fitting | Page::Garments | Page::Compare | Page::Picture | Page::Settings | Page::Unmeasured
                if shown =>
            {
                Stage::Shopper { yaw, fit: false }
            }
            Page::Zones | Page::Zone if shown => Stage::Shopper { yaw, fit: visit.fit_map },
            _ => Stage::Mannequin,
        }
    }

    /// Colours of what stands on the stage.
    fn colours(&self) -> Vec<[f32; 3]> {
        let worn = if self.visit.worn.is_empty() { &self.visit.outfit } else { &self.visit.worn };
        let colour = |w: &super::shelf::Worn| self.shelf.items.get(w.item)?.colours.get(w.colour);
        worn.iter().filter_map(colour).map(|c| c.srgb.map(linear)).collect()
    }
}

/// A model in a language.
struct Teller<'a> {
    model: &'a Model,
    words: &'a Words,
    voice: Voice<'a>,
}

impl Teller<'_> {
    fn say(&self, key: Key) -> String {
        self.voice.say(key)
    }

    fn tell(&self, key: Key, values: &[(&str, Value)]) -> String {
        self.voice.tell(key, values)
    }

    fn text(&self, key: Key) -> Block {
        Block::Text(self.say(key))
    }

    /// The name of a garment.
    fn garment(&self, item: &Item) -> String {
        item.word().map_or_else(|| item.style.title.clone(), |key| self.say(key))
    }

    /// The garment in hand.
    fn item(&self) -> Option<&Item> {
        self.model.shelf.items.get(self.model.visit.in_hand)
    }

    /// The code of a size of the garment in hand.
    fn size(&self, size: usize) -> &str {
        self.item().and_then(|item| item.sizes.get(size)).map_or("", String::as_str)
    }

    /// Whether somebody was measured, but not all of them.
    fn is_partly(&self) -> bool {
        self.model.visit.known.is_some() && self.model.visit.taking != Taking::Failed
    }

    fn parts(&self, parts: &[Part]) -> String {
        let words: Vec<String> = parts.iter().map(|part| self.say(part.word())).collect();
        self.voice.list(&words)
    }

    fn heading(&self, page: Page) -> String {
        let model = self.model;
        match page {
            Page::Attract => self.say(Key::AttractHeading),
            Page::Guide if model.visit.seated => self.say(Key::GuideHeadingSeated),
            Page::Guide => self.say(Key::GuideHeading),
            Page::Measuring => self.say(Key::MeasuringHeading),
            Page::Unmeasured if self.is_partly() => self.say(Key::PartlyHeading),
            Page::Unmeasured => self.say(Key::UnmeasuredHeading),
            Page::Fitting => self.worn_heading(),
            Page::Garments => self.say(Key::GarmentsHeading),
            Page::Zones => self.zones_heading(),
            Page::Zone => self.zone_heading(),
            Page::Compare => self.compare_heading(),
            Page::Picture => self.say(Key::PictureHeading),
            Page::Settings => self.say(Key::SettingsHeading),
            Page::Second => self.say(Key::SecondHeading),
            Page::Leaving => self.say(Key::LeavingHeading),
        }
    }

    fn blocks(&self, page: Page) -> Vec<Block> {
        match page {
            Page::Attract => self.attract(),
            Page::Guide => self.guide(),
            Page::Measuring => self.measuring(),
            Page::Unmeasured => self.unmeasured(),
            Page::Fitting => self.fitting(),
            Page::Garments => self.garments(),
            Page::Zones => self.zones(),
            Page::Zone => self.zone(),
            Page::Compare => self.compare(),
            Page::Picture => self.picture(),
            Page::Settings => self.settings(),
            Page::Second => self.second(),
            Page::Leaving => self.leaving(),
        }
    }

    fn control(&self, page: Page, action: Action) -> Control {
        let (label, detail) = self.label(page, action);
        Control { action, label, detail, look: self.look(page, action), chosen: self.is_chosen(action) }
    }

    fn label(&self, page: Page, action: Action) -> (String, Option<String>) {
        let key = match action {
            Action::Garment(item) => return self.garment_label(item),
            Action::Colour(colour) => return (self.colour_name(colour), None),
            Action::Zone(zone) => return self.zone_label(zone),
            Action::Size(step) => return self.size_label(page, step),
            Action::Wear => return self.wear_label(),
            Action::Language(place) => return self.language_label(place),
            Action::Begin if page == Page::Second => Key::DoBeginAnew,
            Action::Begin => Key::DoBegin,
            Action::Measure if page == Page::Guide => Key::DoMeasure,
            Action::Measure => Key::DoMeasureAgain,
            Action::Open(Page::Garments) => Key::DoGarments,
            Action::Open(Page::Zones) => Key::DoZones,
            Action::Open(Page::Compare) => Key::DoCompare,
            Action::Open(Page::Picture) => Key::DoShowPicture,
            Action::Open(_) => Key::DoSettings,
            Action::Back if page == Page::Unmeasured => Key::DoGoOn,
            Action::Back => Key::DoBack,
            Action::Turn(eighths) if eighths < 0 => Key::DoTurnLeft,
            Action::Turn(_) => Key::DoTurnRight,
            Action::FitMap => Key::DoFitMap,
            Action::TakePicture => Key::DoPicture,
            Action::DeletePicture => Key::DoDeletePicture,
            Action::Stay if page == Page::Second => Key::DoStillMe,
            Action::Stay => Key::DoStay,
            Action::Leave => Key::DoLeave,
            Action::LargeType => Key::DoLarge,
            Action::Seated => Key::DoSeated,
        };
        (self.say(key), None)
    }

    fn look(&self, page: Page, action: Action) -> Look {
        match (page, action) {
            (_, Action::Colour(place)) => {
                let colour = self.item().and_then(|item| item.colours.get(place));
                colour.map_or(Look::Plain, |c| Look::Swatch(c.srgb.map(linear)))
            }
            (Page::Attract, Action::Begin)
            | (Page::Guide | Page::Unmeasured, Action::Measure)
            | (Page::Fitting, Action::Open(Page::Garments))
            | (Page::Compare, Action::Wear)
            | (Page::Picture, Action::DeletePicture | Action::TakePicture)
            | (Page::Second | Page::Leaving, Action::Stay) => {
                if page == Page::Unmeasured && self.is_partly() {
                    Look::Plain
                } else {
                    Look::Primary
                }
            }
            (Page::Unmeasured, Action::Back) if self.is_partly() => Look::Primary,
            (_, Action::Back | Action::Leave | Action::Open(Page::Settings) | Action::LargeType) => Look::Quiet,
            (Page::Attract, Action::Language(_)) => Look::Quiet,
            _ => Look::Plain,
        }
    }

    fn is_chosen(&self, action: Action) -> bool {
        let visit = &self.model.visit;
        match action {
            Action::Garment(item) => visit.outfit.iter().any(|w| w.item == item),
            Action::Colour(colour) => self.model.worn().is_some_and(|w| w.colour == colour),
            Action::FitMap => visit.fit_map,
            Action::Language(place) => Language::ALL.get(place) == Some(&visit.language),
            Action::LargeType => visit.large,
            Action::Seated => visit.seated,
            _ => false,
        }
    }

    /// A language in its own words, whatever is spoken at the moment.
    fn language_label(&self, place: usize) -> (String, Option<String>) {
        let language = Language::ALL.get(place).copied().unwrap_or_default();
        (self.words.of(language).say(Key::Language), None)
    }
}
