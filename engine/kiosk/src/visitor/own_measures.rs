//! Measures that shoppers took by tape: typed, checked, and merged with the camera's measures; sizes and the body follow.

use toile_track::tape_readings::TapeReadings;

use super::measure_entry::{EntryFault, MeasureEntry, OwnMeasure};
use super::model::{Effects, VisitModel};
use super::screen::Page;
use super::size_fit::{MeasureBasis, SizeFit};

impl VisitModel {
    /// Opens the page on which a measure is typed.
    pub(super) fn open_entry(&mut self, place: usize) {
        if let Some(measure) = OwnMeasure::ALL.get(place) {
            self.visit.entry = Some(MeasureEntry::new(*measure));
            self.open(Page::MeasureEntry);
        }
    }

    /// A key of that page.
    pub(super) fn typed(&mut self, key: impl FnOnce(&mut MeasureEntry)) {
        if let Some(entry) = &mut self.visit.entry {
            key(entry);
        }
    }

    /// Changes the unit; what was typed stays as it is and means the other one.
    pub(super) fn change_unit(&mut self) {
        self.visit.unit = self.visit.unit.other();
        self.typed(|entry| entry.fault = None);
    }

    /// Whether the measure that is being typed was given already.
    pub(super) fn is_given(&self) -> bool {
        self.visit.entry.as_ref().is_some_and(|entry| self.visit.tape.at(entry.measure.index()).is_some())
    }

    /// Accepts what was typed. What cannot be is said on the page, and everything stays as it was.
    pub(super) fn accept_measure(&mut self, effects: &mut Effects) {
        let (tape, unit) = (self.visit.tape, self.visit.unit);
        let Some(entry) = &mut self.visit.entry else { return };
        let read = |entry: &MeasureEntry| -> Result<TapeReadings, EntryFault> {
            let metres = entry.metres(unit).ok_or(EntryFault::Empty)?;
            let tape = tape.with(entry.measure.index(), metres)?;
            tape.check()?;
            Ok(tape)
        };
        match read(entry) {
            Ok(tape) => self.lay_over(tape, effects),
            Err(fault) => entry.fault = Some(fault),
        }
    }

    /// Removes the measure that is being typed from those that were accepted.
    pub(super) fn remove_measure(&mut self, effects: &mut Effects) {
        if let Some(entry) = &self.visit.entry {
            self.lay_over(self.visit.tape.without(entry.measure.index()), effects);
        }
    }

    /// Lays other measures by tape over what was seen, goes back to their list, judges sizes anew and has the body dressed in them.
    fn lay_over(&mut self, tape: TapeReadings, effects: &mut Effects) {
        let visit = &mut self.visit;
        (visit.tape, visit.entry) = (tape, None);
        let known = visit.known.as_ref().map(|known| known.with_tape(&tape));
        // Nothing is missing any more that the page of missing measures could name.
        if known.as_ref().is_some_and(|known| known.missing.is_empty()) {
            visit.history.retain(|page| *page != Page::Unmeasured);
        }
        visit.known = known;
        self.back();
        if self.visit.known.is_some() && !self.visit.outfit.is_empty() {
            self.choose_sizes();
            self.take_in_hand(None);
            self.dress(effects);
        }
    }

    /// Whether the shopper is asked for measures by tape: no size is sure, or how a zone fits is not known.
    pub(super) fn wants_tape(&self) -> bool {
        const SURE: f32 = toile_track::recommend::SURE;
        let unsure = |fit: &SizeFit| {
            fit.girth_to_take.is_some() || fit.probability < SURE && fit.size == fit.best || fit.has_unknown()
        };
        self.visit.fit.as_ref().is_some_and(unsure)
    }

    /// Whether the zone that is asked about could be known by tape, and is not yet.
    pub(super) fn zone_wants_tape(&self) -> bool {
        let visit = &self.visit;
        let zone = visit.fit.as_ref().and_then(|fit| fit.zones.get(visit.zone)).map(|zone| zone.zone);
        zone.zip(visit.known.as_ref()).is_some_and(|(zone, known)| known.basis(zone) != MeasureBasis::Taped)
    }
}
