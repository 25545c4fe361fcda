//! Garments: what a shape is before it is baked, and what the cloth steps over afterwards.
//!
//! Reads: nothing; these are types, and the check of a mesh. Writes: [`Shape`] (before baking), [`Garment`] (after).
//! Budget: at load only.
//! Thread: the loading thread makes them, physics borrows them.

pub mod check;
pub mod direction;
pub mod shape;

use glam::Vec3;

pub use check::MeshError;
pub use direction::Direction;
pub use shape::{Face, Part, Shape};

use crate::fabric::Fabric;
use crate::mesh::SkinWeights;

/// A stretch constraint between two particles.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stretch {
    /// First particle.
    pub a: u32,
    /// Second particle.
    pub b: u32,
    /// Length as cut (m).
    pub rest: f32,
    /// Inverse stiffness (m/N).
    pub compliance: f32,
}

/// A bend over three particles in a row.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bend {
    /// The particles in order.
    pub v: [u32; 3],
    /// Inverse stiffness (m/N).
    pub compliance: f32,
}

/// A range of constraints in which neighbours in memory share no particle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Set {
    /// Direction of its fibers.
    pub direction: Direction,
    /// Index of its first constraint.
    pub first: u32,
    /// One past its last constraint.
    pub end: u32,
    /// Fibers in it.
    pub fibers: u32,
}

/// One garment in one size, baked: what the cloth borrows and never changes.
#[derive(Debug, Clone, PartialEq)]
pub struct Garment {
    /// The garment's name.
    pub name: String,
    /// The size's code.
    pub size: String,
    /// The fabric.
    pub fabric: Fabric,
    /// Where each particle starts on the shopper, in the rest pose (m) `[particles]`.
    pub start: Box<[Vec3]>,
    /// Inverse mass (1/kg), 0 where the particle is skinned `[particles]`.
    pub inverse_mass: Box<[f32]>,
    /// The part of the body that each particle can touch `[particles]`.
    pub parts: Box<[Part]>,
    /// Triangles for pictures and normals.
    pub triangles: Box<[[u32; 3]]>,
    /// The particles that are skinned.
    pub fixed: Box<[u32]>,
    /// Their weights, in the order of `fixed`.
    pub fixed_weights: Box<[SkinWeights]>,
    /// Stretch constraints, set after set.
    pub stretch: Box<[Stretch]>,
    /// The sets of `stretch`, in the order in which they are solved.
    pub stretch_sets: Box<[Set]>,
    /// Bend constraints, set after set.
    pub bends: Box<[Bend]>,
    /// The sets of `bends`.
    pub bend_sets: Box<[Set]>,
    /// Warp and weft edges with their rest lengths (m): what strain is measured on.
    pub strain_edges: Box<[([u32; 2], f32)]>,
    /// The edges of weft fibers that close around the body or a limb: what tells how tight a garment sits.
    pub hoop_edges: Box<[([u32; 2], f32)]>,
}

impl Garment {
    /// Number of particles.
    pub fn particles(&self) -> usize {
        self.start.len()
    }
}
