//! The skirt benchmark: time and error of the cloth in the scene that Toile and its peers share.
//!
//! Reads: the scene, the engine's cloth. Writes: a report of one run, and the table of all targets.
//! Budget: about six seconds for 4,096 vertices; nothing but the step itself is timed.
//! Thread: one, and those of the engine; with nothing else running.

pub mod claim;
mod error;
mod gauge;
pub mod hard;
mod measure;
pub mod options;
pub mod report;
mod scene;
pub mod table;
mod winding;

pub use error::SkirtError;
pub use gauge::{FrameErrors, Gauge};
pub use measure::measure;
pub use scene::{SkirtScene, Spheres};
