//! How a set of fibers is solved.

named! {
    /// What keeps the links of a fiber to their length.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
    #[cfg_attr(feature = "serde", derive(serde::Deserialize), serde(rename_all = "kebab-case"))]
    pub enum Solver {
        /// Link after link: cheap, for what carries little.
        GaussSeidel = "gauss-seidel",
        /// All links of a fiber at once, by the tridiagonal system of their tensions: for what carries weight.
        SemiImplicit = "semi-implicit",
        /// As semi-implicit, without compliance, until no link is longer than it was cut: for waistbands.
        ZeroStretch = "zero-stretch",
    }
}
