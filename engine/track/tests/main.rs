//! All integration tests of the crate, linked once.

mod fitting;
mod gestures;
mod measuring;
mod recommending;
#[path = "../../../tests/src/recordings.rs"]
mod recordings;
