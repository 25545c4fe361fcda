//! The result of building a body: a body with the wanted measures, or the reason for its absence.

use super::reading::{Readings, Vocabulary, Wanted};
use toile_base::body::Body;

/// A body built to measure, and what the tape reads on it.
#[derive(Debug, Clone, PartialEq)]
pub struct Fitted {
    /// The body that was built, in its rest pose (m).
    pub body: Body,
    /// Every measure of it, those that were not asked for included.
    pub readings: Readings,
    /// Steps that the calibration took.
    pub steps: usize,
}

/// Why no body could be built.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum BodyError {
    /// A measure is not a number, or beyond the sizes that the mannequin is drawn for.
    #[error("the {measure} is {value} m, but a body is built for {least} to {most} m: {}", cure(*value, [*least, *most]))]
    OutOfRange {
        /// Name of the measure that a body cannot have.
        measure: &'static str,
        /// The value asked for (m).
        value: f32,
        /// The least accepted (m).
        least: f32,
        /// The most accepted (m).
        most: f32,
    },
    /// Each measure is in its range, but no body of this kind has them together.
    #[error(
        "no body has a {measure} of {value} m together with {}, the nearest has {reached:.3} m: check them against each \
         other, or leave one out",
        beside(against.as_ref())
    )]
    Unreachable {
        /// The name of the measure that is furthest off.
        measure: &'static str,
        /// The value asked for (m).
        value: f32,
        /// The value of the nearest body (m).
        reached: f32,
        /// The one other measure without which the first can be met, if there is one, and the value asked for (m).
        against: Option<(&'static str, f32)>,
        /// The nearest body.
        nearest: Box<Fitted>,
    },
}

impl<V: Vocabulary> Wanted<V> {
    /// Checks that each measure lies in the range that a body can be built to.
    ///
    /// # Errors
    /// [`BodyError::OutOfRange`] for the first one that does not.
    pub fn check(&self) -> Result<(), BodyError> {
        for &(measure, value) in self.given() {
            let [least, most] = measure.reading().range();
            if !(least..=most).contains(&value) {
                return Err(BodyError::OutOfRange { measure: measure.name(), value, least, most });
            }
        }
        Ok(())
    }
}

/// What to do about a measure that is out of its range: in another unit it may be in it.
fn cure(value: f32, [least, most]: [f32; 2]) -> String {
    let units = [("millimetres", 1e-3), ("centimetres", 1e-2), ("inches", 0.0254)];
    match units.into_iter().find(|(_, metres)| (least..=most).contains(&(value * metres))) {
        Some((unit, metres)) => format!("taken as {unit} it would be {:.3} m, so give metres", value * metres),
        None => "check the measure and its unit".to_owned(),
    }
}

/// Names the other measures that conflict with a measure.
fn beside(other: Option<&(&'static str, f32)>) -> String {
    other.map_or_else(|| "the other measures".to_owned(), |(name, value)| format!("a {name} of {value} m"))
}
