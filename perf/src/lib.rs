//! The evidence: the time of each part of the engine, and its error at that time.

// Modules in the order of the data: each imports only from the groups above its own (tests/tests/layers.rs).
pub mod backend;
pub mod depth;
pub mod distance;
pub mod oracle;
mod random;
pub mod reliability;

pub mod ansur;
pub mod latency;
pub mod skinning;
pub mod skirt;
pub mod soak;
pub mod torture;
pub mod turns;
pub mod validate;
pub mod worn;

pub mod contact;
pub mod crossover;
pub mod drape;
pub mod measuring;
pub mod pareto;
