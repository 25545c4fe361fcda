//! Pages: the model's page as a screen, in words, within 0.2 ms.

mod clothes;
mod face;
mod fit;
mod own_measures;
mod visit;

use super::measure_entry::{LengthUnit, OwnMeasure};
use super::model::VisitModel;
use super::plain;
use super::reach::DisplayMount;
use super::screen::{
    Action, Block, BodyView, Control, ControlStyle, JudgedGarment, Page, Screen, ScreenPicture, ScreenTheme,
};
use super::size_fit::{BodyPart, VisitorMeasures};
use super::texts::{Language, TextKey, TextValue, Texts, Translation};
use super::visit::MeasureProgress;
use super::wardrobe::WardrobeItem;
use toile_assets::sizes::Girth;
use toile_sensors::source::live::CameraState;
use toile_view::image::linear;

/// Large type, as a multiple of the ordinary one.
const LARGE: f32 = 1.35;

impl Screen {
    /// The screen of a moment, in the shopper's language, with its controls where they reach them.
    pub fn of(model: &VisitModel, texts: &Texts, mount: &DisplayMount) -> Self {
        let writer = PageWriter { model, texts, translation: texts.of(model.language()) };
        let band = mount.band(model.visit.head_mm);
        let page = model.page();
        let theme = ScreenTheme(model.wardrobe.theme.clone());
        let has_logo = matches!(page, Page::Attract | Page::Garments);
        Self {
            page,
            heading: writer.heading(page),
            blocks: writer.camera().into_iter().chain(writer.own_picture(page)).chain(writer.blocks(page)).collect(),
            controls: model.actions().iter().map(|action| writer.control(page, *action)).collect(),
            focus: model.focus,
            body_view: model.body_view(page),
            type_scale: if model.visit.large { LARGE } else { 1.0 },
            reach: band.high,
            reach_low: band.low,
            colours: model.colours(),
            language: model.language().tag(),
            logo: theme.0.as_ref().and_then(|theme| theme.logo.clone()).filter(|_| has_logo).map(ScreenPicture),
            theme,
        }
    }
}

impl VisitModel {
    /// The body that is shown behind a page.
    fn body_view(&self, page: Page) -> BodyView {
        let visit = &self.visit;
        let yaw = self.yaw();
        let shown = visit.dressed && !visit.hidden;
        match page {
            Page::Compare if shown && visit.pair.as_ref().is_some_and(|p| p.asked.is_none() && !p.refused) => {
                BodyView::Two { yaw }
            }
            page if self.shows_body(page) => {
                let own_picture = self.sees_themselves() && page != Page::Face;
                BodyView::Shopper { yaw, fit: false, unknown: [false; 3], judged: None, own_picture }
            }
            Page::Zones | Page::Zone if shown => {
                let unknown = visit.known.as_ref().map_or([false; 3], VisitorMeasures::unknown);
                BodyView::Shopper { yaw, fit: visit.fit_map, unknown, judged: self.judged(), own_picture: false }
            }
            _ => BodyView::Mannequin,
        }
    }

    /// The garment in hand as it was judged; none while another body than the one it was judged on is shown.
    fn judged(&self) -> Option<JudgedGarment> {
        let visit = &self.visit;
        let worn = if visit.worn.is_empty() { &visit.outfit } else { &visit.worn };
        let place = worn.iter().position(|w| w.item == visit.in_hand)?;
        let fit = visit.fit.as_ref().filter(|fit| fit.size == worn[place].size)?;
        let at = |girth: Girth| fit.zones.iter().find(|z| z.zone == girth).and_then(|z| z.tightness);
        Some(JudgedGarment { place, tightness: [Girth::Chest, Girth::Waist, Girth::Hip].map(at) })
    }

    /// Colours of the garments that are shown.
    fn colours(&self) -> Vec<[f32; 3]> {
        let worn = if self.visit.worn.is_empty() { &self.visit.outfit } else { &self.visit.worn };
        let colour = |w: &super::wardrobe::WornItem| self.wardrobe.items.get(w.item)?.colours.get(w.colour);
        worn.iter().filter_map(colour).map(|c| c.srgb.map(linear)).collect()
    }
}

/// A model in a language.
struct PageWriter<'a> {
    model: &'a VisitModel,
    texts: &'a Texts,
    translation: Translation<'a>,
}

