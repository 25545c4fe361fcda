//! Why the own picture cannot be measured.

use toile_fitting::FittingError;
use toile_pose::files::PoseError;
use toile_track::tape_readings::TapeError;

/// Why it cannot be measured.
#[derive(Debug, thiserror::Error)]
pub enum OwnPictureError {
    /// The shopper cannot be dressed.
    #[error(transparent)]
    Fitting(#[from] FittingError),
    /// The folder holds another network than expected.
    #[error(transparent)]
    Pose(#[from] PoseError),
    /// The shopper's tape readings fit no person.
    #[error(transparent)]
    Tape(#[from] TapeError),
}
