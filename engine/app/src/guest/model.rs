//! Model: the pages as a machine. It knows the time, what is seen, what is pressed and what the tailor says, and nothing else: a
//! window, a service without one and a test drive the same machine.
//!
//! It stands on the machine of [`crate::kiosk::session`], which decides who has stepped in and who has left, and adds the pages.

use std::sync::Arc;

use super::fitting::{self, Fit, Known};
pub use super::message::{Button, Errand, Errands, House, Input, Rules};
use super::screen::Page;
use super::shelf::{Outfit, Shelf, Worn};
use super::sight::Seen;
use super::visit::{Pair, Taking, View, Visit};
use super::words::Language;
use crate::kiosk::session::{Session, Sight, State};

/// The machine.
#[derive(Debug, Clone)]
pub struct Model {
    pub(super) house: House,
    pub(super) shelf: Arc<Shelf>,
    pub(super) session: Session,
    pub(super) now_ns: u64,
    pub(super) seen: Seen,
    /// Since when nobody is seen (ns), and whether the one who has said that they are done is still there.
    unseen_ns: u64,
    resting: bool,
    pub(super) visit: Visit,
    /// The place of the control that has the focus.
    pub(super) focus: usize,
    /// Errands so far.
    number: u32,
}

impl Model {
    /// Nobody is there, at this time (ns).
    pub fn new(house: House, shelf: Arc<Shelf>, now_ns: u64) -> Self {
        Self {
            session: Session::new(house.rules.session, now_ns),
            visit: Visit::new(house.language, house.large),
            house,
            shelf,
            now_ns,
            seen: Seen::default(),
            unseen_ns: now_ns,
            resting: false,
            focus: 0,
            number: 0,
        }
    }

    /// The state of the session.
    pub fn state(&self) -> State {
        self.session.state()
    }

    /// How long what has to last.
    pub fn rules(&self) -> &Rules {
        &self.house.rules
    }

    /// What was measured of the shopper.
    pub fn known(&self) -> Option<&Known> {
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
        match (self.session.state(), visit.taking) {
            (State::Left, _) => Page::Leaving,
            (State::Attract, _) => top.unwrap_or(if visit.begun_ns.is_some() { Page::Guide } else { Page::Attract }),
            (_, Taking::Measuring(_) | Taking::Dressing(_)) => Page::Measuring,
            (_, Taking::Failed) => top.unwrap_or(Page::Unmeasured),
            (_, Taking::Guide { .. }) | (State::Measuring, Taking::No) => top.unwrap_or(Page::Guide),
            (State::TryOn, Taking::No) => visit.open,
        }
    }

    /// Takes an input; gives what others are to do.
    pub fn update(&mut self, now_ns: u64, input: Input) -> Errands {
        self.now_ns = self.now_ns.max(now_ns);
        let before = self.page();
        let mut errands = Errands::new();
        match input {
            Input::Tick => {}
            Input::Seen(seen) => self.see(seen),
            Input::Pressed(action) => self.pressed(action, &mut errands),
            Input::Key(button) => self.key(button, &mut errands),
            Input::Gesture(gesture) => self.gesture(gesture, &mut errands),
            reply => self.reply(reply, &mut errands),
        }
        self.pass(&mut errands);
        self.settle_focus(before);
        errands
    }

