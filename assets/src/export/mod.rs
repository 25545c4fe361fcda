//! Exports of bodies and garments for other tools.
//!
//! Reads: a body, the pose it is in, and what it wears. Writes: the bytes of a GLB file.
//! Budget: at the end of a run only, under 50 ms for a dressed body. The same input gives the same bytes.
//! Thread: the caller's.

pub mod glb;
mod parts;
#[cfg(test)]
mod tests;

pub use glb::{DressedBody, WornGarment, glb};
