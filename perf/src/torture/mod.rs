//! Torture: states and inputs that no real cloth meets, and whether the engine recovers from them.
//!
//! Reads: the cases and a range of seeds. Writes: a [`TortureReport`]: one [`SeedOutcome`] a case and seed, one
//! [`CaseSummary`] a case. Budget: three minutes for all cases at 100 seeds on two cores; never inside the frame.
//! Thread: two of its own over the seeds; the results stand in the order of the cases and seeds.

mod cases;
mod crossed;
mod elements;
mod error;
mod exact;
mod folded;
mod layer_trial;
mod layered;
mod long_rest;
mod outcome;
mod piece;
mod pieces;
mod poison;
mod ratios;
mod run;
mod start;
mod surround;
mod trial;

pub use cases::{CASES, TortureCase};
pub use error::TortureError;
pub use outcome::{CaseSummary, SeedOutcome, TortureReport};
pub use run::{SEEDS, TortureOptions, run};
