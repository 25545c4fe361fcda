//! What is reported: points and scenes; as JSON and CSV.

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

/// All figures of a run.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct ParetoReport {
    /// Whether it was a quick look: few settings of small meshes.
    pub quick: bool,
    /// Every setting of every scene.
    pub points: Vec<Point>,
    /// Every scene in every mesh.
    pub scenes: Vec<SceneReport>,
}

/// A file of the report.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ReportFile {
    /// Name of the file.
    pub name: String,
    /// Content of the file.
    pub bytes: Vec<u8>,
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
