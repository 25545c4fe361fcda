//! The measures that shoppers took by tape: their list, and the page on which one is typed.

use super::super::measure_entry::{EntryFault, LengthUnit, OwnMeasure};
use super::super::screen::Block;
use super::super::texts::{TextKey, TextValue};
use super::PageWriter;

impl PageWriter<'_> {
    /// A length in the unit that was chosen, with a decimal only where there is one.
    fn length(&self, metres: f32) -> String {
        let unit = self.model.visit.unit;
        let tenths = (10.0 * metres / unit.metres()).round();
        let decimals = u8::from(tenths % 10.0 != 0.0);
        self.format(unit.word(), &[("length", TextValue::Number(tenths / 10.0, decimals))])
    }

    /// Its error, a tenth of the unit at least.
    fn error(&self, metres: f32) -> String {
        self.length(metres.max(0.1 * self.model.visit.unit.metres()))
    }

    pub(super) fn own_measures(&self) -> Vec<Block> {
        vec![self.paragraph(TextKey::OwnWhy), self.paragraph(TextKey::OwnForgotten)]
    }

    /// A measure, and its length where it was accepted.
    pub(super) fn own_measure_label(&self, place: usize) -> (String, Option<String>) {
        let Some(own) = OwnMeasure::ALL.get(place) else { return Default::default() };
        let given = self.model.visit.tape.at(own.index());
        (self.words(own.word()), given.map(|metres| self.length(metres)))
    }

    pub(super) fn entry_heading(&self) -> String {
        let Some(entry) = &self.model.visit.entry else { return self.words(TextKey::OwnHeading) };
        let measure = self.words(entry.measure.word());
        self.format(TextKey::EntryHeading, &[("measure", TextValue::Text(&measure))])
    }

    /// What is typed, and why it was not accepted, what was before, or how to take it.
    pub(super) fn entry(&self) -> Vec<Block> {
        let visit = &self.model.visit;
        let Some(entry) = &visit.entry else { return Vec::new() };
        let typed = match entry.typed() {
            "" => "\u{2013}".to_owned(),
            typed => typed.replace('.', &self.translation.language().decimal_mark().to_string()),
        };
        let given = visit.tape.at(entry.measure.index());
        let sentence = match (entry.fault, given) {
            (Some(fault), _) => self.fault(entry.measure, fault),
            (None, Some(metres)) => {
                let length = self.length(metres);
                self.format(TextKey::OwnGiven, &[("length", TextValue::Text(&length))])
            }
            (None, None) => self.words(TextKey::EntryHow),
        };
        let typed = self.format(visit.unit.word(), &[("length", TextValue::Text(&typed))]);
        vec![Block::Entry { text: typed }, Block::Text(sentence)]
    }

    /// Why a measure was not accepted, in one sentence or two.
    fn fault(&self, measure: OwnMeasure, fault: EntryFault) -> String {
        match fault {
            EntryFault::Empty => self.words(TextKey::EntryEmpty),
            EntryFault::Impossible { low_m, high_m } => {
                let (measure, low, high) = (self.words(measure.word()), self.whole(low_m), self.whole(high_m));
                let values = [
                    ("measure", TextValue::Text(&measure)),
                    ("low", TextValue::Text(&low)),
                    ("high", TextValue::Text(&high)),
                ];
                self.format(TextKey::EntryImpossible, &values)
            }
            EntryFault::Contradiction { measure, given_m, expected_m, sigma_m } => {
                let measure = self.words(measure.word());
                let (given, expected, sigma) = (self.length(given_m), self.whole(expected_m), self.error(sigma_m));
                let values = [
                    ("measure", TextValue::Text(&measure)),
                    ("given", TextValue::Text(&given)),
                    ("expected", TextValue::Text(&expected)),
                    ("sigma", TextValue::Text(&sigma)),
                ];
                self.format(TextKey::EntryContradiction, &values)
            }
        }
    }

    /// A length in whole units: what is expected is not known to a tenth.
    fn whole(&self, metres: f32) -> String {
        let unit: LengthUnit = self.model.visit.unit;
        self.length((metres / unit.metres()).round() * unit.metres())
    }
}
