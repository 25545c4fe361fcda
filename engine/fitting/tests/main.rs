//! All integration tests of the crate, linked once.

mod pattern_sizes;
