//! Surfaces: triangle meshes that move, and the point of one that is nearest to a particle.
//!
//! Reads: triangles at load; in a step the positions of the mesh and of the particles that ask. Writes: for each asking
//! particle a triangle and the shares of its corners.
//! Budget: 10 ns a particle on lanes of 16, 40 ns where it has to be looked for; no allocation after load.
//! Thread: physics; two workers ask for different particles.

mod clusters;
mod mesh;
mod nearest;
#[cfg(test)]
mod tests;

pub use clusters::{ClusterBoxes, Clusters, FillBoxes, NearestVertex};
pub use mesh::{Feature, NO_TRIANGLE, SurfaceMesh};
pub use nearest::{FindNearest, NearestPoint};
