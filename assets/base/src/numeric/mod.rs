//! Small numerical tools that every crate shares, one of each: order statistics, random numbers, a hash, a dense solve,
//! sines with the same bits on every platform.

pub mod hash;
pub mod linear;
#[expect(clippy::approx_constant, reason = "constants in two parts: the first is not the nearest number to the whole")]
pub mod portable;
pub mod random;
pub mod statistics;
