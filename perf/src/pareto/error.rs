//! Why the figures cannot be taken.

use thiserror::Error;
use toile_assets::body::BodyError;
use toile_assets::fabric::FabricError;
use toile_assets::garment::MeshError;
use toile_assets::sizes::SizeError;
use toile_assets::wardrobe::WardrobeError;
use toile_engine::colliders::ColliderError;
use toile_engine::workers::WorkerPoolError;

use crate::oracle::OracleError;
use crate::skirt::SkirtError;

/// Why the figures cannot be taken.
#[derive(Debug, Error)]
pub enum ParetoError {
    /// A scene's mesh.
    #[error("a scene's mesh cannot be baked: {0}")]
    Mesh(#[from] MeshError),
    /// A scene's fabric.
    #[error(transparent)]
    Fabric(#[from] FabricError),
    /// The mannequin.
    #[error(transparent)]
    Body(#[from] BodyError),
    /// A garment of the wardrobe.
    #[error(transparent)]
    Wardrobe(#[from] WardrobeError),
    /// Its sizes.
    #[error(transparent)]
    Sizes(#[from] SizeError),
    /// A scene's solids.
    #[error("a scene's colliders are refused: {0}")]
    Colliders(#[from] ColliderError),
    /// The engine's workers.
    #[error(transparent)]
    WorkerPool(#[from] WorkerPoolError),
    /// x*.
    #[error("x* was not found: {0}")]
    Oracle(#[from] OracleError),
    /// The survival map's skirt.
    #[error(transparent)]
    Skirt(#[from] SkirtError),
    /// A plot.
    #[error(transparent)]
    Picture(#[from] toile_view::image::Error),
    /// A scene that is not one.
    #[error("there is no scene {0} to plot; give one of those that `toile pareto --help` names")]
    Unknown(String),
}
