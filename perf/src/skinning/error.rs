//! Why the benchmark cannot run.

use thiserror::Error;
use toile_assets::body::BodyError;
use toile_engine::lanes::Width;
use toile_engine::skin::SkinError;
use toile_engine::workers::WorkerPoolError;

/// Why the benchmark cannot run.
#[derive(Debug, Error)]
pub enum SkinningError {
    /// The shopper's body.
    #[error(transparent)]
    Body(#[from] BodyError),
    /// The shopper's skin.
    #[error(transparent)]
    Skin(#[from] SkinError),
    /// The worker pool cannot be started.
    #[error(transparent)]
    WorkerPool(#[from] WorkerPoolError),
    /// Lanes that this processor lacks.
    #[error("this processor has no {0} lanes; ask for fewer, or leave `--lanes` out")]
    NoSuchLanes(Width),
    /// There is no graphics device, or it refuses; the sentence has the cure.
    #[error("{0}")]
    Device(String),
}
