//! Population of a study: person number i, drawn by seed and number or read from a table.

mod draw;
mod people;
mod person;
mod table;

pub(crate) use draw::{Purpose, generator};
pub use people::Population;
pub use person::Person;
