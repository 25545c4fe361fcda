//! All integration tests of the crate, linked once.

mod bodies;
mod own_order;
mod public_api;
mod refusals;
mod same_bits;
