//! Cause of a failed study: one sentence with its cure.

use std::fmt::Display;
use std::io;
use std::path::Path;

use toile_fitting::FittingError;

/// The error of this crate; each sentence says what, where, and the cure.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum StudyError {
    /// A file, a name, a measure that cannot be used.
    #[error("{0}")]
    Input(String),
    /// What the system does not give: a full disk, a folder in use.
    #[error("{0}")]
    Device(String),
    /// A fault of Toile's own.
    #[error("{0}")]
    Internal(String),
}

/// What a call gives.
pub type Result<T> = std::result::Result<T, StudyError>;

impl StudyError {
    /// Bad input, described by the error of the crate that read it.
    pub fn input(error: impl Display) -> Self {
        Self::Input(error.to_string())
    }

    /// A fault of Toile's own.
    pub fn internal(error: impl Display) -> Self {
        Self::Internal(error.to_string())
    }

    /// A file that cannot be written.
    pub(crate) fn unwritten(path: &Path, why: &io::Error) -> Self {
        Self::Device(format!(
            "{} cannot be written ({why}); free some space there and give the same command again: what is done is kept",
            path.display()
        ))
    }
}

impl From<FittingError> for StudyError {
    fn from(error: FittingError) -> Self {
        match error {
            FittingError::Internal(text) => Self::Internal(text),
            FittingError::Device(text) => Self::Device(text),
            FittingError::Usage(text) | FittingError::Input(text) => Self::Input(text),
        }
    }
}
