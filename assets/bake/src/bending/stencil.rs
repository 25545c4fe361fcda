//! A stencil: one place where the cloth is bent.

use crate::fibers::Direction;

/// One place where the cloth is bent: energy k/2 |sum c_i x_i|^2.
#[derive(Debug, Clone, PartialEq)]
pub struct Stencil {
    /// The particles, three or more; the vertex that it belongs to comes first. Stencils of a whole ring follow each other
    /// and name the same particles.
    pub v: Vec<u32>,
    /// Their weights (1/m2). They sum to zero.
    pub c: Vec<f32>,
    /// Rigidity times the area that it stands for (N m3): the sum is a curvature (1/m).
    pub k: f32,
    /// The direction whose curvature it measures.
    pub direction: Direction,
    /// How much of that curvature its sum is (1): less beside a clamp, where only the half before it bends.
    pub bends: f32,
}
