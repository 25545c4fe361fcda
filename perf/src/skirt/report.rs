//! The report of a run of the skirt: time and error of the same steps.

use std::collections::BTreeMap;

use serde::Serialize;
use toile_fitting::scene::StepTimes;
use toile_fitting::scene::events::ClothEvents;
use toile_gpu::backend::BackendTimes;

use super::options::SkirtOptions;
use crate::backend::SteppedBy;
use toile_fitting::crossings::CrossingFigures;

/// How far warp and weft edges are from their length, as a part of it (0.01 is 1 %).
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct SkirtStrain {
    /// Mean of |l/l0 - 1| over edges and frames.
    pub mean: f64,
    /// Mean of the frames' 99th percentiles.
    pub p99: f64,
    /// Mean of each run: what grows from run to run is not stable.
    pub run_mean: Vec<f64>,
    /// The worst stretch of any edge in any frame.
    pub max: f64,
    /// The worst compression.
    pub compression_max: f64,
    /// The worst |l/l0 - 1| beyond the exact elastic strain of the hanging skirt.
    pub beyond_elastic_max: f64,
    /// Mean of the same.
    pub beyond_elastic_mean: f64,
    /// Edges that were measured.
    pub edges: usize,
}

/// How deep vertices were inside the body as it was asked for.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct Penetration {
    /// The deepest vertex of any frame (mm).
    pub max: f64,
    /// Mean part of the vertices that are inside by more than 0.01 mm (0..1).
    pub fraction: f64,
    /// Vertices inside at the end of each run, summed over the runs.
    pub left_inside: u64,
}

/// What both took for one step of these skirts, in step with the caller: medians of some steps at the start (us).
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Decision {
    /// The processor, with the threads that were asked for.
    pub cpu_us: f64,
    /// The graphics device.
    pub gpu_us: f64,
}

impl From<BackendTimes> for Decision {
    fn from(BackendTimes { cpu_us, gpu_us }: BackendTimes) -> Self {
        Self { cpu_us, gpu_us }
    }
}

/// Everything that one run measured.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct SkirtReport {
    /// Vertices of one skirt.
    pub verts: usize,
    /// `walk`, `fast` or `settled`.
    pub motion: &'static str,
    /// `grid` or `irregular`.
    pub mesh: &'static str,
    /// `inextensible` or `physical`.
    pub stretch: &'static str,
    /// Whether its bending rubs.
    pub hysteresis: bool,
    /// Whether its stretch and its shear have curves and rub.
    pub curves: bool,
    /// Whether its threads buckle.
    pub buckling: bool,
    /// Whether there is wind.
    pub wind: bool,
    /// Whether each keeps from passing through itself.
    pub folds: bool,
    /// Skirts that were stepped.
    pub garments: usize,
    /// Threads that stepped them.
    pub threads: usize,
    /// Lanes of the kernels.
    pub lanes: usize,
    /// `draft`, `shop` or `fine`.
    pub quality: &'static str,
    /// Substeps of a step.
    pub substeps: u32,
    /// Steps before the first that counts.
    pub warm_up: usize,
    /// Number of runs.
    pub runs: usize,
    /// Steps of a run.
    pub steps: usize,
    /// Time of a step of all skirts, colliders' placing included.
    pub step_us: StepTimes,
    /// Median step of each run (us).
    pub run_p50_us: Vec<f64>,
    /// Reference time of the same run (us): the median of one reading before each run and one after the last.
    pub yardstick_us: f64,
    /// Median step over the reference time.
    pub y_ratio: f64,
    /// Median step a vertex (ns).
    pub ns_per_vertex: f64,
    /// Strain of the same steps.
    pub strain: SkirtStrain,
    /// Penetration of the same steps.
    pub penetration_mm: Penetration,
    /// Frames in which the hem did not go around each leg exactly once.
    pub hem_winding_wrong: u64,
    /// Edges of a skirt that passed through its faces, every tenth step.
    pub crossings: Option<CrossingFigures>,
    /// Vertices that were not finite, summed over the frames.
    pub nonfinite: u64,
    /// What stepped the skirts.
    pub stepped_by: SteppedBy,
    /// What `auto` was decided by.
    pub decided_by: Option<Decision>,
    /// Mean time of a step by the device's own clock, from its first kernel to its last (us), where it has one: of steps that are
    /// metered, which go in a pass a stage; a plain step is a little shorter.
    pub device_us: Option<f64>,
    /// Mean time of each stage of a step (us), as far as the engine or the device reports them.
    pub stages_us: BTreeMap<&'static str, f64>,
    /// Of these the greater of the two workers' shares, phase by phase (us): what two threads cannot go below; empty where the garment
    /// is not shared.
    pub greater_share_us: BTreeMap<&'static str, f64>,
    /// Heap allocations a step, of all threads, where they are counted.
    pub allocations_per_step: Option<f64>,
    /// Heap bytes of the baked garment and of all skirts' states, where they are counted.
    pub memory_bytes: Option<u64>,
    /// Of these the garment's, which equal skirts share; it holds what is drawn and measured as well.
    pub memory_garment_bytes: Option<u64>,
    /// Energy of motion at the end (mJ).
    pub kinetic_energy_mj: f64,
    /// The greatest of the last 120 steps (mJ).
    pub kinetic_energy_max_mj: f64,
    /// What happened that should not have.
    pub events: ClothEvents,
    /// Hash of the last state, 16 hexadecimal digits.
    pub state_hash: String,
}

impl SkirtReport {
    /// A report that says what was asked for, and nothing yet of how it went.
    pub fn of(options: &SkirtOptions) -> Self {
        Self {
            verts: options.verts,
            motion: options.motion.name(),
            mesh: options.mesh.name(),
            stretch: options.stretch.name(),
            hysteresis: options.hysteresis,
            curves: options.curves,
            buckling: options.buckling,
            wind: options.wind,
            folds: options.folds,
            garments: options.garments,
            threads: options.threads,
            runs: options.runs,
            steps: options.steps,
            ..Self::default()
        }
    }
}
