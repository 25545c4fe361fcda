//! A zone with its weight in judging a size.

use super::offer::EaseRange;
use crate::estimate::Estimate;

/// Weight of a zone that the size is chosen by, of one that it also promises to fit, and of any other.
pub const WEIGHTS: [f32; 3] = [1.0, 0.2, 0.1];

/// A runner-up less probable than this is not named.
pub const WORTH_NAMING: f32 = 0.05;

/// A zone to judge by: its weight, comfortable range, and the body there.
pub struct ScoredZone {
    /// Comfortable ease there (m).
    pub ease: EaseRange,
    /// Its weight among the zones.
    pub weight: f32,
    /// The body there (m).
    pub body: Estimate,
    /// Whether the body there is only guessed, because no surface was seen and no tape taken.
    pub guessed: bool,
}
