//! All integration tests of the crate, linked once, but those that measure their whole process (process.rs).

#[cfg(feature = "window")]
mod face;
mod stall;
mod stock;
