//! All integration tests of the crate, linked once.

mod header;
mod programs;
