//! Cause of a failed call, in one sentence with its cure.

use std::fmt::Display;

use toile_fitting::FittingError;

/// Whose matter an error is. New kinds may come in a minor version.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum ErrorKind {
    /// The call itself: a garment's number out of range, a step of a kind that this scene does not take.
    Usage,
    /// What was given: a file, a name, a measure, a mesh.
    Input,
    /// What the system does not give: a thread, a device, a file that cannot be written.
    Device,
    /// A fault of Toile's own.
    Internal,
}

impl ErrorKind {
    /// Its name, as the bindings to other languages have it.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Usage => "usage",
            Self::Input => "input",
            Self::Device => "device",
            Self::Internal => "internal",
        }
    }
}

/// The one error of this crate: a kind for programs, and for people a sentence that says what is wrong, where, and what cures it.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{sentence}")]
pub struct Error {
    kind: ErrorKind,
    sentence: String,
}

/// What a call gives.
pub type Result<T> = std::result::Result<T, Error>;

impl Error {
    pub(crate) fn usage(sentence: impl Display) -> Self {
        Self { kind: ErrorKind::Usage, sentence: sentence.to_string() }
    }

    pub(crate) fn input(sentence: impl Display) -> Self {
        Self { kind: ErrorKind::Input, sentence: sentence.to_string() }
    }

    pub(crate) fn device(sentence: impl Display) -> Self {
        Self { kind: ErrorKind::Device, sentence: sentence.to_string() }
    }

    /// Whose matter it is.
    pub const fn kind(&self) -> ErrorKind {
        self.kind
    }

    /// The sentence.
    pub fn sentence(&self) -> &str {
        &self.sentence
    }
}

impl From<FittingError> for Error {
    fn from(error: FittingError) -> Self {
        let kind = match error {
            FittingError::Usage(_) => ErrorKind::Usage,
            FittingError::Input(_) => ErrorKind::Input,
            FittingError::Device(_) => ErrorKind::Device,
            FittingError::Internal(_) => ErrorKind::Internal,
        };
        Self { kind, sentence: error.to_string() }
    }
}
