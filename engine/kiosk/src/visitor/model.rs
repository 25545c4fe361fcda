//! The model: the pages as a state machine. It knows the time, the sensor's view, the input and the dressing worker's replies: a
//! window, a service without one and a test drive the same model.
//!
//! It builds on the state machine of [`crate::service::session`], which decides who has stepped in and who has left, and adds the pages.

use std::sync::Arc;

pub use super::message::{Effect, Effects, Input, NavigationKey, VisitDefaults, VisitTimes};
use super::own_face::FaceTrouble;
use super::presence::Presence;
use super::screen::Page;
use super::size_fit::{self, SizeFit, VisitorMeasures};
use super::texts::Language;
use super::visit::{ComparedSizes, MeasureProgress, OwnFace, ViewTurn, Visit};
use super::wardrobe::{Outfit, Wardrobe, WornItem};
use crate::service::session::{SessionInput, SessionMachine, SessionState};
use toile_fitting::dress::offer::GarmentOffer;
use toile_sensors::source::live::CameraState;

/// The model of a visit.
#[derive(Debug, Clone)]
pub struct VisitModel {
    pub(super) defaults: VisitDefaults,
    pub(super) wardrobe: Arc<Wardrobe>,
    pub(super) session: SessionMachine,
    pub(super) now_ns: u64,
    pub(super) seen: Presence,
    /// How the camera stands; seeing where there is none.
    pub(super) camera: CameraState,
    /// What became of the camera's last picture, where shoppers may see themselves ([`super::plain::code`]).
    pub(super) own_picture: Option<u8>,
    /// Whether shoppers may have their own face taken.
    pub(super) face_offered: bool,
    /// Since when no person is in view (ns), and whether the one who has said that they are done is still there.
    unseen_ns: u64,
    resting: bool,
    pub(super) visit: Visit,
    /// The place of the control that has the focus.
    pub(super) focus: usize,
    /// Number of the last effect.
    pub(super) number: u32,
}

impl VisitModel {
    /// No person is in view, at this time (ns).
    pub fn new(defaults: VisitDefaults, wardrobe: Arc<Wardrobe>, now_ns: u64) -> Self {
        Self {
            session: SessionMachine::new(defaults.times.session, now_ns),
            visit: Visit::new(&defaults),
            defaults,
            wardrobe,
            now_ns,
            seen: Presence::default(),
            camera: CameraState::Seeing,
            own_picture: None,
            face_offered: false,
            unseen_ns: now_ns,
            resting: false,
            focus: 0,
            number: 0,
        }
    }

    /// Shoppers may have their own face taken from now on.
    pub fn offer_faces(&mut self) {
        self.face_offered = true;
    }

    /// Whether no person is in view and the screen was not touched: then another stock may hang.
    pub fn is_idle(&self) -> bool {
        self.page() == Page::Attract && self.visit.touched_ns.is_none()
    }

    /// Hangs other garments from now on, of which every visitor wears these first.
    pub fn restock(&mut self, wardrobe: Arc<Wardrobe>, wear: Vec<String>) {
        (self.wardrobe, self.defaults.wear) = (wardrobe, wear);
        self.visit = Visit::new(&self.defaults);
    }

    /// The garments to choose from.
    pub fn wardrobe(&self) -> &Wardrobe {
        &self.wardrobe
    }

    /// Whether the page that is open shows the shopper themselves.
    pub fn shows_own_picture(&self) -> bool {
        self.shows_body(self.page()) && self.sees_themselves()
    }

    /// Whether a page shows the shopper's body, or themselves.
    pub(super) fn shows_body(&self, page: Page) -> bool {
        let is_of_body = matches!(
            page,
            Page::Fitting
                | Page::Garments
                | Page::Compare
                | Page::Picture
                | Page::Face
                | Page::Settings
                | Page::Unmeasured
                | Page::OwnMeasures
                | Page::MeasureEntry
        );
        is_of_body && self.visit.dressed && !self.visit.hidden
    }

    /// Whether they see themselves on the pages that show the body: as they chose, where the camera's picture can be shown.
    pub(super) fn sees_themselves(&self) -> bool {
        self.own_picture.is_some() && self.visit.own_picture
    }

    /// The state of the session.
    pub fn state(&self) -> SessionState {
        self.session.state()
    }

    /// Times of a visit.
    pub fn times(&self) -> &VisitTimes {
        &self.defaults.times
    }

    /// What was measured of the shopper.
    pub fn known(&self) -> Option<&VisitorMeasures> {
        self.visit.known.as_ref()
    }

    /// Whether what was asked for by this number is still to be put on.
    pub fn awaits_dress(&self, number: u32) -> bool {
        self.visit.dressing == Some(number)
    }

