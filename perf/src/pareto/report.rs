//! What is reported: points, scenes, the survival map, the drape study; as JSON and CSV.

use serde::Serialize;
use toile_assets::put_line;

/// One setting of one scene: what a step costs and what it ends at.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct Point {
    /// Name of the scene.
    pub scene: String,
    /// Name of the mesh.
    pub mesh: String,
    /// Particles of the mesh.
    pub particles: usize,
    /// What fibers are solved by: gauss-seidel, semi-implicit, mixed (as the bake chooses), zero-stretch.
    pub solver: &'static str,
    /// What is solved in a substep.
    pub quality: &'static str,
    /// Substeps of a step.
    pub substeps: u32,
    /// Passes over the weft a substep; over the fibers where the weft is solved with them.
    pub iterations: usize,
    /// Whether garment and quality ask for these substeps themselves.
    pub default: bool,
    /// Backend that steps it: `cpu`.
    pub backend: &'static str,
    /// Workers of a step.
    pub threads: usize,
    /// Median time of a step (us).
    pub step_us: f64,
    /// Mean distance of the free particles to x* over the frames that are compared (mm).
    pub error_mm: f64,
    /// Largest distance of any of them (mm).
    pub max_mm: f64,
    /// Mean |length / rest - 1| of warp and weft edges.
    pub strain_mean: f64,
    /// Mean over the frames of its 99th percentile.
    pub strain_p99: f64,
    /// Energy at the end: motion, weight, bending, stretch of what gives (J).
    pub energy_j: f64,
    /// Steps that were not finite and were rolled back.
    pub rolled_back: u64,
    /// Whether no other of the same scene, mesh and threads is both faster and nearer.
    pub on_front: bool,
}

/// The walking skirt in a fabric with one model of cloth beyond one slope, stepped with it or without.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct ModelPoint {
    /// Name of the model that the fabric has numbers for.
    pub model: &'static str,
    /// Whether it was stepped with it.
    pub with: bool,
    /// What is solved in a substep.
    pub quality: &'static str,
    /// Substeps of a step.
    pub substeps: u32,
    /// Whether garment and quality ask for these substeps themselves.
    pub default: bool,
    /// Median time of a step (us).
    pub step_us: f64,
    /// Mean distance of the free particles to x*, which has the model (mm).
    pub error_mm: f64,
    /// Largest distance of any of them (mm).
    pub max_mm: f64,
    /// Mean |length / rest - 1| of warp and weft edges, and its 99th percentile.
    pub strain: [f64; 2],
    /// How far x* may itself be off (mm).
    pub reference_gap_mm: f64,
    /// Steps that were not finite and were rolled back.
    pub rolled_back: u64,
}

/// Energy by frame under one setting.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct EnergyRun {
    /// Name of the setting.
    pub setting: String,
    /// Time (s) and energy (J) of each frame that is compared.
    pub frames: Vec<[f64; 2]>,
}

/// One scene in one mesh.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct SceneReport {
    /// Name of the scene.
    pub scene: String,
    /// Name of the mesh.
    pub mesh: String,
    /// Particles of the mesh.
    pub particles: usize,
    /// Length of its threads' links, mean of the warp (mm).
    pub spacing_mm: f64,
    /// Whether all settings were run, as on the mesh that is worn.
    pub main: bool,
    /// What its x* is.
    pub reference: String,
    /// How far that may itself be off (mm): half as many substeps end so far from it, or what Newton left.
    pub reference_gap_mm: f64,
    /// Energy by frame, of the reference and of the qualities' own settings.
    pub energy: Vec<EnergyRun>,
}

/// What became of the skirt under a mass ratio and a time step.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Fate {
    /// Finite, and its 99th percentile of strain within [`Survival::strained_p99`].
    Stable,
    /// Finite, but stretched beyond it.
    Strained,
    /// At least one step was not finite and was rolled back.
    RolledBack,
}

