//! The one assembly: from what a sensor saw to a dressed body in motion, for the program, the kiosk and an embedder alike.
//!
//! Reads: sessions, the wardrobe, scene files. Writes: measures, sizes, dressed frames; the loop's threads and what they report.
//! Budget: measuring 0.5 s and dressing 1 s, outside of the frame; the loop's own budget inside of it.
//! Thread: the caller's for `dress`, `scene` and `plan`; sensor, physics and render threads of their own for `live`.

pub mod dress;
pub mod error;
pub mod heap;
pub mod live;
pub mod plan;
pub mod scene;
pub mod timing;

pub use error::FittingError;
