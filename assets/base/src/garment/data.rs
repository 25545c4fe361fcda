//! What a garment is beside its constraints.

use glam::Vec3;

use super::look::GarmentAppearance;
use super::part::Part;
use super::tuck::Tuck;
use crate::fabric::Fabric;
use crate::mesh::SkinWeights;

/// Everything about a garment that kernels check for themselves: names, particles, skinning, pictures.
#[derive(Debug, Clone, PartialEq)]
pub struct GarmentData {
    /// The garment's name.
    pub name: String,
    /// Code of the size.
    pub size: String,
    /// Which layer it is worn in, the innermost lowest: it stays outside of what is worn in lower ones.
    pub layer: u8,
    /// What of it is worn inside of a garment of a lower layer, though its own lies outside.
    pub tuck: Option<Tuck>,
    /// The fabric that it is made of.
    pub fabric: Fabric,
    /// The vertex of the shape that each particle was `[particles]`.
    pub source: Box<[u32]>,
    /// Where each particle starts on the shopper, in the rest pose (m) `[particles]`.
    pub start: Box<[Vec3]>,
    /// Inverse mass (1/kg), 0 where the particle is skinned `[particles]`.
    pub inverse_mass: Box<[f32]>,
    /// The part of the body that each particle can touch `[particles]`.
    pub parts: Box<[Part]>,
    /// Triangles for pictures and normals.
    pub triangles: Box<[[u32; 3]]>,
    /// How they show their cloth.
    pub look: GarmentAppearance,
    /// The particles that are skinned.
    pub fixed: Box<[u32]>,
    /// Their weights, in the order of `fixed`.
    pub fixed_weights: Box<[SkinWeights]>,
    /// Substeps of a step of 1/120 s that the longest load-bearing fiber asks for, at the quality `shop`.
    pub substeps: u32,
    /// Warp and weft edges with their rest lengths (m): what strain is measured on.
    pub strain_edges: Box<[([u32; 2], f32)]>,
    /// The edges of weft fibers that close around the body or a limb: by them it is seen how tight a garment sits.
    pub hoop_edges: Box<[([u32; 2], f32)]>,
}
