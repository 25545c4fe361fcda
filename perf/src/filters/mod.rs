//! The filter benchmark: jitter, lag and overshoot of each filter of joints on the same motions, and the slide of feet.

mod feet;
mod measure;
mod motions;
mod rows;
pub mod table;

use serde::Serialize;

pub use feet::FootSlide;
pub use rows::{NAMES, filter};

/// What one filter does to the motions.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FilterRow {
    /// Name of the filter.
    pub name: String,
    /// Deviation of a resting joint along an axis, about the truth (mm).
    pub still_jitter_mm: f64,
    /// A reach of 0.5 m in 0.6 s: delay at which it fits the truth best (ms).
    pub step_lag_ms: f64,
    /// How far that reach passes its end (mm).
    pub step_overshoot_mm: f64,
    /// A forearm that waves once a second under a Kinect's noise and dropouts: delay (ms).
    pub wave_lag_ms: f64,
    /// Its distance from the truth at that time, 99th percentile, dropouts included (mm).
    pub wave_error_mm: f64,
    /// Deviation of the forearm's length (mm).
    pub bone_mm: f64,
    /// A recorded wave, if a folder of recordings is given.
    pub recorded: Vec<RecordedFigures>,
    /// Time a frame (us).
    pub us: f64,
}

/// Effect of one filter on a recording without known truth, compared with the recording's own smooth course.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct RecordedFigures {
    /// Name of the recording.
    pub name: String,
    /// Deviation of the hand from its own smooth course while it is slow (mm).
    pub jitter_mm: f64,
    /// Delay against the raw hand's smooth course (ms).
    pub lag_ms: f64,
}

/// Why the benchmark cannot be run.
#[derive(Debug, thiserror::Error)]
pub enum FiltersError {
    /// The scene's shopper.
    #[error(transparent)]
    Body(#[from] toile_assets::body::BodyError),
    /// A recording that cannot be read.
    #[error(transparent)]
    Source(#[from] toile_sensors::source::SourceError),
}
