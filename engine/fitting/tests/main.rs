//! All integration tests of the crate, linked once.

mod measuring;
mod pattern_sizes;
#[path = "../../../tests/src/recordings.rs"]
mod recordings;
