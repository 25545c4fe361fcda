//! Garments of the wardrobe on a mannequin that performs: time and error of the cloth where meshes are no grids.

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
