//! Capture: what several calibrated cameras saw becomes a surface that moves, a pose or a body.
//!
//! Reads: calibrations, sequences of pictures, keypoints, a mesh known in the first frame. Writes: meshes, joints, measures, reports.
//! Budget: offline: seconds a frame at most, memory for two frames of pictures; nothing here runs inside the frame.
//! Thread: the caller's, and a second one while residuals are summed. The same input gives the same bits with either.

// Rooms in the order of the data: a room imports only from the groups above its own (tests/tests/layers.rs).
pub mod error;

pub mod compare;
pub mod recover;
pub mod sparse;
pub mod surface;

pub mod plane;

pub mod flow;
pub mod pose;
pub mod render;

pub mod body;
pub mod recording;

#[cfg(test)]
#[path = "../../../tests/src/recordings.rs"]
mod recordings;