impl PageWriter<'_> {
    /// What is said above all else while the camera sees nothing.
    fn camera(&self) -> Option<Block> {
        let key = match self.model.camera {
            CameraState::Lost | CameraState::Frozen => TextKey::CameraLost,
            CameraState::Covered => TextKey::CameraCovered,
            CameraState::Starting | CameraState::Seeing => return None,
        };
        Some(Block::Text(self.words(key)))
    }

    /// Why the clothes are not on their own picture, or that the picture is kept nowhere.
    fn own_picture(&self, page: Page) -> Option<Block> {
        let shows = matches!(self.model.body_view(page), BodyView::Shopper { own_picture: true, .. });
        let outcome = self.model.own_picture.filter(|_| shows && page == Page::Fitting)?;
        Some(self.paragraph(plain::word(outcome).unwrap_or(TextKey::OwnPictureKept)))
    }

    fn words(&self, key: TextKey) -> String {
        self.translation.text(key)
    }

    fn format(&self, key: TextKey, values: &[(&str, TextValue)]) -> String {
        self.translation.format(key, values)
    }

    fn paragraph(&self, key: TextKey) -> Block {
        Block::Text(self.words(key))
    }

    /// The name of a garment.
    fn garment(&self, item: &WardrobeItem) -> String {
        let language = self.translation.language().tag();
        item.word().map_or_else(|| item.title(language).to_owned(), |key| self.words(key))
    }

    /// The garment in hand.
    fn item(&self) -> Option<&WardrobeItem> {
        self.model.wardrobe.items.get(self.model.visit.in_hand)
    }

    /// The code of a size of the garment in hand.
    fn size(&self, size: usize) -> &str {
        self.item().and_then(|item| item.sizes.get(size)).map_or("", String::as_str)
    }

    /// Whether a person was measured, but not all of them.
    fn is_partly(&self) -> bool {
        self.model.visit.known.is_some() && self.model.visit.progress != MeasureProgress::Failed
    }

    fn parts(&self, parts: &[BodyPart]) -> String {
        let words: Vec<String> = parts.iter().map(|part| self.words(part.word())).collect();
        self.translation.list(&words)
    }

    fn heading(&self, page: Page) -> String {
        let model = self.model;
        match page {
            Page::Attract => self.words(TextKey::AttractHeading),
            Page::Guide if model.visit.seated => self.words(TextKey::GuideHeadingSeated),
            Page::Guide => self.words(TextKey::GuideHeading),
            Page::Measuring => self.words(TextKey::MeasuringHeading),
            Page::Unmeasured if self.is_partly() => self.words(TextKey::PartlyHeading),
            Page::Unmeasured => self.words(TextKey::UnmeasuredHeading),
            Page::Fitting => self.worn_heading(),
            Page::Garments => self.words(TextKey::GarmentsHeading),
            Page::Zones => self.zones_heading(),
            Page::Zone => self.zone_heading(),
            Page::Compare => self.compare_heading(),
            Page::Picture => self.words(TextKey::PictureHeading),
            Page::Face => self.words(TextKey::FaceHeading),
            Page::OwnMeasures => self.words(TextKey::OwnHeading),
            Page::MeasureEntry => self.entry_heading(),
            Page::Settings => self.words(TextKey::SettingsHeading),
            Page::Second => self.words(TextKey::SecondHeading),
            Page::Leaving => self.words(TextKey::LeavingHeading),
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
            Page::Face => self.face(),
            Page::OwnMeasures => self.own_measures(),
            Page::MeasureEntry => self.entry(),
            Page::Settings => self.settings(),
            Page::Second => self.second(),
            Page::Leaving => self.leaving(),
        }
    }

    fn control(&self, page: Page, action: Action) -> Control {
        let (label, detail) = self.label(page, action);
        let item = if let Action::Garment(place) = action { self.model.wardrobe.items.get(place) } else { None };
        Control {
            action,
            label,
            detail,
            // What comes off is seen as soon as a garment is pressed; a price is not.
            is_detail_spare: item.is_some_and(|item| item.price.is_none()),
            style: self.style(page, action),
            chosen: self.is_chosen(action),
            picture: None,
        }
    }

    fn label(&self, page: Page, action: Action) -> (String, Option<String>) {
        let key = match action {
            Action::Garment(item) => return self.garment_label(item),
            Action::Colour(colour) => return (self.colour_name(colour), None),
            Action::Zone(zone) => return self.zone_label(zone),
            Action::Shelf(step) => return self.shelf_label(step),
            Action::Size(step) => return self.size_label(page, step),
            Action::Wear => return self.wear_label(),
            Action::Language(place) => return self.language_label(place),
            Action::OwnMeasure(place) => return self.own_measure_label(place),
            Action::Digit(digit) => return (digit.to_string(), None),
            Action::Point => return (self.translation.language().decimal_mark().to_string(), None),
            Action::Begin if page == Page::Second => TextKey::DoBeginAnew,
            Action::Begin => TextKey::DoBegin,
            Action::Measure if page == Page::Guide => TextKey::DoMeasure,
            Action::Measure => TextKey::DoMeasureAgain,
            Action::Open(Page::Garments) => TextKey::DoGarments,
            Action::Open(Page::Zones) => TextKey::DoZones,
            Action::Open(Page::Compare) => TextKey::DoCompare,
            Action::Open(Page::Picture) => TextKey::DoShowPicture,
            Action::Open(Page::OwnMeasures) => TextKey::DoOwnMeasures,
            Action::Open(Page::Face) => TextKey::DoFace,
            Action::Open(_) => TextKey::DoSettings,
            Action::Back if page == Page::Unmeasured => TextKey::DoGoOn,
            Action::Back => TextKey::DoBack,
            Action::Turn(eighths) if eighths < 0 => TextKey::DoTurnLeft,
            Action::Turn(_) => TextKey::DoTurnRight,
            Action::FitMap => TextKey::DoFitMap,
            Action::OwnPicture if self.model.visit.own_picture => TextKey::DoMannequin,
            Action::OwnPicture => TextKey::DoOwnPicture,
            Action::TakeFace if self.model.visit.face.is_untried() => TextKey::DoFacePutOn,
            Action::TakeFace => TextKey::DoFaceAgain,
            Action::RemoveFace => TextKey::DoFaceAway,
            Action::TakePicture => TextKey::DoPicture,
            Action::DeletePicture => TextKey::DoDeletePicture,
            Action::OtherCode if self.model.visit.picture.link().is_some() => TextKey::DoPictureOwn,
            Action::OtherCode => TextKey::DoPictureLink,
            Action::Stay if page == Page::Second => TextKey::DoStillMe,
            Action::Stay => TextKey::DoStay,
            Action::Leave => TextKey::DoLeave,
            Action::LargeType => TextKey::DoLarge,
            Action::Seated => TextKey::DoSeated,
            Action::DeleteDigit => TextKey::DoDelete,
            Action::Unit if self.model.visit.unit == LengthUnit::Inch => TextKey::DoCentimetres,
            Action::Unit => TextKey::DoInches,
            Action::Accept => TextKey::DoAccept,
            Action::RemoveMeasure => TextKey::DoRemove,
        };
        (self.words(key), None)
    }

    fn style(&self, page: Page, action: Action) -> ControlStyle {
        match (page, action) {
            (_, Action::Colour(place)) => {
                let colour = self.item().and_then(|item| item.colours.get(place));
                colour.map_or(ControlStyle::Plain, |c| ControlStyle::Swatch(c.srgb.map(linear)))
            }
            (Page::Attract, Action::Begin)
            | (Page::Guide | Page::Unmeasured, Action::Measure)
            | (Page::Fitting, Action::Open(Page::Garments))
            | (Page::Compare, Action::Wear)
            | (Page::Picture, Action::DeletePicture | Action::TakePicture)
            | (Page::MeasureEntry, Action::Accept)
            | (Page::Second | Page::Leaving, Action::Stay) => {
                if page == Page::Unmeasured && self.is_partly() {
                    ControlStyle::Plain
                } else {
                    ControlStyle::Primary
                }
            }
            (Page::Face, Action::TakeFace) if !self.model.visit.face.on => ControlStyle::Primary,
            (_, Action::Digit(_) | Action::Point | Action::DeleteDigit) => ControlStyle::Key,
            (Page::Unmeasured, Action::Back) if self.is_partly() => ControlStyle::Primary,
            (_, Action::Back | Action::Leave | Action::Open(Page::Settings) | Action::LargeType | Action::Unit) => {
                ControlStyle::Quiet
            }
            (_, Action::Garment(item)) => self.garment_style(item),
            (_, Action::Shelf(_)) => ControlStyle::Quiet,
            (Page::Attract, Action::Language(_)) => ControlStyle::Quiet,
            _ => ControlStyle::Plain,
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
            Action::OwnMeasure(place) => {
                OwnMeasure::ALL.get(place).is_some_and(|own| visit.tape.at(own.index()).is_some())
            }
            _ => false,
        }
    }

    /// A language in its own words, whatever is spoken at the moment.
    fn language_label(&self, place: usize) -> (String, Option<String>) {
        let language = Language::ALL.get(place).copied().unwrap_or_default();
        (self.texts.of(language).text(TextKey::Language), None)
    }
}