    /// The language that is shown.
    pub fn language(&self) -> Language {
        self.visit.language
    }

    /// The page that is shown.
    pub fn page(&self) -> Page {
        let visit = &self.visit;
        let top = if visit.open == Page::Settings { Some(Page::Settings) } else { None };
        if visit.asked_ns.is_some() {
            return Page::Second;
        }
        match (self.session.state(), visit.progress) {
            (SessionState::Left, _) => Page::Leaving,
            (SessionState::Attract, _) => {
                top.unwrap_or(if visit.begun_ns.is_some() { Page::Guide } else { Page::Attract })
            }
            (_, MeasureProgress::Measuring(_) | MeasureProgress::Turning | MeasureProgress::Dressing(_)) => {
                Page::Measuring
            }
            (_, MeasureProgress::Failed) => top.unwrap_or(Page::Unmeasured),
            (_, MeasureProgress::Guide { .. }) | (SessionState::Measuring, MeasureProgress::No) => {
                top.unwrap_or(Page::Guide)
            }
            (SessionState::TryOn, MeasureProgress::No) => visit.open,
        }
    }

    /// Takes an input; returns its effects.
    pub fn update(&mut self, now_ns: u64, input: Input) -> Effects {
        self.now_ns = self.now_ns.max(now_ns);
        let before = self.page();
        let mut effects = Effects::new();
        match input {
            Input::Tick => {}
            Input::Presence(seen) => self.see(seen),
            Input::Camera(state) => self.camera = state,
            Input::OwnPicture(outcome) => self.own_picture = Some(outcome),
            Input::Pressed(action) => self.pressed(action, &mut effects),
            Input::Typed(action) => self.typed_key(action, &mut effects),
            Input::Key(button) => self.key(button, &mut effects),
            Input::Gesture(gesture) => self.gesture(gesture, &mut effects),
            reply => self.reply(reply, &mut effects),
        }
        self.pass(&mut effects);
        self.settle_focus(before);
        effects
    }

    fn see(&mut self, seen: Presence) {
        self.seen = seen;
        let visit = &mut self.visit;
        if seen.who.is_some() && seen.who == visit.shopper {
            if !visit.seated_said {
                visit.seated = seen.seated;
            }
            // Controls do not follow every nod.
            const NOD_MM: f32 = 80.0;
            if let Some(head) = seen.head_mm
                && visit.head_mm.is_none_or(|h| (h - head).abs() > NOD_MM)
            {
                visit.head_mm = Some(head);
            }
        }
    }

    /// Whether the shopper is there: seen as the same one, or touching something; before there is one, whether any person is.
    fn is_there(&self) -> bool {
        let Visit { shopper, touched_ns, .. } = self.visit;
        let seen = self.seen.who.is_some() && (shopper.is_none() || shopper == self.seen.who);
        let touched = touched_ns.is_some_and(|t| self.now_ns - t < self.defaults.times.touch_ns);
        !self.resting && (seen || (touched && self.session.state() != SessionState::Attract))
    }

    /// Whether another person is there, or nearer than the shopper.
    fn is_stranger(&self) -> bool {
        let other = self.seen.who.is_some() && self.visit.shopper.is_some() && self.seen.who != self.visit.shopper;
        other || (self.seen.nearer && self.visit.shopper.is_some())
    }

    /// What the passing of time brings about.
    fn pass(&mut self, effects: &mut Effects) {
        let times = self.defaults.times;
        if self.seen.people > 0 {
            self.unseen_ns = self.now_ns;
        }
        self.resting &= self.now_ns - self.unseen_ns < times.session.step_out_ns;
        if self.visit.picture.expire(self.now_ns) && self.visit.open == Page::Picture {
            self.back();
        }
        self.strangers(effects);
        let sight = SessionInput { shopper: self.is_there(), dressed: self.visit.dressed };
        if let Some(change) = self.session.update(self.now_ns, sight) {
            match change.to {
                SessionState::Measuring if change.from == SessionState::Attract => self.step_in(),
                SessionState::Attract => self.forget(effects),
                SessionState::Measuring | SessionState::TryOn | SessionState::Left => {}
            }
        }
        // Who begins and does not come, or has chosen a language and walked on, leaves the display as it was.
        let touched = self.visit.begun_ns.max(self.visit.touched_ns);
        let expired = touched.is_some_and(|t| self.now_ns - t >= times.begin_ns);
        if expired && self.session.state() == SessionState::Attract {
            self.visit = Visit::new(&self.defaults);
        }
        self.guide(effects);
        self.follow_turn(effects);
    }

