//! Why the benchmark cannot run as asked.

use thiserror::Error;
use toile_assets::body::BodyError;
use toile_assets::garment::MeshError;
use toile_engine::colliders::ColliderError;
use toile_engine::workers::WorkerPoolError;

/// Why the benchmark cannot run as asked.
#[derive(Debug, Error)]
pub enum SkirtError {
    /// Not a grid.
    #[error("{verts} vertices do not make a square grid of at least 8 x 8; give 1024, 4096 or 16384, for example")]
    NotSquare {
        /// What was asked for.
        verts: usize,
    },
    /// Something that the engine cannot do.
    #[error("the cloth cannot do {option} yet; leave it out")]
    Unsupported {
        /// The option.
        option: &'static str,
    },
    /// A width that the processor lacks.
    #[error("this processor has no {lanes} lanes of f32; give --lanes {widest} or less")]
    NoSuchLanes {
        /// Lanes asked for.
        lanes: usize,
        /// The most it has.
        widest: usize,
    },
    /// The scene's mesh.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// The scene's body.
    #[error(transparent)]
    Colliders(#[from] ColliderError),
    /// The engine's workers.
    #[error(transparent)]
    WorkerPool(#[from] WorkerPoolError),
    /// The yardstick's body.
    #[error(transparent)]
    Body(#[from] BodyError),
}
