//! Navigation: what a finger, a key and a gesture do. All of them press the same controls, so that nothing needs a gesture.

use toile_track::gesture::Gesture;

use super::model::{Button, Errand, Errands, Model};
use super::screen::{Action, Page};
use super::shelf::Worn;
use super::visit::{Taking, View};
use super::words::Language;
use crate::kiosk::session::State;

/// After a turn, swipes turn on for so long (ns); then they move the focus again.
const TURNING_NS: u64 = 4_000_000_000;

impl Model {
    /// A control is pressed at the display.
    pub(super) fn pressed(&mut self, action: Action, errands: &mut Errands) {
        let Some(place) = self.actions().iter().position(|a| *a == action) else { return };
        self.focus = place;
        self.visit.touched_ns = Some(self.now_ns);
        self.press(action, self.house.rules.walk_ns, errands);
    }

    pub(super) fn key(&mut self, button: Button, errands: &mut Errands) {
        self.visit.touched_ns = Some(self.now_ns);
        match button {
            Button::Tab | Button::Right | Button::Down => self.move_focus(1),
            Button::BackTab | Button::Left | Button::Up => self.move_focus(-1),
            Button::Enter => self.press_focus(self.house.rules.walk_ns, errands),
            Button::Escape => self.escape(errands),
        }
    }

    pub(super) fn gesture(&mut self, gesture: Gesture, errands: &mut Errands) {
        // Somebody else's hands press nothing that is the shopper's.
        let strange = self.visit.shopper.is_some() && self.seen.who != self.visit.shopper;
        if strange && self.page() != Page::Second {
            return;
        }
        let turns = self.now_ns < self.visit.turning_ns && matches!(self.focused(), Some(Action::Turn(_)));
        match gesture {
            Gesture::SwipeLeft if turns => self.turn(-1),
            Gesture::SwipeRight if turns => self.turn(1),
            Gesture::SwipeLeft => self.move_focus(-1),
            Gesture::SwipeRight => self.move_focus(1),
            Gesture::SwipeUp => self.escape(errands),
            // Who holds a hand out stands where they are seen: no walk back.
            Gesture::Confirm => self.press_focus(0, errands),
            Gesture::Opened | Gesture::Closed => {}
        }
    }

    /// What has the focus.
    pub(super) fn focused(&self) -> Option<Action> {
        self.actions().get(self.focus).copied()
    }

    fn move_focus(&mut self, step: isize) {
        let count = self.actions().len().max(1) as isize;
        self.focus = (self.focus as isize + step).rem_euclid(count) as usize;
    }

    fn press_focus(&mut self, walk_ns: u64, errands: &mut Errands) {
        if let Some(action) = self.focused() {
            self.press(action, walk_ns, errands);
        }
    }

    fn escape(&mut self, errands: &mut Errands) {
        match self.page() {
            Page::Leaving => self.press(Action::Stay, 0, errands),
            _ if self.actions().contains(&Action::Back) => self.back(),
            _ => {}
        }
    }

    /// After an input: another page begins at its first control, and the focus is always on one.
    pub(super) fn settle_focus(&mut self, before: Page) {
        if self.page() != before {
            self.focus = 0;
        }
        self.focus = self.focus.min(self.actions().len().saturating_sub(1));
    }

    pub(super) fn open(&mut self, page: Page) {
        let visit = &mut self.visit;
        if visit.trail.is_full() {
            visit.trail.remove(0);
        }
        // There is a place.
        let _ = visit.trail.push(visit.open);
        visit.open = page;
    }

    pub(super) fn back(&mut self) {
        if self.visit.open != Page::Settings && matches!(self.visit.taking, Taking::Guide { .. } | Taking::Failed) {
            self.visit.taking = Taking::No;
        }
        self.visit.open = self.visit.trail.pop().unwrap_or(Page::Fitting);
    }

