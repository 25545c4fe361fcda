//! How a set of fibers is solved.

use serde::Deserialize;

/// What keeps the links of a fiber to their length.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Solver {
    /// Link after link: cheap, for what carries little.
    GaussSeidel,
    /// All links of a fiber at once, by the tridiagonal system of their tensions: for what carries weight.
    SemiImplicit,
    /// As semi-implicit, without compliance, until no link is longer than it was cut: for waistbands.
    ZeroStretch,
}
