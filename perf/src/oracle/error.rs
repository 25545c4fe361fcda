//! Why there is no solution.

use thiserror::Error;

use super::solution::Solved;

/// Why there is no solution.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum OracleError {
    /// Arrays that do not fit together.
    #[error("{what} has {got} entries, but {expected} are needed; give one for each particle that it is about")]
    Length {
        /// Name of the array.
        what: &'static str,
        /// Number of its entries.
        got: usize,
        /// Number of entries that are needed.
        expected: usize,
    },
    /// A figure that cannot be used.
    #[error("{what} {at} has a figure that is not finite or out of range; correct it")]
    Unusable {
        /// What it is a figure of.
        what: &'static str,
        /// Index of the first that cannot be used.
        at: usize,
    },
    /// Iterations ran out, or nothing more could be gained.
    #[error(
        "no solution after {} Newton iterations: {:.1e} N are left on a particle; start nearer or allow more iterations",
        .0.report.iterations, .0.report.residual_n
    )]
    NotConverged(
        /// The best that was found; not a solution.
        Box<Solved>,
    ),
}
