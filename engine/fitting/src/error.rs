//! Errors of a fitting or a kiosk.

use std::fmt::Display;

/// What stops a fitting or a kiosk. Each text is one sentence: what, where, and the cure.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum FittingError {
    /// Something that this build does not have was asked for.
    #[error("{0}")]
    Usage(String),
    /// A session, a garment, a size, a configuration or a file that cannot be used.
    #[error("{0}")]
    Input(String),
    /// A device, a display, an address, a lock or a thread that the system does not give.
    #[error("{0}")]
    Device(String),
    /// A fault of Toile's own.
    #[error("{0}")]
    Internal(String),
}

impl FittingError {
    /// Bad input, with the message of the error that found it: `.map_err(FittingError::input)?`.
    pub fn input(error: impl Display) -> Self {
        Self::Input(error.to_string())
    }

    /// A fault of Toile's own, in the words of an error that ought not to happen.
    pub fn internal(error: impl Display) -> Self {
        Self::Internal(error.to_string())
    }
}
