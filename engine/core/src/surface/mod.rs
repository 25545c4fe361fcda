//! Surfaces: triangle meshes that move, and the point of one that is nearest to a particle.
//!
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