    fn press(&mut self, action: Action, walk_ns: u64, errands: &mut Errands) {
        match action {
            Action::Begin => self.begin(errands),
            Action::Measure => self.measure_again(walk_ns),
            Action::Open(Page::Compare) => self.open_compare(errands),
            Action::Open(page) => self.open(page),
            Action::Back => self.back(),
            Action::Garment(item) => self.garment(item, errands),
            Action::Size(step) => self.size(step, errands),
            Action::Colour(colour) => self.colour(colour),
            Action::Zone(zone) => {
                self.visit.zone = zone;
                self.open(Page::Zone);
            }
            Action::Turn(eighths) => self.turn(eighths),
            Action::FitMap => self.visit.fit_map = !self.visit.fit_map,
            Action::TakePicture => self.snap(errands),
            Action::DeletePicture => {
                self.visit.vault.wipe();
                self.back();
            }
            Action::Stay => self.stay(errands),
            Action::Leave => self.leave(errands),
            Action::Language(place) => {
                self.visit.language = Language::ALL.get(place).copied().unwrap_or(self.visit.language);
            }
            Action::LargeType => self.visit.large = !self.visit.large,
            Action::Seated => (self.visit.seated, self.visit.seated_said) = (!self.visit.seated, true),
            Action::Wear => self.wear_other(errands),
        }
    }

    /// Measures, or measures again, once whoever pressed has walked back and stands as they should.
    fn measure_again(&mut self, walk_ns: u64) {
        let visit = &mut self.visit;
        if self.session.state() == State::TryOn && visit.open != Page::Unmeasured {
            // Both sizes, the zone and the picture are of the measures before.
            (visit.pair, visit.zone) = (None, 0);
        }
        (visit.open, visit.trail) = (Page::Fitting, heapless::Vec::new());
        visit.taking = Taking::Guide { ready_ns: None, not_before_ns: self.now_ns + walk_ns };
    }

    fn garment(&mut self, item: usize, errands: &mut Errands) {
        let worn = self.visit.outfit.iter().position(|w| w.item == item);
        match worn {
            Some(place) if self.visit.in_hand == item && self.visit.outfit.len() > 1 => {
                self.visit.outfit.remove(place);
                self.take_in_hand(None);
                self.dress(errands);
            }
            Some(_) => self.take_in_hand(Some(item)),
            None => {
                let size = self.judge(item, None).map_or(0, |fit| fit.size);
                self.visit.outfit = self.shelf.put_on(&self.visit.outfit, Worn { item, size, colour: 0 });
                self.take_in_hand(Some(item));
                self.dress(errands);
            }
        }
    }

    /// The size before or after: of what is worn, or on the page of two sizes of the other one.
    fn size(&mut self, step: i8, errands: &mut Errands) {
        let Some(worn) = self.worn() else { return };
        if let (Page::Compare, Some(pair)) = (self.page(), &self.visit.pair) {
            if let Some(size) = self.beside(pair.other.size, step, Some(worn.size)) {
                self.drape(size, errands);
            }
        } else if let Some(size) = self.beside(worn.size, step, None) {
            self.visit.outfit = self.with_size(size);
            self.take_in_hand(None);
            self.dress(errands);
        }
    }

    fn wear_other(&mut self, errands: &mut Errands) {
        let Some(size) = self.visit.pair.as_ref().map(|pair| pair.other.size) else { return };
        self.visit.outfit = self.with_size(size);
        self.take_in_hand(None);
        self.back();
        self.dress(errands);
    }

    fn colour(&mut self, colour: usize) {
        let in_hand = self.visit.in_hand;
        // What is worn at last keeps the colour too: a colour is never refused.
        for outfit in [&mut self.visit.outfit, &mut self.visit.worn] {
            outfit.iter_mut().filter(|w| w.item == in_hand).for_each(|w| w.colour = colour);
        }
    }

    fn open_compare(&mut self, errands: &mut Errands) {
        if self.visit.pair.is_none()
            && let Some(size) = self.visit.fit.as_ref().and_then(|fit| fit.other)
        {
            self.drape(size, errands);
        }
        self.open(Page::Compare);
    }

    fn turn(&mut self, eighths: i8) {
        let from = self.yaw() / std::f32::consts::FRAC_PI_4;
        let to = self.visit.view.eighths + i32::from(eighths);
        self.visit.view = View { eighths: to, from, since_ns: self.now_ns };
        self.visit.turning_ns = self.now_ns + TURNING_NS;
    }

    fn snap(&mut self, errands: &mut Errands) {
        if self.page() != Page::Picture {
            self.open(Page::Picture);
        }
        self.visit.snap_failed = false;
        let (number, yaw) = (self.next(), self.yaw());
        self.visit.snapping = Some(number);
        let _ = errands.push(Errand::Snap { number, outfit: self.visit.outfit.clone(), yaw });
    }
}