/// Which settings the skirt survives.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct Survival {
    /// Mass of a hem particle over that of its neighbours above (1).
    pub mass_ratios: Vec<f64>,
    /// Time steps (s), each of [`Self::substeps`] substeps.
    pub steps_s: Vec<f64>,
    /// Substeps of a step, whatever its length.
    pub substeps: u32,
    /// Strain from which cloth counts as strained (1).
    pub strained_p99: f64,
    /// What became of it `[steps_s][mass_ratios]`.
    pub fate: Vec<Vec<Fate>>,
    /// The largest 99th percentile of strain of any of the second half of its frames (1), likewise.
    pub strain_p99: Vec<Vec<f64>>,
}

/// The tablecloth at one sampling.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct Sampling {
    /// Distance of its particles (cm).
    pub spacing_cm: f64,
    /// Particles of the tablecloth.
    pub particles: usize,
    /// Mean distance to the finest, over the particles that both have and that hang (cm).
    pub mean_cm: f64,
    /// Largest of these distances (cm).
    pub max_cm: f64,
    /// The published mean distance to a real cloth (cm), a different reference.
    pub published_cm: Option<f64>,
    /// Median time of a step (us).
    pub step_us: f64,
    /// Speed of its fastest particle at the end (mm/s): whether it had come to rest.
    pub fastest_mm_s: f64,
}

/// A tablecloth at several samplings.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct Drape {
    /// What cloth on what table.
    pub setup: String,
    /// Coarsest first; the last is the one that the others are held against.
    pub samplings: Vec<Sampling>,
}

/// All figures of a run.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct ParetoReport {
    /// Whether it was a quick look: few settings of small meshes.
    pub quick: bool,
    /// Every setting of every scene.
    pub points: Vec<Point>,
    /// Every scene in every mesh.
    pub scenes: Vec<SceneReport>,
    /// The map of what the skirt survives; none where it was not run.
    pub survival: Option<Survival>,
    /// The skirt with and without each model; empty where it was not run.
    pub models: Vec<ModelPoint>,
    /// The tablecloth by its sampling; none where it was not run.
    pub drape: Option<Drape>,
}

/// A file of the report.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ReportFile {
    /// Name of the file.
    pub name: String,
    /// Content of the file.
    pub bytes: Vec<u8>,
}

/// The points of the models as a table of comma-separated values, a head line first.
pub fn models_csv(points: &[ModelPoint]) -> String {
    let mut text = String::from(
        "model,with,quality,substeps,default,step_us,error_mm,max_mm,strain_mean,strain_p99,reference_gap_mm,rolled_back\n",
    );
    for p in points {
        let ModelPoint { model, with, quality, substeps, default, step_us, error_mm, max_mm, .. } = p;
        let ([mean, p99], gap, rolled_back) = (p.strain, p.reference_gap_mm, p.rolled_back);
        put_line!(
            text,
            "{model},{with},{quality},{substeps},{default},{step_us:.2},{error_mm:.6},{max_mm:.6},{mean:.6e},{p99:.6e},\
             {gap:.6},{rolled_back}"
        );
    }
    text
}

/// All points as a table of comma-separated values, a head line first.
pub fn csv(points: &[Point]) -> String {
    let mut text = String::from(
        "scene,mesh,particles,solver,quality,substeps,iterations,default,backend,threads,step_us,error_mm,max_mm,\
         strain_mean,strain_p99,energy_j,rolled_back,on_front\n",
    );
    for p in points {
        put_line!(
            text,
            "{},{},{},{},{},{},{},{},{},{},{:.2},{:.6},{:.6},{:.6e},{:.6e},{:.9},{},{}",
            p.scene,
            p.mesh,
            p.particles,
            p.solver,
            p.quality,
            p.substeps,
            p.iterations,
            p.default,
            p.backend,
            p.threads,
            p.step_us,
            p.error_mm,
            p.max_mm,
            p.strain_mean,
            p.strain_p99,
            p.energy_j,
            p.rolled_back,
            p.on_front
        );
    }
    text
}
