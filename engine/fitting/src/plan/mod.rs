//! Plan: predicts memory and time of a scene before it runs.
//!
//! It runs on the caller's thread, and on the engine's workers where their hand-off is timed.

pub mod calibrate;
pub mod cost;
mod fit;
mod left_out;
pub mod reach;
pub mod report;
pub mod scene;
pub mod verdict;
pub mod weigh;
pub mod work;

use thiserror::Error;
use toile_assets::scene_file::SceneError;
use toile_base::garment::LayoutError;
use toile_engine::colliders::ColliderError;
use toile_engine::skin::SkinError;
use toile_engine::workers::WorkerPoolError;
use toile_engine::world::WorldError;

use crate::scene::RunError;

/// Why a scene cannot be planned.
#[derive(Debug, Error)]
pub enum PlanError {
    /// Constraints that do not fit together once a model is left out.
    #[error(transparent)]
    Layout(#[from] LayoutError),
    /// Colliders that the engine does not take.
    #[error(transparent)]
    Colliders(#[from] ColliderError),
    /// A frame that cannot be set up.
    #[error(transparent)]
    World(#[from] WorldError),
    /// A scene file that cannot be run.
    #[error(transparent)]
    Run(#[from] RunError),
    /// A skin that the engine does not take.
    #[error(transparent)]
    Skin(#[from] SkinError),
    /// A cloth by which the machine is known.
    #[error(transparent)]
    Calibration(#[from] SceneError),
    /// The worker pool cannot be started.
    #[error(transparent)]
    WorkerPool(#[from] WorkerPoolError),
}
