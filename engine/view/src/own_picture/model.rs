//! The model of a dressed shopper as it is drawn, made once when they are dressed.

use std::sync::Arc;

use glam::Vec3;
use toile_base::body::{Body, Region};
use toile_base::garment::Garment;
use toile_base::mesh::{SkinWeights, vertex_normals};
use toile_base::skeleton::Skeleton;

use super::garment_colour::ClothColour;
use crate::hidden_skin::CoveringCloth;

/// Skin under a garment counts as so much farther off (m): own clothes are thicker than none, and a bent body stands out of its cones.
const RECESS_M: f32 = 0.04;

/// Side of the cells in which the nearest skin is sought (m).
const CELL_M: f32 = 0.06;

/// The part of the body that a triangle of it shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u8)]
pub enum BodyPart {
    /// Trunk.
    Trunk,
    /// Head and neck.
    Head,
    /// An arm with its hand.
    Arm,
    /// A leg.
    Leg,
}

/// One garment of it.
#[derive(Debug, Clone, PartialEq)]
pub struct OwnGarment {
    /// Corners, counter-clockwise seen from outside `[triangles]`.
    pub triangles: Vec<[u32; 3]>,
    /// The bones that each particle goes with: those of the nearest skin `[particles]`.
    pub weights: Vec<SkinWeights>,
    /// How it looks.
    pub colour: ClothColour,
}

/// A body and its garments.
#[derive(Debug, Clone, PartialEq)]
pub struct OwnPictureModel {
    /// The body's joints at rest.
    pub(super) skeleton: Skeleton,
    /// Its triangles.
    pub(super) triangles: Vec<[u32; 3]>,
    /// The part that each shows `[triangles]`.
    pub(super) parts: Vec<BodyPart>,
    /// The bones of each vertex `[vertices]`.
    pub(super) weights: Vec<SkinWeights>,
    /// How much farther off each counts (m): what lies under a garment `[vertices]`.
    pub(super) recess: Vec<f32>,
    /// Whether a garment covers it `[triangles]`.
    pub(super) is_covered: Vec<bool>,
    /// The garments, inner first.
    pub(super) garments: Vec<OwnGarment>,
}

impl OwnPictureModel {
    /// Of a body and what it wears, inner garments first. Called while a shopper is being dressed: it allocates, and takes 30 ms.
    pub fn of(body: &Body, garments: &[Garment]) -> Arc<Self> {
        let faces = garments.iter().flat_map(|g| g.triangles.iter().map(|t| t.map(|v| g.start[v as usize])));
        let covered = CoveringCloth::new(faces).dressed(&body.mesh.positions, &body.normals);
        let part = |t: &[u32; 3]| match body.regions[t[0] as usize] {
            Region::Torso => BodyPart::Trunk,
            Region::Head => BodyPart::Head,
            Region::LeftArm | Region::RightArm => BodyPart::Arm,
            Region::LeftLeg | Region::RightLeg => BodyPart::Leg,
        };
        let nearest = NearestSkin::new(body);
        let worn = |g: &Garment| {
            let mut normals = vec![Vec3::ZERO; g.particles()];
            vertex_normals(&g.start, &g.triangles, &mut normals);
            OwnGarment {
                triangles: g.triangles.to_vec(),
                weights: g.start.iter().map(|p| body.weights[nearest.of(*p)]).collect(),
                colour: ClothColour::of(g),
            }
        };
        Arc::new(Self {
            skeleton: body.skeleton.clone(),
            triangles: body.mesh.triangles.clone(),
            parts: body.mesh.triangles.iter().map(part).collect(),
            is_covered: body.mesh.triangles.iter().map(|t| covered[t[0] as usize]).collect(),
            weights: body.weights.clone(),
            recess: covered.into_iter().map(|under| if under { RECESS_M } else { 0.0 }).collect(),
            garments: garments.iter().map(worn).collect(),
        })
    }

    /// Vertices of the body.
    pub fn vertices(&self) -> usize {
        self.weights.len()
    }

    /// Whether a snapshot's garments are these.
    pub(super) fn wears(&self, garments: &[Box<[Vec3]>]) -> bool {
        self.garments.len() == garments.len()
            && self.garments.iter().zip(garments).all(|(own, worn)| own.weights.len() == worn.len())
    }
}

/// The vertices of a body in cells, so that the nearest is found soon.
struct NearestSkin<'a> {
    positions: &'a [Vec3],
    cells: std::collections::HashMap<[i32; 3], Vec<u32>>,
}

impl<'a> NearestSkin<'a> {
    fn new(body: &'a Body) -> Self {
        let mut cells: std::collections::HashMap<[i32; 3], Vec<u32>> = std::collections::HashMap::new();
        for (v, p) in (0..).zip(&body.mesh.positions) {
            cells.entry(cell(*p)).or_default().push(v);
        }
        Self { positions: &body.mesh.positions, cells }
    }

    /// The nearest vertex of a place, sought in ever wider cubes of cells.
    fn of(&self, at: Vec3) -> usize {
        let middle = cell(at);
        for reach in 1_i32.. {
            let mut best: Option<(f32, u32)> = None;
            let range = || -reach..=reach;
            for (x, y, z) in range().flat_map(|x| range().flat_map(move |y| range().map(move |z| (x, y, z)))) {
                let key = [middle[0] + x, middle[1] + y, middle[2] + z];
                for v in self.cells.get(&key).into_iter().flatten() {
                    let far = self.positions[*v as usize].distance_squared(at);
                    if best.is_none_or(|(least, _)| far < least) {
                        best = Some((far, *v));
                    }
                }
            }
            // What lies in the cube's corners may be beaten by what lies just outside of a face.
            if let Some((far, v)) = best
                && (far.sqrt() <= CELL_M * reach as f32 || reach > 40)
            {
                return v as usize;
            }
            if reach > 40 {
                break;
            }
        }
        0
    }
}

fn cell(p: Vec3) -> [i32; 3] {
    (p / CELL_M).floor().to_array().map(|x| x as i32)
}
