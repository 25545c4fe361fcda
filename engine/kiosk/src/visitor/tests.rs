//! Whole visits: the model, its pages and its texts, driven as sensor, finger, keyboard and dressing worker drive them.

mod own_face;
mod own_measures;
mod privacy;
mod shelves;
mod texts;
mod turns;
mod visits;

use std::collections::BTreeSet;
use std::sync::{Arc, LazyLock};

use super::model::{Effect, Input, VisitDefaults, VisitModel, VisitTimes};
use super::own_face::FaceTrouble;
use super::picture::{self, PictureCode};
use super::picture_store::{OfferedPicture, PictureLink};
use super::presence::Presence;
use super::reach::DisplayMount;
use super::screen::{Action, Page, Screen};
use super::size_fit::VisitorMeasures;
use super::size_fit::tests::woman;
use super::texts::{Language, Texts};
use super::wardrobe::Wardrobe;
use crate::service::session;
use toile_track::tape_readings::TapeReadings;
use toile_view::image::Size;

const MS: u64 = 1_000_000;

/// The garments that are built in, and all texts: read once for all visits.
static STOCK: LazyLock<Arc<Wardrobe>> = LazyLock::new(|| Arc::new(Wardrobe::stock().unwrap()));
static TEXTS: LazyLock<Texts> = LazyLock::new(|| Texts::load().unwrap());

/// Time between two polls.
const LOOK: u64 = 20 * MS;

fn defaults() -> VisitDefaults {
    let session = session::SessionTimes { step_in_ns: 500 * MS, step_out_ns: 2_000 * MS, wipe_ns: 5_000 * MS };
    VisitDefaults {
        times: VisitTimes::usual(session, 1_000 * MS, 180_000 * MS),
        language: Language::English,
        large: false,
        wear: vec!["strap-dress".into()],
        size: None,
        tape: TapeReadings::default(),
        motion: true,
        own_picture: false,
    }
}

/// A visit that is played, with a dressing worker that answers within a second.
pub(crate) struct Play {
    model: VisitModel,
    texts: &'static Texts,
    now: u64,
    /// Replies of the dressing worker that are due, and when.
    due: Vec<(u64, Input)>,
    known: VisitorMeasures,
    /// Effects in the order in which they were given.
    effects: Vec<Effect>,
    pages: BTreeSet<Page>,
    /// Whether the dressing worker fails.
    fails: bool,
    /// The link that pictures come with, where they are served.
    link: Option<PictureLink>,
    /// What becomes of a face that is taken.
    face: Result<(), FaceTrouble>,
}

impl Play {
    pub(crate) fn new() -> Self {
        Self {
            model: VisitModel::new(defaults(), STOCK.clone(), 0),
            texts: &TEXTS,
            now: 0,
            due: Vec::new(),
            known: woman(0.901, 0.738, 0.980),
            effects: Vec::new(),
            pages: BTreeSet::new(),
            fails: false,
            link: None,
            face: Ok(()),
        }
    }

    /// With a person measured and dressed.
    pub(crate) fn dressed() -> Self {
        let mut play = Self::new();
        play.see(Some(1));
        play.wait(6_000);
        assert_eq!(play.model.page(), Page::Fitting);
        play
    }

    fn update(&mut self, input: Input) {
        for effect in self.model.update(self.now, input) {
            let in_a_second = self.now + 700 * MS;
            let code =
                || OfferedPicture { link: self.link.clone(), own: Some(PictureCode { side: 3, dark: vec![true; 9] }) };
            let reply = match &effect {
                Effect::Measure { number, .. } | Effect::MeasureTurn { number } if self.fails => Input::Failed(*number),
                Effect::Measure { number, .. } | Effect::MeasureTurn { number } => {
                    Input::Measured(*number, Box::new(self.known.clone()))
                }
                Effect::Dress { number, .. } if self.fails => Input::Failed(*number),
                Effect::Dress { number, .. } => Input::Dressed(*number),
                Effect::DrapeTwo { number, .. } if self.fails => Input::Failed(*number),
                Effect::DrapeTwo { number, .. } => Input::Draped(*number),
                Effect::Snap { number, .. } if self.fails => Input::Failed(*number),
                Effect::Snap { number, .. } => Input::PictureTaken(*number, code()),
                Effect::TakeFace { number, .. } => Input::FaceTaken(*number, self.face),
                Effect::Hide | Effect::Forget => Input::Tick,
            };
            self.due.push((in_a_second, reply));
            self.effects.push(effect);
        }
        self.pages.insert(self.model.page());
    }

    pub(crate) fn see(&mut self, who: Option<u32>) {
        let seen = who.map(|who| Presence { people: 1, who: Some(who), head_mm: Some(1_560.0), ..Presence::default() });
        self.update(Input::Presence(seen.unwrap_or_default()));
    }

    /// The camera's picture can be shown, and this became of the last one.
    pub(crate) fn picture_is(&mut self, outcome: u8) {
        self.update(Input::OwnPicture(outcome));
    }

    /// Faces can be taken, and this becomes of them.
    pub(crate) fn offer_faces(&mut self, face: Result<(), FaceTrouble>) {
        self.model.offer_faces();
        self.face = face;
    }

    /// The first shopper is seen in depth, facing so far to their left (rad).
    pub(crate) fn face(&mut self, facing: f32) {
        let seen = Presence {
            people: 1,
            who: Some(1),
            head_mm: Some(1_560.0),
            facing: Some(facing),
            depth: true,
            ..Presence::default()
        };
        self.update(Input::Presence(seen));
    }

    /// Hides the hip of the measured person.
    pub(crate) fn hide_hip(&mut self) {
        self.known.measured.measures.hip_girth = None;
        self.known = VisitorMeasures::new(self.known.measured.clone(), false);
    }

    /// Lets time pass (ms).
    pub(crate) fn wait(&mut self, ms: u64) {
        let end = self.now + ms * MS;
        while self.now < end {
            self.now += LOOK;
            let now = self.now;
            let (due, later) = std::mem::take(&mut self.due).into_iter().partition(|(at, _)| *at <= now);
            self.due = later;
            due.into_iter().for_each(|(_, reply): (u64, Input)| self.update(reply));
            self.update(Input::Tick);
        }
    }

    pub(crate) fn press(&mut self, action: Action) {
        assert!(self.screen().controls.iter().any(|c| c.action == action), "{action:?} on {:?}", self.model.page());
        self.update(Input::Pressed(action));
    }

    pub(crate) fn screen(&self) -> Screen {
        Screen::of(&self.model, self.texts, &DisplayMount::default())
    }

    pub(crate) fn page(&self) -> Page {
        self.model.page()
    }
}

/// Numbers that look random and are the same each time.
struct Dice(u64);

impl Dice {
    fn below(&mut self, bound: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as usize % bound
    }
}

/// All of a screen's words.
fn texts_of(screen: &Screen) -> Vec<String> {
    use super::screen::Block;
    let mut all = vec![screen.heading.clone()];
    for block in &screen.blocks {
        match block {
            Block::Text(text)
            | Block::Progress { label: text, .. }
            | Block::Fit { text, .. }
            | Block::Entry { text } => all.push(text.clone()),
            Block::Legend { ends } => all.extend(ends.clone()),
            Block::PoseGuide { .. } | Block::TurnGuide { .. } | Block::Code { .. } | Block::Countdown { .. } => {}
        }
    }
    for control in &screen.controls {
        all.push(control.label.clone());
        all.extend(control.detail.clone());
    }
    all
}

/// A picture of a person.
fn still() -> picture::RgbImage {
    picture::tests::figure(Size::new(96, 160), [180, 80, 70])
}
