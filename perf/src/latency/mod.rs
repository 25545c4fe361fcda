//! Latency: how long it takes from what the sensor saw until a picture of it is taken, by stage, on this machine.
//!
//! Every time counts from when something was due, never from when a late thread came to it, and a step that was dropped
//! counts as late as the one in its place: the figures are corrected for coordinated omission. The first second is not metered.

mod capacity;
mod error;
mod jitter;
mod load;
mod renderer;
mod report;
mod run;

pub use error::LatencyError;
pub use renderer::{OwnPictureFigures, OwnPictureParts};
pub use report::{Goal, Latency, LatencyStage, QualityFigures};
pub use run::{LatencyInputs, LatencyOptions, LatencySource, run};
