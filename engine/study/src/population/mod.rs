//! Who tries garments on: person number i of a study, drawn by seed and number or read from a table.
//!
//! Reads: the study file, a table of people, the survey's covariance. Writes: one [`Person`] a number, with true measures and a
//! weight; the same whatever was asked for before.
//! Budget: 1 ms a person.
//! Thread: any; nothing is kept.

mod draw;
mod people;
mod person;
mod table;

pub(crate) use draw::{Purpose, generator};
pub use people::Population;
pub use person::Person;
