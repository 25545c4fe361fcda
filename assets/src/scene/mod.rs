//! Scenes, written once and shared by recordings, tests, benchmarks and pictures.

mod shopper;
pub mod skirt;

pub use shopper::{CAMERA, LENGTH_S, SHOPPER, STILL_S, shopper};

/// The session that comes with Toile, a recording of the shopper's performance: `toile record` makes it.
pub const SESSION: &[u8] = include_bytes!("../../data/sessions/shopper.mcap");
