//! Scenes in motion.
//!
//! Reads: bodies, garments, scene files, joints, meshes of C's. Writes: arrays where C has room, snapshots, pictures.
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
