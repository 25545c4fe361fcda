//! Tracking: the shopper's measures from depth frames and joints, the fitted body, gestures, and the size that fits.
//!
//! Reads: `DepthFrame` and `Joints`, size tables, finished girths of garments. Writes: `Measurements`, gestures,
//! `Recommendation`. Budget: 1 s for 30 depth frames of 640 x 480, once a shopper; nothing here runs inside the frame.
//! Thread: the sensor thread.

// Rooms in the order of the data: a room imports only from the groups above its own (tests/tests/layers.rs).
pub mod estimate;

pub mod correlated;
pub mod gesture;
pub mod point_cloud;
pub mod section;

pub mod anthropometry;
pub mod fit;
pub mod measures;

mod joints;
pub mod silhouette;
pub mod tape_readings;

pub mod child;
pub mod measure;

pub mod recommend;
