//! Signed distance to a closed triangle mesh, by which the contact of cloth with the skin is judged.
//! It shares no code with the engine.
//!
//! The nearest triangle is found in a tree of boxes, without any limit to the distance. The sign is that of the offset along the
//! normal of the nearest face, edge or corner, where the normal of an edge is the sum of its faces' and that of a corner the sum
//! weighed by their angles: with these the sign is exact for a closed mesh (Baerentzen and Aanaes 2005, "Signed distance
//! computation using the angle weighted pseudonormal"). Where a mesh passes through itself, the nearest of its surfaces
//! decides.
//!
//! ```
//! use glam::DVec3;
//! use toile_perf::distance::DistanceMesh;
//! let corners = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
//! let mesh = DistanceMesh::new(&corners, &[[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]);
//! assert!((mesh.signed(DVec3::new(0.1, 0.3, 0.2)) + 0.1).abs() < 1e-12);
//! assert!((mesh.signed(DVec3::NEG_ONE) - 3f64.sqrt()).abs() < 1e-12);
//! ```

mod closest;
mod mesh;
#[cfg(test)]
mod tests;
mod tree;

pub use mesh::DistanceMesh;
