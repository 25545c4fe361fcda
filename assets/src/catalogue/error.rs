//! Why a catalogue or a package cannot be used.

use thiserror::Error;

use crate::file::FileError;

/// Error of a catalogue or a package; each message says the fault, its place, and the cure.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum CatalogueError {
    /// A file that cannot be read.
    #[error(transparent)]
    File(#[from] FileError),
    /// No zip archive, or one cut short or garbled.
    #[error("{package}: it is no garment package ({reason}); zip garment.toml and the files that it names")]
    Archive {
        /// The package as the user named it.
        package: String,
        /// The reader's message.
        reason: String,
    },
    /// A file that a package lacks, or holds though it must not.
    #[error("{package}: {file}: {reason}")]
    Content {
        /// The package as the user named it.
        package: String,
        /// The file within it.
        file: String,
        /// The fault and its cure.
        reason: String,
    },
    /// A folder that is no catalogue.
    #[error("{folder}: {reason}; give a folder that holds catalogue.toml and garment packages")]
    Folder {
        /// The folder as the user named it.
        folder: String,
        /// The fault.
        reason: String,
    },
}
