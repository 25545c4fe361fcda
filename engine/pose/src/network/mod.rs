//! A network that runs: typed steps, all memory made at load.
//!
//! Reads: a model's operators and weights; an image. Writes: the outputs that were asked for.
//! Budget: what its multiplications take; nothing is allocated once it is loaded.
//! Thread: whichever has it; the tracker's thread.

mod conv;
mod fast;
mod kernels;
mod op;
mod plan;
mod reference;
mod running;
mod shape;
mod single;

pub use reference::logistic;
pub use running::Network;
pub use shape::Shape;

#[cfg(test)]
mod small_file;
#[cfg(test)]
mod tests;
