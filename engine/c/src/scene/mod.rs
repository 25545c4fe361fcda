//! Scenes in motion.
//!
//! Budget: below 5 us a call beside the scene's own work.
//! Thread: the caller's, one call at a time on a scene; a second one meanwhile is refused.

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
