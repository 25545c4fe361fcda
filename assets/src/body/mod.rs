//! The parametric body: two drawn bodies, and morphs that fit them to whatever measures are given.

pub mod base;
mod calibrate;
mod fields;
pub(crate) mod fitted;
mod gauge;
pub mod landmarks;
mod morph;
mod outcome;
mod people;
mod proportions;
mod reading;
mod segments;
pub mod shape;
mod shares;
mod skin;
mod slider;
pub mod sound;
pub mod stored;
pub mod tape;
#[cfg(test)]
mod tests;

pub use fitted::{TOLERANCE, build, fitted, wanted};
pub use outcome::{BodyError, Fitted};
pub use reading::{Ansur, En, Readings, Vocabulary, Wanted};
