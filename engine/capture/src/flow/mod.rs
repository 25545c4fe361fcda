//! Model flowing: a mesh known in the first frame is deformed so that each next frame's pictures, warped back a triangle at a time,
//! make those before (Reuterswaerd 2005, "Model Flowing", chapter 5).
//!
//! Beyond his: triangles are hidden by a depth buffer and weighted by the angle at which they are seen; one that fewer than two
//! cameras see is carried by its springs, its folds and its inertia, the terms of an implicit step of cloth; the print of the
//! first frame is the reference of all, so that errors do not add up; each triangle has a brightness of its own in each camera.

mod energy;
mod memory;
mod pass;
mod patches;
mod references;
mod residual;
mod settings;
mod state;
mod tracker;
mod visibility;

pub use memory::FlowMemory;
pub use references::FirstFrame;
pub use settings::{FlowSettings, Reference, Springs};
pub use tracker::{FlowTracker, FrameOutcome};

#[cfg(test)]
pub(crate) mod tests;
