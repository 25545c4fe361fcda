//! Navigation: the effects of finger, key and gesture. All of them press the same controls, so that nothing needs a gesture.

use toile_track::gesture::Gesture;

use super::actions::SHELF;
use super::measure_entry::MeasureEntry;
use super::model::{Effect, Effects, NavigationKey, VisitModel};
use super::screen::{Action, Page};
use super::texts::Language;
use super::visit::{MeasureProgress, ViewTurn};
use super::wardrobe::WornItem;
use crate::service::session::SessionState;

/// After a turn, swipes turn on for so long (ns); then they move the focus again.
const TURNING_NS: u64 = 4_000_000_000;

impl VisitModel {
    /// A control is pressed at the display.
    pub(super) fn pressed(&mut self, action: Action, effects: &mut Effects) {
        let Some(place) = self.actions().iter().position(|a| *a == action) else { return };
        self.focus = place;
        self.visit.touched_ns = Some(self.now_ns);
        self.press(action, self.defaults.times.walk_ns, effects);
    }

    pub(super) fn key(&mut self, button: NavigationKey, effects: &mut Effects) {
        self.visit.touched_ns = Some(self.now_ns);
        match button {
            NavigationKey::Tab | NavigationKey::Right | NavigationKey::Down => self.move_focus(1),
            NavigationKey::BackTab | NavigationKey::Left | NavigationKey::Up => self.move_focus(-1),
            NavigationKey::Enter => self.press_focus(self.defaults.times.walk_ns, effects),
            NavigationKey::Escape => self.escape(effects),
        }
    }

    /// A digit at a keyboard: Enter then accepts, and does not press the digit again.
    pub(super) fn typed_key(&mut self, action: Action, effects: &mut Effects) {
        self.pressed(action, effects);
        if let Some(accept) = self.actions().iter().position(|a| *a == Action::Accept) {
            self.focus = accept;
        }
    }

