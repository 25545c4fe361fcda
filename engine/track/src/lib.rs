//! Tracking: the shopper's measures from depth frames and joints, the fitted body, gestures, and the size that fits.
//!
//! Reads: `DepthFrame` and `Joints`, size tables, finished girths of garments. Writes: `Measurements`, gestures,
//! `Recommendation`. Budget: 1 s for 30 depth frames of 640 x 480, once a shopper; nothing here runs inside the frame.
//! Thread: the sensor thread.

pub mod anthropometry;
pub mod estimate;
pub mod fit;
pub mod gesture;
mod joints;
pub mod measure;
pub mod measures;
pub mod point_cloud;
pub mod recommend;
pub mod section;
pub mod silhouette;
