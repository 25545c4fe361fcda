//! Finds crossings: edges of triangle meshes that pass through triangles. The contact of cloth is judged by them.
//!
//! Three garments of 5,000 vertices take at most 50 ms, each also with itself. It never runs inside the frame.
//!
//! Signs are exact (Shewchuk's predicates), a uniform grid over the triangles finds the pairs that are asked for
//! (`grid`), and a pair only touches where any of its five signs is 0 (`predicate`), which is no crossing.
//!
//! ```
//! use glam::DVec3;
//! use toile_fitting::crossings::CrossingTest;
//! let level = [DVec3::ZERO, DVec3::X, DVec3::Z];
//! let upright = [DVec3::new(0.2, -1.0, 0.2), DVec3::new(0.2, 1.0, 0.2), DVec3::new(5.0, 0.0, 0.2)];
//! let test = CrossingTest::new(&[&[[0, 1, 2]], &[[0, 1, 2]]]);
//! let found = test.between(&[&level, &upright]);
//! // Its upright edge passes through the level triangle, and the level one's slanting edge through it.
//! assert_eq!(found.len(), 2);
//! assert_eq!((found[0].edge, found[0].edge_mesh, found[0].triangle_mesh), ([1, 2], 0, 1));
//! assert_eq!((found[1].edge, found[1].edge_mesh, found[1].triangle_mesh), ([0, 1], 1, 0));
//! assert_eq!(test.untested(&[&level, &upright]), 0);
//! ```

mod bounds;
mod grid;
mod mesh;
mod predicate;
mod search;
#[cfg(test)]
mod tests;
mod watch;

pub use mesh::CrossingMesh;
pub use search::{Crossing, CrossingTest};
pub use watch::{CrossingFigures, CrossingWatch, LOOKED_STEPS};
