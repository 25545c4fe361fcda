//! Capture: turns the pictures of several calibrated cameras into a surface that moves, a pose or a body.

// Modules in the order of the data: each imports only from the groups above its own (tests/tests/layers.rs).
pub mod error;

pub mod compare;
pub mod recover;
pub mod sparse;
pub mod surface;

pub mod plane;

pub mod flow;
pub mod pose;

pub mod body;
pub mod recording;

#[cfg(test)]
#[path = "../../../tests/src/recordings.rs"]
mod recordings;
#[cfg(test)]
#[path = "tests/render/mod.rs"]
mod render;
