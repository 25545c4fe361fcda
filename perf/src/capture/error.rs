//! Why a cloth could not be filmed or followed.

use thiserror::Error;
use toile_capture::error::CaptureError;
use toile_fitting::scene::RunError;

use crate::skirt::SkirtError;

/// Why a study could not be run.
#[derive(Debug, Error)]
pub enum FlowStudyError {
    /// The capture was refused.
    #[error(transparent)]
    Capture(#[from] CaptureError),
    /// The cloth could not be stepped.
    #[error(transparent)]
    Scene(#[from] RunError),
    /// The skirt could not be made.
    #[error(transparent)]
    Skirt(#[from] SkirtError),
}
