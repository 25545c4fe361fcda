//! Plain data that every crate of Toile shares, and the small mathematics that goes with it.
//!
//! A baked [`garment`] is what the engine steps; a [`body`] and a [`rig`] are what it collides with; [`frame`] is what a
//! sensor sees. The crate has no threads, no files and no unsafe code. With the feature `serde`, fabrics and solvers can be
//! read from files.
//!
//! Units are SI, axes are right-handed with y up. Where a number is not SI, its name says so (`_mm`, `_ns`, `_hz`).

// Modules in the order of the data: each imports only from the groups above its own (tests/tests/layers.rs).
#[macro_use]
mod named;

pub mod cone;
pub mod limits;
pub mod numeric;
pub mod skeleton;
pub mod texture;

pub mod clock;
pub mod fabric;
pub mod mesh;

pub mod body;
pub mod frame;
pub mod garment;

pub mod filter;
pub mod rig;

#[cfg(test)]
#[path = "../../../tests/src/recordings.rs"]
mod recordings;
