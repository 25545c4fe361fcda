//! What a caller chooses about the body fit.

/// How a shopper is fitted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FitOptions {
    /// Height of the floor (m), where the camera's pose is known.
    pub ground: Option<f32>,
    /// Whether cloth covers the skin: the fit is then one-sided, because cloth lies outside.
    pub clothed: bool,
    /// Least distance between the surface samples (m): finer is more accurate and slower; 0 takes every face.
    pub spacing: f32,
    /// Gauss-Newton steps a frame.
    pub steps: usize,
    /// How the outline is used.
    pub outline: OutlinePull,
}

/// How the shopper's outline pulls on the body.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum OutlinePull {
    /// What lies outside of it is pulled in: it can only make the body smaller. What ships.
    Inward,
    /// The body's rim is drawn to it from outside and inside, below the size of a pixel, and the surface counts as correlated
    /// over more than a hand's breadth: nearer to the truth on bodies of another family, but not yet calibrated
    /// (`toile bench measure --makehuman`).
    BothWays,
}

impl FitOptions {
    /// For every frame at 30 Hz.
    pub const LIVE: Self =
        Self { ground: Some(0.0), clothed: true, spacing: 0.030, steps: 3, outline: OutlinePull::Inward };

    /// For the second in which a shopper is measured.
    pub const MEASURING: Self =
        Self { ground: Some(0.0), clothed: true, spacing: 0.0, steps: 2, outline: OutlinePull::Inward };
}
