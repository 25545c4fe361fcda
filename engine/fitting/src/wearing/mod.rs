//! Behaviour of a garment when its wearer raises the arms or sits down: the zones that pull, and the rise of its hems.

pub mod poses;
mod pulls;

pub use pulls::{CoveredZone, GarmentPulls, PosePulls, Pull, ZonePull, in_poses, stretches};
