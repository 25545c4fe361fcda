//! Gauss-Seidel of one link: its gain, and its correction under the present tension.

use crate::lanes::{Mask, Numbers};

/// How often a substep solves links.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Passes {
    /// Once. A link that starts from no tension then carries C / ((w_a + w_b) + alpha / dt^2) at rest, too little by what
    /// its own ends give; the denominator's greater part alone gives what its stiffness says, as long as that is within
    /// what one substep carries, and never draws its ends past each other.
    Once,
    /// More often, or from the tension that it has.
    Many,
}

/// The gain of links whose ends weigh `ends` with damping, and their own compliance `own` over the square of the substep.
#[inline(always)]
pub fn gain<L: Numbers>(ends: L, own: L, passes: Passes) -> L {
    let zero = L::splat(0.0);
    let weight = if passes == Passes::Once { ends.max(own) } else { ends + own };
    let moves = zero.lt(ends).and(zero.lt(weight));
    L::splat(1.0).div(weight).select(moves, zero)
}

/// A tension that nothing comes to (N s2).
pub const NO_LEAST: f32 = -1e20;

/// What links do under the tension that they have.
#[derive(Clone, Copy)]
pub struct Slack<L> {
    /// What they give by their compliance (m).
    pub gives: L,
    /// Least growth of the tension (N s2): it may not fall below what they bear when pushed together.
    pub least: L,
}

impl<L: Numbers> Slack<L> {
    /// Of links that start from no tension and push as they pull.
    #[inline(always)]
    pub fn none() -> Self {
        Self { gives: L::splat(0.0), least: L::splat(NO_LEAST) }
    }
}
