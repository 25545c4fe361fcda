//! All integration tests of the crate, linked once.

mod examples;
mod memory;
