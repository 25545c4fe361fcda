//! Limits of the mesher and its targets, each with its unit and its reason.

use std::ops::RangeInclusive;

use toile_bake::check::MAX_VERTICES;

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

/// Places of a panel's lattice, those outside of the panel too: a narrow strip across its box has many of them. Twice what a
/// whole pattern may have of particles, 12 MiB.
pub const MAX_PLACES: usize = 2 * MAX_PARTICLES;

/// Points on the outlines of all panels. Whether an outline crosses itself is looked for between all pairs in the worst case;
/// ten times what the largest of our examples has at 5 mm.
pub const MAX_OUTLINE_POINTS: usize = 32_768;

/// Points that may be looked at while a pattern is improved, all attempts and panels together: some seconds at the worst.
/// A pattern of six panels of a thousand points may try eight hundred changes in each, of which a usual one needs fifty.
pub const MAX_IMPROVEMENT: usize = 5_000_000;
