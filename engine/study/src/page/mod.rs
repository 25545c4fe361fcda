//! The page of a study: one HTML file that needs no other and no network.

mod drawings;
mod report;

pub use report::{TypicalPicture, page};
