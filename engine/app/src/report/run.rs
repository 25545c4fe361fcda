//! The JSON of `toile run`.

use std::collections::BTreeMap;
use std::path::PathBuf;

use serde::Serialize;
use toile_fitting::scene::StepTimes;
use toile_fitting::scene::contact::ContactReport;
use toile_fitting::scene::events::ClothEvents;

use super::{CrossingReport, StrainReport};

/// One garment of `toile run`.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct RunGarment {
    /// Name in the scene.
    pub name: String,
    /// Vertices of the user's mesh.
    pub vertices: usize,
    /// Particles: fewer where vertices were sewn together or belong to no face.
    pub particles: usize,
    /// Particles that are pinned.
    pub pinned: usize,
    /// The fabric's name.
    pub fabric: String,
    /// Mass of the whole (kg), pinned parts included.
    pub mass_kg: f64,
}

/// How deep cloth was inside colliders, in `toile run`.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct RunPenetration {
    /// The deepest free particle in any step (mm); 0 where none was ever inside.
    pub max: f64,
    /// Share of the free particles that were inside, mean over steps.
    pub fraction: f64,
}

/// Kinetic energy of all free particles (J).
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct KineticEnergy {
    /// After the last step.
    pub end: f64,
    /// The most after any step.
    pub max: f64,
}

/// The body of `toile run`.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct RunReport {
    /// The scene's name.
    pub scene: String,
    /// Garments of the scene.
    pub garments: Vec<RunGarment>,
    /// Spheres among the colliders.
    pub spheres: usize,
    /// Capsules, single spheres included.
    pub capsules: usize,
    /// Planes among the colliders.
    pub planes: usize,
    /// Steps a second.
    pub hz: f64,
    /// Steps that were run.
    pub steps: u64,
    /// Time reached (s).
    pub seconds: f64,
    /// Steps that the figures below are of.
    pub measured_steps: u64,
    /// The quality's name.
    pub quality: &'static str,
    /// Substeps of a step: the most of any garment.
    pub substeps: u32,
    /// Lanes that kernels ran on.
    pub lanes: usize,
    /// Time a step took, all garments.
    pub step_us: StepTimes,
    /// Mean time of each stage of a step, from one step in sixteen, which does not count above (us).
    pub stages_us: BTreeMap<&'static str, f64>,
    /// The benchmark's plain skinning loop on this machine (us): how fast it is; left out of the summary.
    pub yardstick_us: Option<f64>,
    /// Allocations a step.
    pub allocations_per_step: Option<f64>,
    /// Bytes of the baked garments and their states together.
    pub memory_bytes: Option<u64>,
    /// How far edges were stretched.
    pub strain: StrainReport,
    /// How deep cloth was inside colliders.
    pub penetration_mm: RunPenetration,
    /// Kinetic energy (J).
    pub kinetic_energy_j: KineticEnergy,
    /// Published positions that were not finite.
    pub nonfinite: u64,
    /// What the guards had to do.
    pub events: ClothEvents,
    /// Edges that passed through faces, by a test of its own; none where the scene asks for no contact of cloth with cloth.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub crossings: Option<CrossingReport>,
    /// What contact of cloth with cloth did; none where the scene asks for none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub contact: Option<ContactReport>,
    /// What was full, one sentence each.
    pub warnings: Vec<String>,
    /// Hash of the last state, 16 hexadecimal digits; the same scene gives the same.
    pub state_hash: String,
    /// The folder of the dump; `index.csv` in it lists its files.
    pub dump: Option<PathBuf>,
    /// Frames that were written to the dump.
    pub dumped_frames: u64,
}
