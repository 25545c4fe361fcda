//! Faults of a file.

/// One thing that is wrong with a network's file, in words that follow its path.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{what}")]
pub struct NetworkFault {
    what: String,
}

impl NetworkFault {
    /// In these words.
    pub fn new(what: impl Into<String>) -> Self {
        Self { what: what.into() }
    }
}
