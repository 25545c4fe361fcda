//! The tailor: a pattern's panels are meshed, the lattice of the threads first, and sewn into one mesh.
//!
//! Inside of each panel lies a lattice along warp and weft, whose whole cells are quads; the ring between it and the outline
//! is triangulated, and improved where a triangle is too sharp. Both sides of a seam have the same number of points.

mod angles;
mod error;
mod improve;
mod lattice;
pub mod limits;
mod panel_mesh;
mod quads;
mod ring;
mod sampling;
mod sewn;
#[cfg(test)]
mod tests;

pub use error::TailorError;
pub use panel_mesh::{PanelMesh, PanelQuality};
pub use sampling::Boundary;
pub use sewn::{SewnMesh, sew};
