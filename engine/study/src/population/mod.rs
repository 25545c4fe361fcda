//! Who tries garments on: person number i of a study, drawn by seed and number or read from a table.

mod draw;
mod people;
mod person;
mod table;

pub(crate) use draw::{Purpose, generator};
pub use people::Population;
pub use person::Person;
