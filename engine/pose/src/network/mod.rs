//! A network that runs: typed steps, all memory made at load.

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
mod tests;
