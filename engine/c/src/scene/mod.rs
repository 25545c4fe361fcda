//! Scenes in motion.
//!
//! A call takes less than 5 µs beside the scene's own work. A scene takes one call at a time; a second one meanwhile is refused.

mod make;
mod options;
mod picture;
mod read;
mod snapshot;
mod state;
mod step;

pub use options::{quality, tucked};
pub use picture::{filled, look};
pub use state::{SceneHandle, SceneObject};
