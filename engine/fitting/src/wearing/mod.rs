//! What a garment does when its wearer raises the arms or sits down: where it pulls, and how far it rides up.

pub mod poses;
mod pulls;

pub use pulls::{CoveredZone, GarmentPulls, PosePulls, Pull, ZonePull, in_poses, stretches};