    /// Checks whether another person has stepped in, and gives up waiting for an answer.
    fn strangers(&mut self, effects: &mut Effects) {
        let times = self.defaults.times;
        if let Some(asked) = self.visit.asked_ns {
            if self.now_ns - asked >= times.answer_ns {
                self.forget(effects);
            }
            return;
        }
        if !self.is_stranger() {
            self.visit.stranger_ns = None;
            return;
        }
        let since = *self.visit.stranger_ns.get_or_insert(self.now_ns);
        if self.now_ns - since < times.stranger_ns {
            return;
        }
        if self.visit.known.is_none()
            && matches!(self.visit.progress, MeasureProgress::No | MeasureProgress::Guide { .. })
        {
            // Nothing is known of the first one: the person in view is measured.
            self.visit.shopper = self.seen.who;
            self.visit.stranger_ns = None;
            return;
        }
        let visit = &mut self.visit;
        (visit.asked_ns, visit.hidden) = (Some(self.now_ns), true);
        visit.picture.wipe();
        // Work under way is for the visitor before.
        (visit.dressing, visit.snapping, visit.pair, visit.face) = (None, None, None, OwnFace::default());
        if matches!(visit.progress, MeasureProgress::Measuring(_) | MeasureProgress::Turning) {
            visit.progress = MeasureProgress::Guide { ready_ns: None, not_before_ns: 0 };
        }
        (visit.turn, visit.front, visit.entry) = (None, None, None);
        (visit.open, visit.history) = (Page::Fitting, heapless::Vec::new());
        let _ = effects.push(Effect::Hide);
    }

    fn step_in(&mut self) {
        self.visit.shopper = self.seen.who;
        self.visit.head_mm = self.seen.head_mm;
        self.visit.seated |= self.seen.seated;
        self.visit.progress = MeasureProgress::Guide { ready_ns: None, not_before_ns: 0 };
    }

    /// Begins to measure when the shopper stands as they should.
    fn guide(&mut self, effects: &mut Effects) {
        let MeasureProgress::Guide { ready_ns, not_before_ns } = self.visit.progress else { return };
        if self.session.state() == SessionState::Attract
            || self.visit.open == Page::Settings
            || self.visit.asked_ns.is_some()
        {
            return;
        }
        let stands = self.seen.who.is_some() && self.seen.who == self.visit.shopper && self.hint().is_none();
        let since = if stands { Some(ready_ns.unwrap_or(self.now_ns)) } else { None };
        let ready = since.is_some_and(|t| self.now_ns - t >= self.defaults.times.ready_ns);
        if ready && self.now_ns >= not_before_ns {
            self.measure(effects);
        } else {
            self.visit.progress = MeasureProgress::Guide { ready_ns: since, not_before_ns };
        }
    }

    /// Everything of the shopper goes.
    pub(super) fn forget(&mut self, effects: &mut Effects) {
        self.visit = Visit::new(&self.defaults);
        (self.seen.head_mm, self.seen.facing) = (None, None);
        self.session = SessionMachine::new(self.defaults.times.session, self.now_ns);
        // A reply that is still under way is to one who has left.
        self.number = self.number.wrapping_add(1);
        let _ = effects.push(Effect::Forget);
    }

    /// The shopper has said that they are done: everything goes, and no person is measured until they have stepped away or begin.
    pub(super) fn leave(&mut self, effects: &mut Effects) {
        self.forget(effects);
        self.resting = true;
        self.unseen_ns = self.now_ns;
    }

    /// The visitor says that they are there.
    pub(super) fn begin(&mut self, effects: &mut Effects) {
        if self.visit.asked_ns.is_some() {
            self.forget(effects);
        }
        self.resting = false;
        self.visit.begun_ns = Some(self.now_ns);
    }

    /// The person in view says that it is still them.
    pub(super) fn stay(&mut self, effects: &mut Effects) {
        if self.visit.asked_ns.take().is_some() {
            self.visit.shopper = self.seen.who.or(self.visit.shopper);
            self.visit.stranger_ns = None;
            if self.visit.known.is_some() && !self.visit.outfit.is_empty() {
                self.dress(effects);
            }
        }
    }

    pub(super) fn next(&mut self) -> u32 {
        self.number = self.number.wrapping_add(1);
        self.number
    }

    /// A reply of the dressing worker.
    fn reply(&mut self, input: Input, effects: &mut Effects) {
        let visit = &mut self.visit;
        let is_asked = |asked: &mut Option<u32>, number| asked.take_if(|a| *a == number).is_some();
        match input {
            Input::Measured(number, known) => self.measured(number, *known, effects),
            Input::Dressed(number) if is_asked(&mut visit.dressing, number) => {
                (visit.dressed, visit.hidden) = (true, false);
                visit.worn = visit.outfit.clone();
                self.finish_dressing();
            }
            Input::Draped(number) => {
                if let Some(pair) = &mut visit.pair {
                    is_asked(&mut pair.asked, number);
                }
            }
            Input::PictureTaken(number, offered) if is_asked(&mut visit.snapping, number) => {
                visit.picture.put(offered, self.now_ns, self.now_ns + self.defaults.times.picture_ns);
            }
            Input::FaceTaken(number, taken) if is_asked(&mut visit.face.asked, number) => {
                self.face_taken(taken, effects);
            }
            Input::Failed(number) => self.failed(number, effects),
            _ => {}
        }
    }