    pub(super) fn gesture(&mut self, gesture: Gesture, effects: &mut Effects) {
        // Another person's hands press nothing that is the shopper's.
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
            Gesture::SwipeUp => self.escape(effects),
            // Who holds a hand out stands where they are seen: no walk back.
            Gesture::Confirm => self.press_focus(0, effects),
            Gesture::Opened | Gesture::Closed => {}
        }
    }

    /// The action that has the focus.
    pub(super) fn focused(&self) -> Option<Action> {
        self.actions().get(self.focus).copied()
    }

    fn move_focus(&mut self, step: isize) {
        let count = self.actions().len().max(1) as isize;
        self.focus = (self.focus as isize + step).rem_euclid(count) as usize;
    }

    fn press_focus(&mut self, walk_ns: u64, effects: &mut Effects) {
        if let Some(action) = self.focused() {
            self.press(action, walk_ns, effects);
        }
    }

    fn escape(&mut self, effects: &mut Effects) {
        match self.page() {
            Page::Leaving => self.press(Action::Stay, 0, effects),
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
        if visit.history.is_full() {
            visit.history.remove(0);
        }
        // There is a place.
        let _ = visit.history.push(visit.open);
        visit.open = page;
    }

    pub(super) fn back(&mut self) {
        if self.visit.open != Page::Settings
            && matches!(self.visit.progress, MeasureProgress::Guide { .. } | MeasureProgress::Failed)
        {
            self.visit.progress = MeasureProgress::No;
        }
        self.visit.open = self.visit.history.pop().unwrap_or(Page::Fitting);
    }

    fn press(&mut self, action: Action, walk_ns: u64, effects: &mut Effects) {
        match action {
            Action::Begin => self.begin(effects),
            Action::Measure => self.measure_again(walk_ns),
            Action::Open(Page::Compare) => self.open_compare(effects),
            Action::Open(Page::Face) => self.open_face(),
            Action::Open(page) => {
                self.visit.shelf = self.visit.in_hand / SHELF;
                self.open(page);
            }
            Action::Shelf(step) => self.turn_shelf(step),
            Action::Back => self.back(),
            Action::Garment(item) => self.garment(item, effects),
            Action::Size(step) => self.size(step, effects),
            Action::Colour(colour) => self.colour(colour),
            Action::Zone(zone) => {
                self.visit.zone = zone;
                self.open(Page::Zone);
            }
            Action::Turn(eighths) => self.turn(eighths),
            Action::FitMap => self.visit.fit_map = !self.visit.fit_map,
            Action::OwnPicture => self.visit.own_picture = !self.visit.own_picture,
            Action::TakeFace => self.take_face(effects),
            Action::RemoveFace => self.remove_face(effects),
            Action::TakePicture => self.snap(effects),
            Action::OtherCode => self.visit.picture.show_other(),
            Action::DeletePicture => {
                self.visit.picture.wipe();
                self.back();
            }
            Action::Stay => self.stay(effects),
            Action::Leave => self.leave(effects),
            Action::Language(place) => {
                self.visit.language = Language::ALL.get(place).copied().unwrap_or(self.visit.language);
            }
            Action::LargeType => self.visit.large = !self.visit.large,
            Action::Seated => (self.visit.seated, self.visit.seated_said) = (!self.visit.seated, true),
            Action::Wear => self.wear_other(effects),
            Action::OwnMeasure(place) => self.open_entry(place),
            Action::Digit(digit) => self.typed(|entry| entry.digit(digit)),
            Action::Point => self.typed(MeasureEntry::point),
            Action::DeleteDigit => self.typed(MeasureEntry::delete),
            Action::Unit => self.change_unit(),
            Action::Accept => self.accept_measure(effects),
            Action::RemoveMeasure => self.remove_measure(effects),
        }
    }

    /// Measures, or measures again, once the visitor has walked back and stands as they should.
    fn measure_again(&mut self, walk_ns: u64) {
        let visit = &mut self.visit;
        if self.session.state() == SessionState::TryOn && visit.open != Page::Unmeasured {
            // Both sizes, the zone and the picture are of the measures before.
            (visit.pair, visit.zone) = (None, 0);
        }
        (visit.open, visit.history) = (Page::Fitting, heapless::Vec::new());
        visit.progress = MeasureProgress::Guide { ready_ns: None, not_before_ns: self.now_ns + walk_ns };
    }

    fn garment(&mut self, item: usize, effects: &mut Effects) {
        let worn = self.visit.outfit.iter().position(|w| w.item == item);
        match worn {
            Some(place) if self.visit.in_hand == item && self.visit.outfit.len() > 1 => {
                self.visit.outfit.remove(place);
                self.take_in_hand(None);
                self.dress(effects);
            }
            Some(_) => self.take_in_hand(Some(item)),
            None => {
                let size = self.judge(item, None).map_or(0, |fit| fit.size);
                self.visit.outfit = self.wardrobe.put_on(&self.visit.outfit, WornItem { item, size, colour: 0 });
                self.take_in_hand(Some(item));
                self.dress(effects);
            }
        }
    }

    /// The shelf before or after, round and round; the focus stays on what was pressed.
    fn turn_shelf(&mut self, step: i8) {
        let count = self.shelves().max(1) as isize;
        self.visit.shelf = (self.visit.shelf as isize + isize::from(step)).rem_euclid(count) as usize;
        let pressed = self.actions().iter().position(|action| *action == Action::Shelf(step));
        self.focus = pressed.unwrap_or(self.focus);
    }

    /// The size before or after: of what is worn, or on the page of two sizes of the other one.
    fn size(&mut self, step: i8, effects: &mut Effects) {
        let Some(worn) = self.worn() else { return };
        if let (Page::Compare, Some(pair)) = (self.page(), &self.visit.pair) {
            if let Some(size) = self.beside(pair.other.size, step, Some(worn.size)) {
                self.drape(size, effects);
            }
        } else if let Some(size) = self.beside(worn.size, step, None) {
            self.visit.outfit = self.with_size(size);
            self.take_in_hand(None);
            self.dress(effects);
        }
    }

    fn wear_other(&mut self, effects: &mut Effects) {
        let Some(size) = self.visit.pair.as_ref().map(|pair| pair.other.size) else { return };
        self.visit.outfit = self.with_size(size);
        self.take_in_hand(None);
        self.back();
        self.dress(effects);
    }

    fn colour(&mut self, colour: usize) {
        let in_hand = self.visit.in_hand;
        // What is worn at last keeps the colour too: a colour is never refused.
        for outfit in [&mut self.visit.outfit, &mut self.visit.worn] {
            outfit.iter_mut().filter(|w| w.item == in_hand).for_each(|w| w.colour = colour);
        }
    }

    fn open_compare(&mut self, effects: &mut Effects) {
        if self.visit.pair.is_none()
            && let Some(size) = self.visit.fit.as_ref().and_then(|fit| fit.other)
        {
            self.drape(size, effects);
        }
        self.open(Page::Compare);
    }

    fn turn(&mut self, eighths: i8) {
        let from = self.yaw() / std::f32::consts::FRAC_PI_4;
        let to = self.visit.view.eighths + i32::from(eighths);
        self.visit.view = ViewTurn { eighths: to, from, since_ns: self.now_ns };
        self.visit.turning_ns = self.now_ns + TURNING_NS;
    }

    fn snap(&mut self, effects: &mut Effects) {
        if self.page() != Page::Picture {
            self.open(Page::Picture);
        }
        self.visit.snap_failed = false;
        let (number, yaw) = (self.next(), self.yaw());
        self.visit.snapping = Some(number);
        let _ = effects.push(Effect::Snap { number, outfit: self.visit.outfit.clone(), yaw });
    }
}
