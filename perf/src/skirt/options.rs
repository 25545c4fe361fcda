//! What a run of the skirt is asked for, and the engine's settings for it: the one place that knows both.

use toile_assets::scene::skirt::{self, SkirtMotion, Stretch};
use toile_engine::cloth::{ContactRates, Quality, Settings, Wind};
use toile_engine::lanes::Width;
use toile_gpu::backend::Backend;

use super::error::SkirtError;

toile_base::named! {
    /// How the skirt is meshed.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
    pub enum SkirtMesh {
        /// A regular grid of rows and columns.
        #[default]
        Grid = "grid",
        /// As many vertices strewn at random, Delaunay triangles.
        Irregular = "irregular",
    }
}

/// One run of the benchmark.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SkirtOptions {
    /// Vertices; a square.
    pub verts: usize,
    /// What the body does.
    pub motion: SkirtMotion,
    /// How the skirt is meshed.
    pub mesh: SkirtMesh,
    /// How its threads stretch.
    pub stretch: Stretch,
    /// Whether its bending rubs.
    pub hysteresis: bool,
    /// Whether its stretch and its shear have curves and rub.
    pub curves: bool,
    /// Whether its threads buckle.
    pub buckling: bool,
    /// Wind of the scene.
    pub wind: bool,
    /// Whether each skirt keeps from passing through itself.
    pub folds: bool,
    /// Threads that step.
    pub threads: usize,
    /// Equal skirts on equal bodies, stepped one after the other or shared between threads.
    pub garments: usize,
    /// Lane width; the widest if not given.
    pub lanes: Option<Width>,
    /// Tested settings; the engine's own choice if not given.
    pub quality: Option<Quality>,
    /// Substeps of a step; the engine's own choice if not given.
    pub substeps: Option<u32>,
    /// Length of a step (s), 1/120 unless a case asks for another.
    pub step_s: f32,
    /// Runs of which the median is reported.
    pub runs: usize,
    /// Steps of a run.
    pub steps: usize,
    /// What steps the skirts; the threads are the processor's.
    pub backend: Backend,
}

/// Most skirts at once.
pub const MAX_GARMENTS: usize = 64;

/// Steps before the first that counts, by the scene.
pub const WARM_UP: usize = 240;

/// Seed of the irregular mesh.
pub const MESH_SEED: u64 = 1;

impl Default for SkirtOptions {
    /// 4,096 vertices, walk, one thread, five runs of 600 steps.
    fn default() -> Self {
        Self {
            verts: 4_096,
            motion: SkirtMotion::Walk,
            mesh: SkirtMesh::Grid,
            stretch: Stretch::Inextensible,
            hysteresis: false,
            curves: false,
            buckling: false,
            wind: false,
            folds: false,
            threads: 1,
            garments: 1,
            lanes: None,
            quality: None,
            substeps: None,
            step_s: toile_base::limits::STEP_SECONDS,
            runs: 5,
            steps: 600,
            backend: Backend::Cpu,
        }
    }
}

impl SkirtOptions {
    /// Vertices a side.
    ///
    /// # Errors
    /// Where `verts` is not a square.
    pub fn side(&self) -> Result<usize, SkirtError> {
        let n = self.verts.isqrt();
        if n * n == self.verts && n >= 8 { Ok(n) } else { Err(SkirtError::NotSquare { verts: self.verts }) }
    }

    /// The engine's settings.
    ///
    /// # Errors
    /// Where the engine cannot do what is asked for, with the option's name.
    pub fn settings(&self) -> Result<Settings, SkirtError> {
        if let Some(width) = self.lanes.filter(|w| !w.available()) {
            return Err(SkirtError::NoSuchLanes { lanes: width.lanes(), widest: Width::widest().lanes() });
        }
        let default = Settings::default();
        Ok(Settings {
            quality: self.quality.unwrap_or(default.quality),
            substeps: self.substeps,
            step_seconds: self.step_s,
            wind: self.wind.then(|| {
                let (velocity, drag, lift) = skirt::WIND;
                Wind { velocity: velocity.into(), drag, lift }
            }),
            workers: self.threads,
            contact: ContactRates::on(self.folds, true, true),
            width: self.lanes.unwrap_or(default.width),
            ..default
        })
    }
}
