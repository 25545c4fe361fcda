//! From a session to a dressed frame: the shopper is measured, a body of those measures built, sizes chosen, garments put on.
//!
//! Reads: a session's joints and depth, the wardrobe. Writes: measures with their errors, a body, sizes with verdicts, a frame.
//! Budget: measuring 0.5 s, dressing 1 s.
//! Thread: the caller's.
//!
//! [`measured`] is the one way to measure: every command and the kiosk take it, so that the same session gives the same
//! measures, sizes and verdicts everywhere.

pub mod attire;
pub mod body;
pub mod depth;
pub mod dressed;
pub mod garment_source;
pub mod measured;
pub mod motion;
pub mod offer;
pub mod outfit;
pub mod player;
pub mod recipe;
pub mod session;
pub mod wish;
