//! Why a program's figures cannot be had.

use std::path::PathBuf;

use thiserror::Error;

/// Why a program's figures cannot be had.
#[derive(Debug, Error)]
pub enum TurnsError {
    /// This program cannot be found again.
    #[error("this program cannot be started once more: {0}")]
    Own(std::io::Error),
    /// A program that does not start.
    #[error("{} does not start: {cause}; give the path of a built `toile`", program.display())]
    Start {
        /// Its path.
        program: PathBuf,
        /// What the system says.
        cause: std::io::Error,
    },
}
