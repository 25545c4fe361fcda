//! The skirt benchmark: time and error of the cloth in the scene that Toile and its peers share.

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
