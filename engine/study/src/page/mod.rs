//! The page of a study: one HTML file that needs no other and no network.
//!
//! Reads: a [`Summary`](crate::Summary), what runs say of their speed, pictures. Writes: HTML with drawings in it.
//! Budget: milliseconds; pictures cost what a try-on costs.
//! Thread: the caller's.

mod drawings;
mod report;

pub use report::{TypicalPicture, page};
