//! A person's joints in a plain colour picture, and the points of a face: networks of MediaPipe (BlazePose, face mesh) on the processor.

// Modules in the order of the data: each imports only from the groups above its own (tests/tests/layers.rs).
pub mod depth_buffer;
pub mod files;
pub mod region;
pub mod tflite;

pub mod network;

mod boxes;

pub mod detector;
pub mod face_detector;
pub mod face_mesh;
pub mod landmarks;

pub mod plausible;
pub mod smoothing;

pub mod scale;
pub mod sides;

pub mod tracker;

pub mod face;
pub mod face_finder;
pub mod joints;
pub mod picture_fit;
