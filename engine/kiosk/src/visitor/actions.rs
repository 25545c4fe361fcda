//! Actions: the controls of a page, in the order of the Tab key, the most wanted one first.

use std::ops::Range;

use super::measure_entry;
use super::model::VisitModel;
use super::screen::{Action, Page};
use super::size_fit::SizeFit;
use super::texts;
use super::visit::MeasureProgress;
use crate::service::session::SessionState;

/// Actions of a page, at most: a shelf of garments with the colours of one, or a keypad.
const MOST: usize = 24;

/// Garments that are shown at once: two rows of three, which leaves room for the body behind.
pub(super) const SHELF: usize = 6;

/// Actions that can be pressed, in the order of the Tab key.
pub(super) type Actions = heapless::Vec<Action, MOST>;

/// Why measuring cannot begin yet: what the shopper is to do.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum PositionHint {
    Unseen,
    Alone,
    Nearer,
    Farther,
    Left,
    Right,
}

/// Farther than this from the mark, measures get worse (m).
const OFF_MARK_M: f32 = 0.35;

impl VisitModel {
    /// What the shopper is to do before they can be measured.
    pub(super) fn hint(&self) -> Option<PositionHint> {
        let [left, ahead] = self.seen.off_mark_m.unwrap_or_default();
        match self.seen.people {
            0 => Some(PositionHint::Unseen),
            1 if self.seen.nearer => Some(PositionHint::Alone),
            1 if ahead < -OFF_MARK_M => Some(PositionHint::Nearer),
            1 if ahead > OFF_MARK_M => Some(PositionHint::Farther),
            1 if left > OFF_MARK_M => Some(PositionHint::Right),
            1 if left < -OFF_MARK_M => Some(PositionHint::Left),
            1 => None,
            _ => Some(PositionHint::Alone),
        }
    }

    /// Actions that can be pressed now.
    pub(super) fn actions(&self) -> Actions {
        use Action::*;
        let mut list = Actions::new();
        // Pages have fewer controls than there are places, and a control more would be left out rather than anything else.
        let mut add = |actions: &[Action]| {
            for action in actions {
                let _ = list.push(*action);
            }
        };
        match self.page() {
            Page::Attract => {
                add(&[Begin]);
                (0..texts::Language::ALL.len()).for_each(|i| add(&[Language(i)]));
                add(&[LargeType]);
            }
            Page::Guide if self.session.state() == SessionState::Attract => add(&[Seated, Open(Page::Settings), Leave]),
            Page::Guide => {
                add(&[Measure, Seated]);
                self.go_on(&mut add);
                add(&[Open(Page::Settings), Leave]);
            }
            Page::Measuring => add(&[Leave]),
            Page::Unmeasured if self.visit.progress == MeasureProgress::Failed => {
                add(&[Measure, Seated]);
                self.go_on(&mut add);
                add(&[Open(Page::Settings), Leave]);
            }
            Page::Unmeasured => add(&[Back, Open(Page::OwnMeasures), Measure, Seated, Leave]),
            Page::Fitting => self.fitting(&mut add),
            Page::Garments => {
                self.shelf().for_each(|i| add(&[Garment(i)]));
                match self.shelves() {
                    0 | 1 => {}
                    2 => add(&[Shelf(1)]),
                    _ => add(&[Shelf(-1), Shelf(1)]),
                }
                let colours = self.wardrobe.items.get(self.visit.in_hand).map_or(0, |item| item.colours.len());
                (0..colours).for_each(|i| add(&[Colour(i)]));
                add(&[Back]);
            }
            Page::Zones => {
                let zones = self.visit.fit.as_ref().map_or(0, |fit| fit.zones.len());
                (0..zones).for_each(|i| add(&[Zone(i)]));
                if self.visit.fit.as_ref().is_some_and(SizeFit::has_unknown) {
                    add(&[Open(Page::OwnMeasures)]);
                }
                add(&[FitMap, Open(Page::Compare), Turn(-1), Turn(1), Back]);
            }
            Page::Zone => {
                add(&[Back, Measure]);
                if self.zone_wants_tape() {
                    add(&[Open(Page::OwnMeasures)]);
                }
            }
            Page::Compare => self.compare(&mut add),
            Page::Picture if self.visit.picture.code().is_some() => {
                add(&[DeletePicture]);
                if self.visit.picture.has_both() {
                    add(&[OtherCode]);
                }
                add(&[Back]);
            }
            Page::Picture if self.visit.snap_failed => add(&[TakePicture, Back]),
            Page::Picture => add(&[Back]),
            Page::Face => self.face(&mut add),
            Page::OwnMeasures => {
                (0..measure_entry::OwnMeasure::ALL.len()).for_each(|i| add(&[OwnMeasure(i)]));
                add(&[Unit, Back]);
            }
            Page::MeasureEntry => {
                (1..=9).for_each(|digit| add(&[Digit(digit)]));
                add(&[Point, Digit(0), DeleteDigit, Accept]);
                if self.is_given() {
                    add(&[RemoveMeasure]);
                }
                add(&[Unit, Back]);
            }
            Page::Settings => {
                add(&[Back]);
                (0..texts::Language::ALL.len()).for_each(|i| add(&[Language(i)]));
                add(&[LargeType]);
                if self.session.state() == SessionState::TryOn {
                    add(&[Measure, Open(Page::OwnMeasures), Leave]);
                }
            }
            Page::Second => add(&[Stay, Begin]),
            Page::Leaving => add(&[Stay, Leave]),
        }
        list
    }

