//! What the mesher asks for and gives, each figure with its unit and its reason.

use std::ops::RangeInclusive;

use crate::garment::check::MAX_VERTICES;

/// Spacings that panels are meshed at (m): from the finest weave of folds that a frame has time for to the coarsest first
/// step of sewing.
pub const SPACING_M: RangeInclusive<f64> = 0.003..=0.06;

/// Particles of one pattern: what a garment may have.
pub const MAX_PARTICLES: usize = MAX_VERTICES;

/// How near to the outline the lattice comes, in parts of its pitch. With .6 no point of the outline comes into the circle
/// through a whole cell's corners, so that every cell is part of the Delaunay triangulation.
pub const INSET: f64 = 0.6;

/// The smallest angle that the mesh is improved towards (degrees): two more than it must have.
pub const AIM_DEG: f64 = 22.0;

/// The largest turn of a curve between two of its points (rad): 35 degrees.
pub const CHORD_TURN: f64 = 0.61;
