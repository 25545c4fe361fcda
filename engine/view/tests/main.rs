//! All integration tests of the crate, linked once.

mod laws;
#[cfg(feature = "view")]
mod raster;
