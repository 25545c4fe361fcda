//! Errors of a capture: one sentence with the fault, its place, and the cure.

use thiserror::Error;
use toile_sensors::error::SourceError;

/// Why a capture was refused or stopped.
#[derive(Debug, Error)]
pub enum CaptureError {
    /// A calibration, a picture or keypoints that cannot be read.
    #[error(transparent)]
    Source(#[from] SourceError),
    /// What was given cannot be captured.
    #[error("{what}: {problem}; {cure}")]
    Unfit {
        /// The file, the camera or the mesh.
        what: String,
        /// What is wrong with it.
        problem: String,
        /// What the user can do about it.
        cure: &'static str,
    },
    /// A file that cannot be written, or read again.
    #[error("{path}: cannot be {action}: {error}; check that the path exists and that you may use it")]
    Io {
        /// The file or folder.
        path: String,
        /// "read" or "written".
        action: &'static str,
        /// What the system said.
        error: std::io::Error,
    },
}

impl CaptureError {
    /// What was given cannot be captured.
    pub fn unfit(what: impl Into<String>, problem: impl Into<String>, cure: &'static str) -> Self {
        Self::Unfit { what: what.into(), problem: problem.into(), cure }
    }
}
