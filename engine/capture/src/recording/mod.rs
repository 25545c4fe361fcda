//! A surface followed through a recording: pictures in, meshes and a report out, and a run that stopped goes on.
//!
//! Reads: a mesh, a calibration, a sequence of pictures, what an earlier run wrote. Writes: a PLY file a frame, the motion as GLB, the
//! state of the run, a summary.
//! Budget: offline; memory for the pictures of one frame, and of those that a resumed run reads again, one after the other.
//! Thread: the caller's; pictures are decoded by one thread a camera.

mod job;
mod mesh;
mod store;
mod timing;

pub use job::{FlowJob, FlowSummary, Progress};
pub use mesh::read_mesh;
pub use store::mesh_name;
pub use timing::{OutOfStep, in_step};

#[cfg(test)]
mod tests;
