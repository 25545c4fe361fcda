//! Why the own picture cannot be measured.

use toile_fitting::FittingError;
use toile_pose::files::PoseError;
use toile_track::tape_readings::TapeError;

/// Why it cannot be measured.
#[derive(Debug, thiserror::Error)]
pub enum OwnPictureError {
    /// Somebody cannot be dressed.
    #[error(transparent)]
    Fitting(#[from] FittingError),
    /// The network is there, and is another one.
    #[error(transparent)]
    Pose(#[from] PoseError),
    /// What the shopper tells is nobody's.
    #[error(transparent)]
    Tape(#[from] TapeError),
}
