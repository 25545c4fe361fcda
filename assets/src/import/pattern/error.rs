//! Why a pattern cannot be read: the file, what is wrong in it, and the cure, in one sentence.

use thiserror::Error;

use crate::file::FileError;
use crate::pattern::PatternFlaw;
use crate::toml_keys::nearest;

/// Why a pattern cannot be read.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum PatternError {
    /// The file of the pattern or of its seams cannot be read, or is too large.
    #[error(transparent)]
    File(#[from] FileError),
    /// The text is not what its format asks for.
    #[error("{file}: {reason}")]
    Content {
        /// The file as the user named it.
        file: String,
        /// The fault, its place and its cure.
        reason: String,
    },
    /// It can be read and is no pattern that can be sewn.
    #[error("{file}: {flaw}")]
    Flaw {
        /// The file as the user named it.
        file: String,
        /// The fault, its place and its cure.
        flaw: PatternFlaw,
    },
}

/// Fault found by a reader that does not know the file's name.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum PatternFault {
    /// A sentence with its cure.
    Content(String),
    /// A flaw of the pattern itself.
    Flaw(PatternFlaw),
}

impl PatternFault {
    /// The error in a file.
    pub fn of(self, file: &str) -> PatternError {
        match self {
            Self::Content(reason) => PatternError::Content { file: file.into(), reason },
            Self::Flaw(flaw) => PatternError::Flaw { file: file.into(), flaw },
        }
    }
}

impl From<String> for PatternFault {
    fn from(reason: String) -> Self {
        Self::Content(reason)
    }
}

impl From<PatternFlaw> for PatternFault {
    fn from(flaw: PatternFlaw) -> Self {
        Self::Flaw(flaw)
    }
}

/// Names longer than this (bytes) are compared with no other: that takes time by the product of both lengths.
const COMPARED_NAME: usize = 64;

/// The cure of a name that is not known: the one that may have been meant, or what else to do.
pub(super) fn meant<'n>(name: &str, known: impl Iterator<Item = &'n str>, otherwise: &str) -> String {
    let short = known.filter(|k| k.len() <= COMPARED_NAME && name.len() <= COMPARED_NAME);
    nearest(name, short).map_or_else(|| otherwise.to_owned(), |meant| format!("did you mean {meant}?"))
}