    /// How many shelves the garments take.
    pub(super) fn shelves(&self) -> usize {
        self.wardrobe.items.len().div_ceil(SHELF)
    }

    /// Places of the garments that are shown.
    pub(super) fn shelf(&self) -> Range<usize> {
        let first = self.visit.shelf * SHELF;
        first..(first + SHELF).min(self.wardrobe.items.len())
    }

    /// Who stands dressed need not be measured again.
    fn go_on(&self, add: &mut impl FnMut(&[Action])) {
        if self.visit.dressed {
            add(&[Action::Back]);
        }
    }

    fn fitting(&self, add: &mut impl FnMut(&[Action])) {
        use Action::*;
        add(&[Open(Page::Garments)]);
        self.sizes(add, self.worn().map(|w| w.size), None);
        add(&[Open(Page::Zones), Open(Page::Compare)]);
        if self.own_picture.is_some() {
            add(&[OwnPicture]);
        }
        if self.offers_face() {
            add(&[Open(Page::Face)]);
        }
        // A visitor who sees themselves turns the picture by turning.
        if !self.sees_themselves() {
            add(&[Turn(-1), Turn(1)]);
        }
        let held = self.visit.picture.code().is_some();
        add(&[if held { Open(Page::Picture) } else { TakePicture }]);
        if self.wants_tape() && !self.is_crowded() {
            add(&[Open(Page::OwnMeasures)]);
        }
        add(&[Open(Page::Settings), Leave]);
    }

    /// While a picture is taken or put on there is nothing to press but the way back.
    fn face(&self, add: &mut impl FnMut(&[Action])) {
        let face = &self.visit.face;
        if face.asked.is_none() && self.visit.dressing.is_none() {
            add(&[Action::TakeFace]);
            if face.on {
                add(&[Action::RemoveFace]);
            }
        }
        add(&[Action::Back]);
    }

    fn compare(&self, add: &mut impl FnMut(&[Action])) {
        use Action::*;
        let other = self.visit.pair.as_ref().map(|pair| pair.other.size);
        if other.is_some() {
            add(&[Wear]);
        }
        self.sizes(add, other, self.worn().map(|w| w.size));
        add(&[Turn(-1), Turn(1), Back]);
    }

    /// The sizes before and after one, as far as they are made.
    fn sizes(&self, add: &mut impl FnMut(&[Action]), size: Option<usize>, but: Option<usize>) {
        let Some(size) = size else { return };
        for step in [-1, 1] {
            if self.beside(size, step, but).is_some() {
                add(&[Action::Size(step)]);
            }
        }
    }

    /// The next size of the garment in hand in a direction that is made and is not the one to be passed over.
    pub(super) fn beside(&self, size: usize, step: i8, but: Option<usize>) -> Option<usize> {
        let made = self.wardrobe.items.get(self.visit.in_hand).map_or(0, |item| item.sizes.len());
        let next = |from: usize| from.checked_add_signed(isize::from(step)).filter(|s| *s < made);
        let first = next(size)?;
        if Some(first) == but { next(first) } else { Some(first) }
    }
}
