//! Torture: states and inputs that no real cloth meets, and whether the engine recovers from them.

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
