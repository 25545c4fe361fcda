//! The evidence: what a part of the engine costs, and how exact it is at that cost.
//!
//! Reads: the engine's kernels, the scene's shopper. Writes: times (median of many runs) and errors against f64.
//! Budget: some seconds a benchmark; never inside the frame.
//! Thread: one, with nothing else running.

pub mod agreement;
pub mod ansur;
pub mod backend;
pub mod crossover;
pub mod depth;
pub mod filters;
pub mod gestures;
pub mod latency;
pub mod measuring;
pub mod oracle;
pub mod pareto;
pub mod people;
pub mod plot;
mod random;
pub mod reliability;
pub mod skinning;
pub mod skirt;
pub mod soak;
pub mod torture;
pub mod validate;
