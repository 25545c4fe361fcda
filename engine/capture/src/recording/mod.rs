//! A surface followed through a recording: pictures in, meshes and a report out, and a run that stopped goes on.

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
