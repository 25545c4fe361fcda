//! All integration tests of the crate, linked once.

mod ring;
mod triple;
mod workers;
