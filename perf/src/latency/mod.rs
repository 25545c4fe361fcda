//! Latency: how long it takes from what the sensor saw until a picture of it is taken, by stage, on this machine.
//!
//! Reads: a dressed frame, a session's joints. Writes: distributions, causes of what was late, a page.
//! Budget: the seconds that are asked for, and as long for the machine's own jitter, ten at most.
//! Thread: the loop's own, each on its place; load threads beside them where asked for.
//!
//! Every time counts from when something was due, never from when a late thread came to it, and a step that was dropped
//! counts as late as the one in its place: the figures are corrected for coordinated omission. The first second is not metered.

mod capacity;
mod html;
mod jitter;
mod load;
mod report;
mod run;

pub use html::page;
pub use report::{Goal, Latency, LatencyStage, QualityFigures};
pub use run::{LatencyInputs, run};

use thiserror::Error;
use toile_engine::workers::WorkerPoolError;

/// What is measured.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct LatencyOptions {
    /// Length of the run (s), after a first second.
    pub seconds: u32,
    /// Threads of load beside the loop.
    pub load: usize,
    /// A rung of the governor's ladder that the run is held on; none lets it govern.
    pub rung: Option<u8>,
}

/// Why the figures cannot be taken.
#[derive(Debug, Error)]
pub enum LatencyError {
    /// The system gave no thread.
    #[error("a thread of the loop could not be started ({0}); raise the limit of threads")]
    Spawn(#[from] std::io::Error),
    /// The workers.
    #[error(transparent)]
    WorkerPool(#[from] WorkerPoolError),
    /// A thread of the loop ended before its time.
    #[error("the {0} thread panicked; its message says why")]
    Died(&'static str),
}
