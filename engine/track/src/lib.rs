//! Tracking: the shopper's measures from depth frames and joints, the fitted body, gestures, and the size that fits.

// Modules in the order of the data: each imports only from the groups above its own (tests/tests/layers.rs).
pub mod estimate;

pub mod correlated;
pub mod gesture;
pub mod point_cloud;

pub mod anthropometry;
pub mod fit;
pub mod measures;

mod joints;
pub mod tape_readings;

pub mod child;
pub mod measure;

pub mod recommend;
