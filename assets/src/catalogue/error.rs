//! Why a catalogue or a package cannot be used.

use thiserror::Error;

use crate::file::FileError;

/// What is wrong with a catalogue or a package; each message says what, where, and the cure.
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
        /// What the reader says.
        reason: String,
    },
    /// A file that a package lacks, or holds though it must not.
    #[error("{package}: {file}: {reason}")]
    Content {
        /// The package as the user named it.
        package: String,
        /// The file within it.
        file: String,
        /// What is wrong with it, and the cure.
        reason: String,
    },
    /// A folder that is no catalogue.
    #[error("{folder}: {reason}; give a folder that holds catalogue.toml and garment packages")]
    Folder {
        /// The folder as the user named it.
        folder: String,
        /// What is wrong with it.
        reason: String,
    },
}
