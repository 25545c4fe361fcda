//! Why a kiosk cannot go on.

use std::fmt::Display;

use toile_fitting::FittingError;

/// What stops a kiosk. Each text is one sentence: what, where, and the cure.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum KioskError {
    /// Something that this build does not have was asked for.
    #[error("{0}")]
    Usage(String),
    /// A configuration, a session, a garment or a size that cannot be used.
    #[error("{0}")]
    Input(String),
    /// A display, an adapter, a port or a lock that is not to be had.
    #[error("{0}")]
    Device(String),
    /// A fault of Toile's own.
    #[error("{0}")]
    Internal(String),
}

impl KioskError {
    /// Bad input, in the words of whoever found it: `.map_err(KioskError::input)?`.
    pub fn input(error: impl Display) -> Self {
        Self::Input(error.to_string())
    }

    /// A fault of Toile's own, in the words of an error that ought not to happen.
    pub fn internal(error: impl Display) -> Self {
        Self::Internal(error.to_string())
    }
}

impl From<FittingError> for KioskError {
    fn from(error: FittingError) -> Self {
        match error {
            FittingError::Input(text) => Self::Input(text),
            FittingError::Device(text) => Self::Device(text),
            FittingError::Internal(text) => Self::Internal(text),
        }
    }
}
