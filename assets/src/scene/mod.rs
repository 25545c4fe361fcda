//! Scenes, written once and shared by recordings, tests, benchmarks and pictures.
//!
//! Reads: the types of skeleton, body, fabric and garment. Writes: the shopper's performance, the skirt of the benchmark.
//! Budget: at load; a pose or the skirt's spheres at one time cost about a microsecond.
//! Thread: any.

mod shopper;
pub mod skirt;

pub use shopper::{CAMERA, LENGTH_S, SHOPPER, STILL_S, shopper};

/// The session that comes with Toile, a recording of the shopper's performance: `toile record` makes it.
pub const SESSION: &[u8] = include_bytes!("../../data/sessions/shopper.mcap");
