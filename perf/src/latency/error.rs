//! Why latency cannot be measured.

use thiserror::Error;
use toile_engine::workers::WorkerPoolError;

/// Why the figures cannot be taken.
#[derive(Debug, Error)]
pub enum LatencyError {
    /// The system gave no thread.
    #[error("a thread of the loop could not be started ({0}); raise the limit of threads")]
    Spawn(#[from] std::io::Error),
    /// The worker pool cannot be started.
    #[error(transparent)]
    WorkerPool(#[from] WorkerPoolError),
    /// A thread of the loop ended before its time.
    #[error("the {0} thread panicked; its message says why")]
    Died(&'static str),
}
