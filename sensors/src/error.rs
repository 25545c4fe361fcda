//! Errors of a recording: one sentence with the fault, its place, and the cure.

use std::fmt;

use toile_assets::file::FileError;

/// Place of a fault in a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FilePlace {
    /// A line of a text file, from 1.
    Line(usize),
    /// A frame, from 0.
    Frame(usize),
    /// An offset from the file's begin.
    Byte(u64),
    /// The file as a whole.
    Whole,
}

impl fmt::Display for FilePlace {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Line(n) => write!(f, ", line {n}"),
            Self::Frame(n) => write!(f, ", frame {n}"),
            Self::Byte(n) => write!(f, ", byte {n}"),
            Self::Whole => Ok(()),
        }
    }
}

/// Why a recording could not be opened or written.
#[derive(Debug, thiserror::Error)]
pub enum SourceError {
    /// The file cannot be read: absent, not a regular file, or too large.
    #[error(transparent)]
    File(#[from] FileError),
    /// A folder cannot be listed, or a file not written.
    #[error("{path}: cannot be {action}: {error}; check that the path exists and that you may use it")]
    Io {
        /// The file or folder.
        path: String,
        /// "read" or "written".
        action: &'static str,
        /// The system's message.
        error: std::io::Error,
    },
    /// The content is of no known kind.
    #[error(
        "{path}: {what}; give a Toile session (.mcap), joints of a Kinect (v1, v2, Azure), Kinectron, MediaPipe or a BVH, \
         a folder of OpenPose keypoints, an Azure Kinect .mkv, 16-bit PNG or raw depth"
    )]
    UnknownKind {
        /// The file's path as the user gave it.
        path: String,
        /// The apparent kind of the file.
        what: &'static str,
    },
    /// The kind is known and its content is wrong.
    #[error("{path}{place}: {problem}; {cure}")]
    Malformed {
        /// The file's path as the user gave it.
        path: String,
        /// The line, frame or byte.
        place: FilePlace,
        /// The fault there.
        problem: String,
        /// The cure.
        cure: &'static str,
    },
}

/// A fault found by a reader, which knows bytes but no path.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct ReaderFault {
    pub place: FilePlace,
    pub problem: String,
    pub cure: &'static str,
}

impl ReaderFault {
    pub fn new(place: FilePlace, problem: impl Into<String>, cure: &'static str) -> Self {
        Self { place, problem: problem.into(), cure }
    }

    pub fn at(self, path: &str) -> SourceError {
        SourceError::Malformed { path: path.to_owned(), place: self.place, problem: self.problem, cure: self.cure }
    }
}
