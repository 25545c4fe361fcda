//! Why the benchmark cannot run as asked.

use thiserror::Error;
use toile_assets::body::BodyError;
use toile_bake::check::MeshError;
use toile_engine::colliders::ColliderError;
use toile_engine::workers::WorkerPoolError;

/// Why the benchmark cannot run as asked.
#[derive(Debug, Error)]
pub enum SkirtError {
    /// A number of vertices that is no square.
    #[error("{verts} vertices do not make a square grid of at least 8 x 8; give 1024, 4096 or 16384, for example")]
    NotSquare {
        /// What was asked for.
        verts: usize,
    },
    /// Something that the engine cannot do.
    #[error("the cloth cannot do {option} yet; leave it out")]
    Unsupported {
        /// Name of the option.
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
    /// A mesh that cannot be cloth.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// A body that the engine does not take.
    #[error(transparent)]
    Colliders(#[from] ColliderError),
    /// The worker pool cannot be started.
    #[error(transparent)]
    WorkerPool(#[from] WorkerPoolError),
    /// The body of the reference loop cannot be built.
    #[error(transparent)]
    Body(#[from] BodyError),
}
