//! All integration tests of the crate, linked once.

#[path = "../../../tests/src/coarse.rs"]
mod coarse;
mod header;
mod programs;
