//! The report of garments on a mannequin: time and error of the same steps.

use std::collections::BTreeMap;

use serde::Serialize;
use toile_fitting::scene::StepTimes;
use toile_fitting::scene::events::ClothEvents;

use crate::backend::SteppedBy;

/// How far edges that can move are from their length, as a part of it (0.01 is 1 %).
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct WornStrain {
    /// Mean of |l/l0 - 1| over edges, garments and frames.
    pub mean: f64,
    /// Mean of the frames' 99th percentiles.
    pub p99: f64,
    /// The worst of any edge in any frame.
    pub max: f64,
}

/// Everything that one run measured.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct WornReport {
    /// The garments, in wearing order.
    pub garments: Vec<String>,
    /// Their sizes.
    pub sizes: Vec<String>,
    /// Particles that move, of all garments.
    pub moving: usize,
    /// Name of the quality.
    pub quality: &'static str,
    /// Substeps of a step, a garment.
    pub substeps: Vec<u32>,
    /// Lanes of the kernels.
    pub lanes: usize,
    /// Threads that stepped.
    pub threads: usize,
    /// Runs of which the median is reported.
    pub runs: usize,
    /// Steps of a run.
    pub steps: usize,
    /// Time of a step (us); `p50` is the median of the runs' medians.
    pub step_us: StepTimes,
    /// Median of each run (us).
    pub run_p50_us: Vec<f64>,
    /// Strain of the same steps.
    pub strain: WornStrain,
    /// Deepest free particle inside the body at the end of any step (mm).
    pub deepest_mm: f64,
    /// Mean time of each stage of a step, in steps of their own with the meters on (us).
    pub stages_us: BTreeMap<&'static str, f64>,
    /// Heap allocations a step, where the program counts them.
    pub allocations_per_step: Option<f64>,
    /// Heap memory of the baked garments and their states (bytes), where the program counts it.
    pub memory_bytes: Option<u64>,
    /// What happened that should not have.
    pub events: ClothEvents,
    /// What stepped the garments.
    pub stepped_by: SteppedBy,
    /// Hash of the positions at the end of the last run.
    pub state_hash: String,
}
