//! What was found, as the JSON has it.

use std::collections::BTreeMap;

use serde::Serialize;
use toile_engine::meter::Meter;
use toile_fitting::live::report::{Attributed, Quantiles, QueueUse, ThreadPlacement};

use super::renderer::OwnPictureFigures;

/// One stage between the sensor and the picture.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LatencyStage {
    /// Name of the stage.
    pub name: &'static str,
    /// What it may take (us), where it has a budget.
    pub budget_us: Option<u64>,
    /// What it took (us).
    pub us: Quantiles,
}

impl LatencyStage {
    /// The stage whose times a meter holds.
    pub fn of(name: &'static str, budget_us: Option<u64>, meter: &Meter) -> Self {
        Self { name, budget_us, us: Quantiles::of(meter) }
    }
}

/// The quality that the run was at, and the error that comes of it.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct QualityFigures {
    /// Name of the quality.
    pub name: &'static str,
    /// Substeps at whole quality.
    pub substeps: u32,
    /// Particles of all garments.
    pub particles: usize,
    /// Of these, those that move on their own.
    pub free: usize,
    /// Steps on each quality level, whole quality first.
    pub rungs: Vec<u64>,
    /// What is given up on each.
    pub gives_up: Vec<&'static str>,
    /// Each change of level, in order: step, from, to; the first hundred.
    pub changes: Vec<[u64; 3]>,
    /// Strain: mean, 99 %, worst (1), of ten steps a second.
    pub strain: [f64; 3],
    /// Deepest penetration in these steps (mm).
    pub penetration_mm: f64,
    /// Steps that were rolled back because of a NaN or an infinity.
    pub nonfinite: u64,
}

/// A goal and what was reached.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Goal {
    /// What is held against the limit.
    pub name: &'static str,
    /// The most that passes (us).
    pub limit_us: f64,
    /// What was measured.
    pub us: f64,
    /// Whether it keeps to it.
    pub pass: bool,
}

impl Goal {
    /// A time that is to be at most the limit (us).
    pub fn new(name: &'static str, limit_us: f64, us: f64) -> Self {
        Self { name, limit_us, us, pass: us <= limit_us }
    }
}

/// Everything that was found.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Latency {
    /// Length that was metered (s).
    pub seconds: u32,
    /// Threads of load beside the loop.
    pub load_threads: usize,
    /// Workers of a step.
    pub workers: usize,
    /// Where the threads ran.
    pub threads: Vec<ThreadPlacement>,
    /// From the sensor to the picture, stage by stage.
    pub stages: Vec<LatencyStage>,
    /// The same by name (us).
    pub stages_us: BTreeMap<&'static str, Quantiles>,
    /// From when a sensor frame was seen until the first picture that shows it was taken (us).
    pub total_us: Quantiles,
    /// From a sensor frame's arrival to the first snapshot that knows it (us).
    pub snapshot_us: Quantiles,
    /// A step, begin to publication (us).
    pub step_us: Quantiles,
    /// From when a step was due until it was published (us), dropped ones included.
    pub response_us: Quantiles,
    /// An empty loop in the same place: due until awake (us).
    pub jitter_us: Quantiles,
    /// Steps that were taken.
    pub steps: u64,
    /// Steps that were published after their period, and those that were dropped.
    pub deadline_misses: u64,
    /// Of these, the dropped ones.
    pub dropped: u64,
    /// Late steps by their causes.
    pub attributed: Attributed,
    /// Frames that the sensor gave.
    pub frames: u64,
    /// Sensor frames whose snapshot came later than the goal, or never.
    pub late_frames: u64,
    /// Pictures that were drawn.
    pub pictures: u64,
    /// What became of the shopper's own picture, where it was drawn.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub own_picture: Option<OwnPictureFigures>,
    /// The quality, and its error.
    pub quality: QualityFigures,
    /// What is to be reached on a quiet machine of two cores.
    pub goals: Vec<Goal>,
    /// How full everything was that has a bound.
    pub capacities: Vec<QueueUse>,
    /// What deserves attention, one sentence each.
    pub warnings: Vec<String>,
    /// Hash of the last state.
    pub state_hash: String,
}