    fn see(&mut self, seen: Seen) {
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

    /// Whether the shopper is there: seen as the same one, or touching something; before there is one, whether anybody is.
    fn is_there(&self) -> bool {
        let Visit { shopper, touched_ns, .. } = self.visit;
        let seen = self.seen.who.is_some() && (shopper.is_none() || shopper == self.seen.who);
        let touched = touched_ns.is_some_and(|t| self.now_ns - t < self.house.rules.touch_ns);
        !self.resting && (seen || (touched && self.session.state() != State::Attract))
    }

    /// Whether somebody else is there, or nearer than the shopper.
    fn is_stranger(&self) -> bool {
        let other = self.seen.who.is_some() && self.visit.shopper.is_some() && self.seen.who != self.visit.shopper;
        other || (self.seen.nearer && self.visit.shopper.is_some())
    }

    /// What time brings about.
    fn pass(&mut self, errands: &mut Errands) {
        let rules = self.house.rules;
        if self.seen.people > 0 {
            self.unseen_ns = self.now_ns;
        }
        self.resting &= self.now_ns - self.unseen_ns < rules.session.step_out_ns;
        if self.visit.vault.look(self.now_ns) && self.visit.open == Page::Picture {
            self.back();
        }
        self.strangers(errands);
        let sight = Sight { shopper: self.is_there(), dressed: self.visit.dressed };
        if let Some(change) = self.session.look(self.now_ns, sight) {
            match change.to {
                State::Measuring if change.from == State::Attract => self.step_in(),
                State::Attract => self.forget(errands),
                State::Measuring | State::TryOn | State::Left => {}
            }
        }
        // Who begins and does not come, or has chosen a language and walked on, leaves the display as it was.
        let touched = self.visit.begun_ns.max(self.visit.touched_ns);
        let expired = touched.is_some_and(|t| self.now_ns - t >= rules.begin_ns);
        if expired && self.session.state() == State::Attract {
            self.visit = Visit::new(self.house.language, self.house.large);
        }
        self.guide(errands);
    }

    /// Looks whether somebody else has stepped in, and gives up waiting for an answer.
    fn strangers(&mut self, errands: &mut Errands) {
        let rules = self.house.rules;
        if let Some(asked) = self.visit.asked_ns {
            if self.now_ns - asked >= rules.answer_ns {
                self.forget(errands);
            }
            return;
        }
        if !self.is_stranger() {
            self.visit.stranger_ns = None;
            return;
        }
        let since = *self.visit.stranger_ns.get_or_insert(self.now_ns);
        if self.now_ns - since < rules.stranger_ns {
            return;
        }
        if self.visit.known.is_none() && matches!(self.visit.taking, Taking::No | Taking::Guide { .. }) {
            // Nothing is known of the first one: whoever is there is measured.
            self.visit.shopper = self.seen.who;
            self.visit.stranger_ns = None;
            return;
        }
        let visit = &mut self.visit;
        (visit.asked_ns, visit.hidden) = (Some(self.now_ns), true);
        visit.vault.wipe();
        // Whatever the tailor is at is for who stood there before.
        (visit.dressing, visit.snapping, visit.pair) = (None, None, None);
        if matches!(visit.taking, Taking::Measuring(_)) {
            visit.taking = Taking::Guide { ready_ns: None, not_before_ns: 0 };
        }
        (visit.open, visit.trail) = (Page::Fitting, heapless::Vec::new());
        let _ = errands.push(Errand::Hide);
    }

    fn step_in(&mut self) {
        self.visit.shopper = self.seen.who;
        self.visit.head_mm = self.seen.head_mm;
        self.visit.seated |= self.seen.seated;
        self.visit.taking = Taking::Guide { ready_ns: None, not_before_ns: 0 };
    }

    /// Begins to measure when the shopper stands as they should.
    fn guide(&mut self, errands: &mut Errands) {
        let Taking::Guide { ready_ns, not_before_ns } = self.visit.taking else { return };
        if self.session.state() == State::Attract || self.visit.open == Page::Settings || self.visit.asked_ns.is_some()
        {
            return;
        }
        let stands = self.seen.who.is_some() && self.seen.who == self.visit.shopper && self.hint().is_none();
        let since = if stands { Some(ready_ns.unwrap_or(self.now_ns)) } else { None };
        let ready = since.is_some_and(|t| self.now_ns - t >= self.house.rules.ready_ns);
        if ready && self.now_ns >= not_before_ns {
            self.measure(errands);
        } else {
            self.visit.taking = Taking::Guide { ready_ns: since, not_before_ns };
        }
    }

    pub(super) fn measure(&mut self, errands: &mut Errands) {
        self.visit.taking = Taking::Measuring(self.now_ns);
        let number = self.next();
        let _ = errands.push(Errand::Measure { number, seated: self.visit.seated });
    }

    /// Everything of the shopper goes.
    pub(super) fn forget(&mut self, errands: &mut Errands) {
        self.visit = Visit::new(self.house.language, self.house.large);
        self.seen.head_mm = None;
        self.session = Session::new(self.house.rules.session, self.now_ns);
        // A reply that is still under way is to one who has left.
        self.number = self.number.wrapping_add(1);
        let _ = errands.push(Errand::Forget);
    }

    /// The shopper has said that they are done: everything goes, and nobody is measured until they have stepped away or begin.
    pub(super) fn leave(&mut self, errands: &mut Errands) {
        self.forget(errands);
        self.resting = true;
        self.unseen_ns = self.now_ns;
    }

    /// Somebody says that they are there.
    pub(super) fn begin(&mut self, errands: &mut Errands) {
        if self.visit.asked_ns.is_some() {
            self.forget(errands);
        }
        self.resting = false;
        self.visit.begun_ns = Some(self.now_ns);
    }

    /// Whoever is there says that it is still them.
    pub(super) fn stay(&mut self, errands: &mut Errands) {
        if self.visit.asked_ns.take().is_some() {
            self.visit.shopper = self.seen.who.or(self.visit.shopper);
            self.visit.stranger_ns = None;
            if self.visit.known.is_some() && !self.visit.outfit.is_empty() {
                self.dress(errands);
            }
        }
    }

    pub(super) fn next(&mut self) -> u32 {
        self.number = self.number.wrapping_add(1);
        self.number
    }

    /// What the tailor says.
    fn reply(&mut self, input: Input, errands: &mut Errands) {
        let visit = &mut self.visit;
        let is_asked = |asked: &mut Option<u32>, number| asked.take_if(|a| *a == number).is_some();
        match input {
            Input::Measured(number, known) => self.measured(number, *known, errands),
            Input::Dressed(number) if is_asked(&mut visit.dressing, number) => {
                (visit.dressed, visit.hidden) = (true, false);
                visit.worn = visit.outfit.clone();
                self.put_on_at_last();
            }
            Input::Draped(number) => {
                if let Some(pair) = &mut visit.pair {
                    is_asked(&mut pair.asked, number);
                }
            }
            Input::PictureTaken(number, code) if is_asked(&mut visit.snapping, number) => {
                visit.vault.put(code, self.now_ns + self.house.rules.picture_ns);
            }
            Input::Failed(number) => self.failed(number),
            _ => {}
        }
    }

    /// What was asked for cannot be done: what was there before stays.
    fn failed(&mut self, number: u32) {
        let visit = &mut self.visit;
        let is_asked = |asked: &mut Option<u32>| asked.take_if(|a| *a == number).is_some();
        if is_asked(&mut visit.dressing) {
            if visit.worn.is_empty() {
                visit.taking = Taking::Failed;
                visit.known = None;
            } else {
                visit.outfit = visit.worn.clone();
                visit.refused = true;
                self.take_in_hand(None);
                self.put_on_at_last();
            }
        } else if is_asked(&mut visit.snapping) {
            visit.snap_failed = true;
        } else if let Some(pair) = visit.pair.as_mut().filter(|pair| pair.asked == Some(number)) {
            (pair.asked, pair.refused) = (None, true);
        } else if self.number == number && matches!(visit.taking, Taking::Measuring(_)) {
            visit.taking = Taking::Failed;
        }
    }

    fn measured(&mut self, number: u32, known: Known, errands: &mut Errands) {
        if self.number != number || !matches!(self.visit.taking, Taking::Measuring(_)) {
            return;
        }
        self.visit.taking = Taking::Dressing(self.now_ns);
        let first = if self.visit.outfit.is_empty() { self.first_outfit() } else { self.visit.outfit.clone() };
        self.visit.known = Some(known);
        self.visit.outfit = first;
        // Sizes are chosen anew: measures may have changed.
        for i in 0..self.visit.outfit.len() {
            let item = self.visit.outfit[i].item;
            let house = self.house.size.as_ref();
            let wanted = house.and_then(|code| self.shelf.items.get(item)?.sizes.iter().position(|s| s == code));
            if let Some(fit) = self.judge(item, wanted) {
                self.visit.outfit[i].size = fit.size;
            }
        }
        self.take_in_hand(self.visit.outfit.last().map(|w| w.item));
        self.dress(errands);
    }

    fn first_outfit(&self) -> Outfit {
        let worn = |name: &String| self.shelf.find(name).map(|item| Worn { item, size: 0, colour: 0 });
        let outfit = self.house.wear.iter().filter_map(worn);
        let outfit = outfit.fold(Outfit::new(), |outfit, worn| self.shelf.put_on(&outfit, worn));
        if outfit.is_empty() && !self.shelf.items.is_empty() {
            return self.shelf.put_on(&outfit, Worn { item: 0, size: 0, colour: 0 });
        }
        outfit
    }

    /// Measured and dressed: who was measured in part is told so first.
    fn put_on_at_last(&mut self) {
        if !matches!(self.visit.taking, Taking::Dressing(_)) {
            return;
        }
        self.visit.taking = Taking::No;
        self.visit.trail.clear();
        self.visit.open = Page::Fitting;
        if self.visit.known.as_ref().is_some_and(|k| !k.missing.is_empty()) {
            self.open(Page::Unmeasured);
        }
    }

    /// Has the outfit put on.
    pub(super) fn dress(&mut self, errands: &mut Errands) {
        let number = self.next();
        self.visit.dressing = Some(number);
        self.visit.refused = false;
        let _ = errands.push(Errand::Dress { number, outfit: self.visit.outfit.clone() });
    }

    /// The fit of a garment, in a size or in the best one.
    pub(super) fn judge(&self, item: usize, size: Option<usize>) -> Option<Fit> {
        fitting::judge(self.shelf.items.get(item)?, self.visit.known.as_ref()?, size).ok()
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
    pub(super) fn worn(&self) -> Option<Worn> {
        self.visit.outfit.iter().find(|w| w.item == self.visit.in_hand).copied()
    }

    /// Has two sizes draped, the one that is worn and another.
    pub(super) fn drape(&mut self, size: usize, errands: &mut Errands) {
        let Some(other) = self.judge(self.visit.in_hand, Some(size)) else { return };
        let number = self.next();
        let right = self.with_size(size);
        self.visit.pair = Some(Pair { other, asked: Some(number), refused: false });
        let outfits = Box::new([self.visit.outfit.clone(), right]);
        let _ = errands.push(Errand::DrapeTwo { number, outfits });
    }

    /// The outfit with the garment in hand in another size.
    pub(super) fn with_size(&self, size: usize) -> Outfit {
        let in_hand = self.visit.in_hand;
        let sized = |w: &Worn| if w.item == in_hand { Worn { size, ..*w } } else { *w };
        self.visit.outfit.iter().map(sized).collect()
    }

    /// Where the view is turned to now (rad): it comes to rest within half a second.
    pub fn yaw(&self) -> f32 {
        const REST_NS: f32 = 5e8;
        let View { eighths, from, since_ns } = self.visit.view;
        let t = ((self.now_ns - since_ns.min(self.now_ns)) as f32 / REST_NS).min(1.0);
        let eased = t * t * (3.0 - 2.0 * t);
        (from + (eighths as f32 - from) * eased) * std::f32::consts::FRAC_PI_4
    }
}
