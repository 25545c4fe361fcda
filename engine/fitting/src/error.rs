//! Why a fitting cannot go on.

use std::fmt::Display;

/// What stops a fitting. Each text is one sentence: what, where, and the cure.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum FittingError {
    /// A session, a garment, a size or a file that cannot be used.
    #[error("{0}")]
    Input(String),
    /// A device, an address or a thread that the system does not give.
    #[error("{0}")]
    Device(String),
    /// A fault of Toile's own.
    #[error("{0}")]
    Internal(String),
}

impl FittingError {
    /// Bad input, in the words of whoever found it: `.map_err(FittingError::input)?`.
    pub fn input(error: impl Display) -> Self {
        Self::Input(error.to_string())
    }

    /// A fault of Toile's own, in the words of an error that ought not to happen.
    pub fn internal(error: impl Display) -> Self {
        Self::Internal(error.to_string())
    }
}
