//! Measuring, from the front and once the shopper has turned, and its results: sizes, the first outfit, the dressed body.

use super::body_turn::{BodyTurn, TurnState};
use super::model::{Effect, Effects, VisitModel};
use super::screen::Page;
use super::size_fit::VisitorMeasures;
use super::visit::MeasureProgress;
use super::wardrobe::{Outfit, WornItem};

impl VisitModel {
    /// Measures the front, and offers a turn where there is depth whose sides could be joined; a chair is not turned.
    pub(super) fn measure(&mut self, effects: &mut Effects) {
        let number = self.next();
        let visit = &mut self.visit;
        visit.progress = MeasureProgress::Measuring(self.now_ns);
        visit.front = None;
        visit.turn = (self.seen.depth && !visit.seated).then(|| BodyTurn::new(self.now_ns));
        let _ = effects.push(Effect::Measure { number, seated: visit.seated });
    }

    /// Follows the turn. The front is measured and dressed meanwhile; only who has begun to turn is waited for.
    pub(super) fn follow_turn(&mut self, effects: &mut Effects) {
        let facing = if self.seen.who == self.visit.shopper { self.seen.facing } else { None };
        let Some(turn) = &mut self.visit.turn else { return };
        let state = turn.update(self.now_ns, facing);
        match (self.visit.progress, state) {
            (MeasureProgress::Measuring(_) | MeasureProgress::Dressing(_), _)
            | (MeasureProgress::Turning, TurnState::Offered | TurnState::Turning) => {}
            (MeasureProgress::Turning, TurnState::Enough) => self.measure_turn(effects),
            (MeasureProgress::Turning, TurnState::Ended) => self.keep_front(effects),
            (MeasureProgress::No | MeasureProgress::Guide { .. } | MeasureProgress::Failed, _) => {
                self.visit.turn = None;
            }
        }
    }

    /// Measures again with all that was seen of the turn.
    fn measure_turn(&mut self, effects: &mut Effects) {
        let number = self.next();
        let visit = &mut self.visit;
        visit.front = visit.front.take().or(visit.known.clone());
        (visit.turn, visit.progress) = (None, MeasureProgress::Measuring(self.now_ns));
        let _ = effects.push(Effect::MeasureTurn { number });
    }

    /// What was seen from the front counts: there was no turn, or it could not be measured.
    fn keep_front(&mut self, effects: &mut Effects) {
        self.visit.turn = None;
        match self.visit.front.take() {
            Some(front) => self.settle(&front, effects),
            // It stands dressed.
            None => self.show_dressed(),
        }
    }

    /// Nothing could be measured: what was seen from the front counts where there is that.
    pub(super) fn fail_measuring(&mut self, effects: &mut Effects) {
        if self.visit.front.is_some() {
            self.keep_front(effects);
        } else {
            (self.visit.turn, self.visit.progress) = (None, MeasureProgress::Failed);
        }
    }

    pub(super) fn measured(&mut self, number: u32, known: VisitorMeasures, effects: &mut Effects) {
        if !self.awaits_measures(number) {
            return;
        }
        if self.is_turning() {
            (self.visit.front, self.visit.progress) = (Some(known), MeasureProgress::Turning);
        } else {
            self.settle(&known, effects);
        }
    }

    /// Whether measures are awaited by this number.
    pub(super) fn awaits_measures(&self, number: u32) -> bool {
        self.number == number && matches!(self.visit.progress, MeasureProgress::Measuring(_))
    }

    /// Whether they turn, or have just been seen from all sides.
    fn is_turning(&self) -> bool {
        let state = self.visit.turn.as_ref().map(BodyTurn::state);
        matches!(state, Some(TurnState::Turning | TurnState::Enough))
    }

    /// Takes measures as the shopper's own, with what they took by tape laid over them, and has them dressed.
    fn settle(&mut self, known: &VisitorMeasures, effects: &mut Effects) {
        self.visit.progress = MeasureProgress::Dressing(self.now_ns);
        self.visit.front = None;
        let first = if self.visit.outfit.is_empty() { self.first_outfit() } else { self.visit.outfit.clone() };
        self.visit.known = Some(known.with_tape(&self.visit.tape));
        self.visit.outfit = first;
        self.choose_sizes();
        self.take_in_hand(self.visit.outfit.last().map(|w| w.item));
        self.dress(effects);
    }

    /// Sizes are chosen anew: measures may have changed.
    pub(super) fn choose_sizes(&mut self) {
        for i in 0..self.visit.outfit.len() {
            let item = self.visit.outfit[i].item;
            let defaults = self.defaults.size.as_ref();
            let wanted = defaults.and_then(|code| self.wardrobe.items.get(item)?.sizes.iter().position(|s| s == code));
            if let Some(fit) = self.judge(item, wanted) {
                self.visit.outfit[i].size = fit.size;
            }
        }
    }

    fn first_outfit(&self) -> Outfit {
        let worn = |name: &String| self.wardrobe.find(name).map(|item| WornItem { item, size: 0, colour: 0 });
        let outfit = self.defaults.wear.iter().filter_map(worn);
        let outfit = outfit.fold(Outfit::new(), |outfit, worn| self.wardrobe.put_on(&outfit, worn));
        if outfit.is_empty() && !self.wardrobe.items.is_empty() {
            return self.wardrobe.put_on(&outfit, WornItem { item: 0, size: 0, colour: 0 });
        }
        outfit
    }

    /// Measured and dressed; who turns goes on turning first.
    pub(super) fn finish_dressing(&mut self) {
        if !matches!(self.visit.progress, MeasureProgress::Dressing(_)) {
            return;
        }
        if self.is_turning() {
            self.visit.progress = MeasureProgress::Turning;
        } else {
            self.show_dressed();
        }
    }

    /// Shows the dressed body: who was measured in part sees that first.
    fn show_dressed(&mut self) {
        self.visit.turn = None;
        self.visit.progress = MeasureProgress::No;
        self.visit.history.clear();
        self.visit.open = Page::Fitting;
        if self.visit.known.as_ref().is_some_and(|k| !k.missing.is_empty()) {
            self.open(Page::Unmeasured);
        }
    }
}
