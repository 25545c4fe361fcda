//! All integration tests of the crate, linked once.

mod pictures;
#[cfg(feature = "view")]
mod raster;
