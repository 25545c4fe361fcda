//! Garments of the wardrobe on a mannequin that performs: time and error of the cloth where meshes are no grids.
//!
//! Reads: the wardrobe, the scene's performance, the engine's cloth. Writes: a report of one run.
//! Budget: about ten seconds a garment; nothing but the step itself is timed.
//! Thread: one, and those of the engine; with nothing else running.

mod error;
mod mannequin;
mod measure;
mod report;
mod scene;

pub use error::WornError;
pub use mannequin::AverageBody;
pub use measure::measure;
pub use report::{WornReport, WornStrain};
pub use scene::{MAX_OUTFIT, WornOptions, WornScene, on_the_way, step_at};
