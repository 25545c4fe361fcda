//! What a garment does when its wearer raises the arms or sits down: where it pulls, and how far it rides up.
//!
//! Reads: a body, garments as they are put on. Writes: stretch by zone in each pose, beside that of standing.
//! Budget: a second a pose; not in the frame.
//! Thread: the caller's.

pub mod poses;
mod pulls;

pub use pulls::{CoveredZone, GarmentPulls, PosePulls, Pull, ZonePull, in_poses, stretches};
