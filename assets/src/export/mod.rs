//! Exports of bodies, garments and meshes that move, for other tools.
//!
//! Reads: a body, the pose it is in, and what it wears; a mesh in each frame. Writes: the bytes of GLB and PLY files.
//! Budget: at the end of a run only, under 50 ms for a dressed body. The same input gives the same bytes.
//! Thread: the caller's.

pub mod glb;
mod motion;
mod parts;
mod ply;
#[cfg(test)]
mod tests;

pub use glb::{DressedBody, WornGarment, glb};
pub use motion::motion_glb;
pub use ply::{ply, ply_positions};
