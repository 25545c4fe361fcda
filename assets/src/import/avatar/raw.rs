//! A body as its file has it: what glTF and MakeHuman are read into before it stands in our axes, unit and skeleton.

use glam::{Vec2, Vec3};

use super::error::Flaw;
use super::names::{self, NamedJoints};
use toile_base::limits::{IMPORT_INFLUENCES, MAX_BODY_VERTICES};

/// Furthest that the weights of a vertex may sum from 1: bytes round each of four by up to 1/510.
const SUM_TOLERANCE: f32 = 0.02;

/// Joints that carry a vertex, each with its weight; unused ones have the weight 0.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct RawInfluences(pub [(u16, f32); IMPORT_INFLUENCES]);

/// A joint, or what is above one.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct RawJoint {
    /// Name of the joint in the file.
    pub name: String,
    /// Index of its parent, where it has one.
    pub parent: Option<usize>,
    /// Where it stands in the rest pose, in the file's unit and axes.
    pub at: Vec3,
}

/// A body in its file's unit and axes.
#[derive(Debug, Clone)]
pub(crate) struct RawBody {
    /// Vertex positions, in the file's unit `[vertices]`.
    pub positions: Vec<Vec3>,
    /// Unit normals `[vertices]`, zero where the file has none.
    pub normals: Vec<Vec3>,
    /// Texture coordinates `[vertices]`.
    pub uvs: Vec<Vec2>,
    /// Whether any part of it has texture coordinates.
    pub has_uvs: bool,
    /// Vertex indices, all in range.
    pub triangles: Vec<[u32; 3]>,
    /// Joints and what is above them.
    pub joints: Vec<RawJoint>,
    /// Meaning of the joints' names.
    pub reading: NamedJoints,
    /// Joints and weights of each vertex `[vertices]`.
    pub influences: Vec<RawInfluences>,
    /// Findings and their interpretation, one sentence each.
    pub notes: Vec<String>,
}

impl Default for RawBody {
    fn default() -> Self {
        Self {
            positions: Vec::new(),
            normals: Vec::new(),
            uvs: Vec::new(),
            has_uvs: false,
            triangles: Vec::new(),
            joints: Vec::new(),
            reading: names::read(&[]),
            influences: Vec::new(),
            notes: Vec::new(),
        }
    }
}

impl RawBody {
    /// Checks every number, and makes the weights of each vertex sum to exactly 1.
    pub fn check(&mut self) -> Result<(), Flaw> {
        if !(4..=MAX_BODY_VERTICES).contains(&self.positions.len()) || self.triangles.len() < 4 {
            return Err(Flaw::Vertices { count: self.positions.len() });
        }
        let broken = |points: &[Vec3]| points.iter().position(|p| !p.is_finite());
        if let Some(index) = broken(&self.positions) {
            return Err(Flaw::NotFinite { what: "the position of vertex", index });
        }
        if let Some(index) = broken(&self.normals) {
            return Err(Flaw::NotFinite { what: "the normal of vertex", index });
        }
        if let Some(index) = self.uvs.iter().position(|p| !p.is_finite()) {
            return Err(Flaw::NotFinite { what: "the texture coordinate of vertex", index });
        }
        if let Some(index) = self.joints.iter().position(|j| !j.at.is_finite()) {
            return Err(Flaw::NotFinite { what: "the place of joint", index });
        }
        for (vertex, influences) in self.influences.iter_mut().enumerate() {
            if let Some((_, weight)) = influences.0.iter().find(|(_, w)| !(0.0..=1.0 + SUM_TOLERANCE).contains(w)) {
                return Err(Flaw::Weight { vertex, weight: *weight });
            }
            let sum: f32 = influences.0.iter().map(|(_, w)| w).sum();
            if (sum - 1.0).abs() > SUM_TOLERANCE {
                return Err(Flaw::WeightSum { vertex, sum });
            }
            influences.0.iter_mut().for_each(|(_, w)| *w /= sum);
        }
        Ok(())
    }
}
