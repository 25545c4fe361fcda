//! Reasons why a head cannot be made from its sightings.

use thiserror::Error;

/// Photographs or points that no head fits: what, why and the cure.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("{what}: {problem}; {cure}")]
pub struct UnfitFace {
    /// The photograph, the points or the outline.
    what: &'static str,
    /// What is wrong with it.
    problem: String,
    /// What the user can do about it.
    cure: &'static str,
}

impl UnfitFace {
    /// What was given makes no head.
    pub(super) fn new(what: &'static str, problem: impl Into<String>, cure: &'static str) -> Self {
        Self { what, problem: problem.into(), cure }
    }
}
