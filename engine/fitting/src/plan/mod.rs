//! Plan: what a scene needs and takes, predicted before it runs.
//!
//! Reads: a scene's baked garments, colliders and motion. Writes: who can touch what, memory, the time of each stage as
//! it is predicted, what each model is worth, whether the scene fits.
//! Budget: some seconds, to learn what this machine needs for a unit of work, and to weigh the models.
//! Thread: the caller's; the engine's workers where their hand-off is timed.

pub mod calibrate;
pub mod cost;
mod fit;
pub mod reach;
pub mod report;
pub mod scene;
pub mod verdict;
pub mod weigh;
pub mod work;

use thiserror::Error;
use toile_assets::scene_file::SceneError;
use toile_engine::colliders::ColliderError;
use toile_engine::frame::FrameError;
use toile_engine::skin::SkinError;
use toile_engine::workers::WorkerPoolError;

use crate::scene::RunError;

/// Why a scene cannot be planned.
#[derive(Debug, Error)]
pub enum PlanError {
    /// Colliders that the engine does not take.
    #[error(transparent)]
    Colliders(#[from] ColliderError),
    /// A frame that cannot be set up.
    #[error(transparent)]
    Frame(#[from] FrameError),
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
