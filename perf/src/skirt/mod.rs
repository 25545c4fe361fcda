//! The skirt benchmark: time and error of the cloth in the scene that Toile and its peers share.

mod error;
mod gauge;
mod measure;
pub mod options;
pub mod report;
mod scene;
mod winding;

pub use error::SkirtError;
pub use gauge::{FrameErrors, Gauge};
pub use measure::measure;
pub use scene::{SkirtScene, Spheres};
