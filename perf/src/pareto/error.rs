//! Why a scene cannot be run or plotted.

use thiserror::Error;
use toile_bake::check::MeshError;
use toile_engine::colliders::ColliderError;
use toile_engine::workers::WorkerPoolError;

use crate::oracle::OracleError;
use crate::worn::WornError;

/// Why the figures cannot be taken.
#[derive(Debug, Error)]
pub enum ParetoError {
    /// A scene's mesh that cannot be cloth.
    #[error("a scene's mesh cannot be baked: {0}")]
    Mesh(#[from] MeshError),
    /// A scene's solids that the engine does not take.
    #[error("a scene's colliders are refused: {0}")]
    Colliders(#[from] ColliderError),
    /// The worker pool cannot be started.
    #[error(transparent)]
    WorkerPool(#[from] WorkerPoolError),
    /// The reference solution x* was not found.
    #[error("x* was not found: {0}")]
    Oracle(#[from] OracleError),
    /// A garment that cannot be worn.
    #[error(transparent)]
    Worn(#[from] WornError),
    /// A plot that cannot be written as a picture.
    #[error(transparent)]
    Picture(#[from] toile_view::image::Error),
    /// A scene that is not one.
    #[error("there is no scene {0} to plot; give one of those that `toile pareto --help` names")]
    Unknown(String),
}
