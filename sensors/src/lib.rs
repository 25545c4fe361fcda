//! Depth frames and joints of a sensor, recordings of them, and the filters that make them plausible.
//!
//! Runs on the sensor thread: at most 33 ms a frame at 30 Hz, of which filtering the joints takes less than 50 µs.

// Modules in the order of the data: each imports only from the groups above its own (tests/tests/layers.rs).
pub mod error;

pub mod limits;

pub mod calibration;
pub mod lens;
pub mod pictures;

pub mod colour_camera;
pub mod face_points;
pub mod filter;
pub mod masks;
pub mod person_mask;
pub mod sample;
pub mod segment;
pub mod session;

pub mod depth;
pub mod source;

#[cfg(test)]
#[path = "../../tests/src/recordings.rs"]
mod recordings;
