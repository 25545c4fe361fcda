//! What a sex's mean body hands to the morphs: a surface at rest, and what is tied to it.

use glam::Vec3;

use super::landmarks::Landmarks;
use super::{Region, Sex};
use crate::mesh::SkinWeights;
use crate::skeleton::Skeleton;

/// One sex's body as drawn: closed, symmetric about x = 0, facing +z, soles on y = 0, arms half raised.
#[derive(Debug, Clone)]
pub struct Base {
    /// Whose body it is.
    pub sex: Sex,
    /// Surface points (m) `[vertices]`.
    pub positions: Vec<Vec3>,
    /// Vertex indices, counter-clockwise from outside `[triangles]`.
    pub triangles: Vec<[u32; 3]>,
    /// Part of the body `[vertices]`.
    pub regions: Vec<Region>,
    /// Joint centres (m).
    pub skeleton: Skeleton,
    /// Bones that carry each vertex `[vertices]`.
    pub weights: Vec<SkinWeights>,
    /// Where the tape is laid.
    pub landmarks: Landmarks,
}