    /// What was asked for cannot be done: what was there before stays.
    fn failed(&mut self, number: u32, effects: &mut Effects) {
        if self.awaits_measures(number) {
            return self.fail_measuring(effects);
        }
        let visit = &mut self.visit;
        let is_asked = |asked: &mut Option<u32>| asked.take_if(|a| *a == number).is_some();
        if is_asked(&mut visit.dressing) {
            if visit.worn.is_empty() {
                (visit.progress, visit.turn) = (MeasureProgress::Failed, None);
                visit.known = None;
            } else {
                visit.outfit = visit.worn.clone();
                visit.refused = true;
                self.take_in_hand(None);
                self.finish_dressing();
            }
        } else if is_asked(&mut visit.face.asked) {
            visit.face.trouble = Some(FaceTrouble::Unlike);
        } else if is_asked(&mut visit.snapping) {
            visit.snap_failed = true;
        } else if let Some(pair) = visit.pair.as_mut().filter(|pair| pair.asked == Some(number)) {
            (pair.asked, pair.refused) = (None, true);
        }
    }

    /// Has the outfit put on.
    pub(super) fn dress(&mut self, effects: &mut Effects) {
        let number = self.next();
        self.visit.dressing = Some(number);
        self.visit.refused = false;
        let _ = effects.push(Effect::Dress { number, outfit: self.visit.outfit.clone() });
    }

    /// The fit of a garment, in a size or in the best one.
    pub(super) fn judge(&self, item: usize, size: Option<usize>) -> Option<SizeFit> {
        let garment = self.wardrobe.items.get(item)?;
        // The outfit is in the order of dressing, as the wardrobe is.
        let worn =
            self.visit.outfit.iter().take_while(|w| w.item < item).filter_map(|w| self.wardrobe.items.get(w.item));
        let beneath: Vec<GarmentOffer> =
            worn.filter(|other| !other.excludes(garment)).filter_map(|other| other.offer.clone()).collect();
        size_fit::judge(garment, self.visit.known.as_ref()?, size, &beneath).ok()
    }

    /// Takes another garment in hand, and judges it; without one the one in hand, or where it is not worn any more the outermost.
    pub(super) fn take_in_hand(&mut self, item: Option<usize>) {
        let worn = |item: usize| self.visit.outfit.iter().find(|w| w.item == item).copied();
        let wanted = worn(item.unwrap_or(self.visit.in_hand)).or(self.visit.outfit.last().copied());
        let Some(worn) = wanted else { return };
        self.visit.in_hand = worn.item;
        self.visit.fit = self.judge(worn.item, Some(worn.size));
        (self.visit.pair, self.visit.zone) = (None, 0);
    }

    /// The garment in hand as it is worn.
    pub(super) fn worn(&self) -> Option<WornItem> {
        self.visit.outfit.iter().find(|w| w.item == self.visit.in_hand).copied()
    }

    /// Has two sizes draped, the one that is worn and another.
    pub(super) fn drape(&mut self, size: usize, effects: &mut Effects) {
        let Some(other) = self.judge(self.visit.in_hand, Some(size)) else { return };
        let number = self.next();
        let right = self.with_size(size);
        self.visit.pair = Some(ComparedSizes { other, asked: Some(number), refused: false });
        let outfits = Box::new([self.visit.outfit.clone(), right]);
        let _ = effects.push(Effect::DrapeTwo { number, outfits });
    }

    /// The outfit with the garment in hand in another size.
    pub(super) fn with_size(&self, size: usize) -> Outfit {
        let in_hand = self.visit.in_hand;
        let sized = |w: &WornItem| if w.item == in_hand { WornItem { size, ..*w } } else { *w };
        self.visit.outfit.iter().map(sized).collect()
    }

    /// Where the view is turned to now (rad): it comes to rest within half a second.
    pub fn yaw(&self) -> f32 {
        const REST_NS: f32 = 5e8;
        let ViewTurn { eighths, from, since_ns } = self.visit.view;
        let t = ((self.now_ns - since_ns.min(self.now_ns)) as f32 / REST_NS).min(1.0);
        let eased = t * t * (3.0 - 2.0 * t);
        (from + (eighths as f32 - from) * eased) * std::f32::consts::FRAC_PI_4
    }
}
