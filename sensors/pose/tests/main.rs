//! All integration tests of the crate, linked once.

mod common;
mod face_parity;
mod parity;
mod pictures;
