//! Why a garment cannot be worn and measured.

use thiserror::Error;
use toile_assets::body::BodyError;
use toile_assets::drafting::WardrobeError;
use toile_assets::draping::PackageError;
use toile_assets::fabric::FabricError;
use toile_assets::sizes::SizeError;
use toile_bake::check::MeshError;
use toile_engine::colliders::ColliderError;
use toile_engine::skin::SkinError;
use toile_engine::workers::WorkerPoolError;

/// Why a garment cannot be worn and measured.
#[derive(Debug, Error)]
pub enum WornError {
    /// More garments than one mannequin wears.
    #[error("{given} garments are too many for one mannequin; give {most} at most")]
    TooMany {
        /// What was asked for.
        given: usize,
        /// As many as one wears.
        most: usize,
    },
    /// A width that the processor lacks.
    #[error("this processor has no {lanes} lanes of f32; give --lanes {widest} or less")]
    NoSuchLanes {
        /// Lanes asked for.
        lanes: usize,
        /// The most it has.
        widest: usize,
    },
    /// A garment of the wardrobe.
    #[error(transparent)]
    Wardrobe(#[from] WardrobeError),
    /// A garment that cannot be cut or laid on the mannequin.
    #[error(transparent)]
    Package(#[from] PackageError),
    /// A size table that cannot be used.
    #[error(transparent)]
    Sizes(#[from] SizeError),
    /// A mannequin that cannot be built.
    #[error(transparent)]
    Body(#[from] BodyError),
    /// A body whose skin cannot be posed.
    #[error(transparent)]
    Skin(#[from] SkinError),
    /// A mesh that cannot be cloth.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// A fabric that cannot be used.
    #[error(transparent)]
    Fabric(#[from] FabricError),
    /// Solids that the engine does not take.
    #[error(transparent)]
    Colliders(#[from] ColliderError),
    /// The worker pool cannot be started.
    #[error(transparent)]
    WorkerPool(#[from] WorkerPoolError),
}
