//! Laid on a shopper: vertices come from the body that the mesh is made for, and out of the shopper's skin.

use glam::Vec3;

use super::made_for::arm_share;
use super::mesh::ForeignMesh;
use super::place::{Below, BodyWay, leg_share};
use crate::body::{Body, Region};
use crate::garment::Part;
use crate::mesh::SkinWeights;
use crate::rig::skin::SkinByHeight;
use crate::skeleton::{BONES, Joint};

/// Cloth starts at least this far from the skin (m): a little more than the contact offset of the thickest fabric.
const START_GAP_M: f32 = 0.005;

/// No vertex is pushed farther than this (m): from deeper inside it would come out on another side.
const FARTHEST_PUSH_M: f32 = 0.08;

/// Rounds in which cloth is pushed out of the skin; in all but the last, neighbours share the way.
const PUSHES: usize = 4;

/// Rounds in which skin weights are averaged with those of the neighbours: a skirt's middle follows both legs.
const SMOOTHINGS: usize = 8;

/// Nearer than this (m) to the skin of an arm and of the trunk, cloth lies in the hollow of an armpit.
const HOLLOW_M: f32 = 0.045;

/// Farther than this (m) from a shoulder's joint is no armpit.
const ARMPIT_M: f32 = 0.22;

/// A mesh on a shopper, all of the same length.
#[derive(Debug, Clone, PartialEq)]
pub struct LaidMesh {
    /// Where each vertex starts (m).
    pub worn: Vec<Vec3>,
    /// How far from the skin that is (m).
    pub clearance: Vec<f32>,
    /// Skin weights, smooth along the cloth.
    pub weights: Vec<SkinWeights>,
    /// The part of the body that it lies on.
    pub parts: Vec<Part>,
}

/// Lays a mesh on a shopper. `weights` are those of the body that it is made for; `below` says of each vertex what its piece
/// hangs around.
pub fn lay(mesh: &ForeignMesh, weights: &[SkinWeights], from: &Body, shopper: &Body, below: &[Below]) -> LaidMesh {
    let way = BodyWay::new(from, shopper);
    let vertices = mesh.positions.iter().zip(weights).zip(below);
    let mut worn: Vec<Vec3> = vertices.map(|((p, w), below)| way.place(*p, w, *below)).collect();
    let neighbours = mesh.neighbours();
    let skin = SkinByHeight::new(shopper);
    push_out(&skin, shopper, &mut worn, weights, &neighbours);
    let clearance = worn.iter().zip(weights).map(|(p, w)| beside(&skin, shopper, *p, w).map_or(1.0, |(_, d)| d)).collect();
    let found = worn.iter().zip(weights).map(|(p, w)| on_shopper(shopper, *p, w)).collect::<Vec<_>>();
    let weights = smooth(&found, &neighbours);
    let parts = worn.iter().zip(&weights).zip(below).map(|((p, w), below)| part(&skin, shopper, *p, w, *below)).collect();
    LaidMesh { worn, clearance, weights, parts }
}

/// The skin weights of places near a body, averaged along the cloth.
pub fn smooth_weights(mesh: &ForeignMesh, body: &Body) -> Vec<SkinWeights> {
    let found = crate::bake::weights::transfer(body, &mesh.positions, |_, _| true);
    smooth(&found, &mesh.neighbours())
}

/// The weights of the shopper's skin near a place, of the limb that the mesh's maker laid the cloth on.
fn on_shopper(shopper: &Body, p: Vec3, made: &SkinWeights) -> SkinWeights {
    let carried = |bone: usize| {
        let one = SkinWeights { bones: [bone as u8; 4], weights: [1.0, 0.0, 0.0, 0.0] };
        [1.0, -1.0].iter().all(|side| arm_share(&one, *side) == 0.0 || arm_share(made, *side) > 0.02)
    };
    crate::bake::weights::transfer(shopper, &[p], |_, bone| carried(bone))[0]
}

fn smooth(weights: &[SkinWeights], neighbours: &[Vec<u32>]) -> Vec<SkinWeights> {
    let mut all: Vec<[f32; BONES]> = weights
        .iter()
        .map(|w| {
            let mut out = [0.0; BONES];
            w.iter().for_each(|(bone, x)| out[usize::from(bone)] += x);
            out
        })
        .collect();
    for _ in 0..SMOOTHINGS {
        let before = all.clone();
        for (own, beside) in all.iter_mut().zip(neighbours).filter(|(_, beside)| !beside.is_empty()) {
            let share = 0.5 / beside.len() as f32;
            own.iter_mut().for_each(|x| *x *= 0.5);
            for v in beside {
                own.iter_mut().zip(&before[*v as usize]).for_each(|(x, y)| *x += share * y);
            }
        }
    }
    all.iter().map(|bones| SkinWeights::strongest((0u8..).zip(bones.iter().copied())).0).collect()
}

/// The vertex of the skin that cloth lies on, and how far it is (m): of an arm where arms carry the cloth, else of the rest.
fn beside(skin: &SkinByHeight<'_>, body: &Body, p: Vec3, weights: &SkinWeights) -> Option<(usize, f32)> {
    let arm = |side: f32, region: Region| (arm_share(weights, side), region);
    let [left, right] = [arm(1.0, Region::LeftArm), arm(-1.0, Region::RightArm)];
    skin.distance_of(p, |v| {
        let region = body.regions[v];
        [left, right].iter().all(|(share, of)| match region == *of {
            true => *share > 0.3,
            false => *share < 0.7,
        })
    })
}

fn push_out(skin: &SkinByHeight<'_>, body: &Body, worn: &mut [Vec3], weights: &[SkinWeights], neighbours: &[Vec<u32>]) {
    for round in 0..PUSHES {
        let push = |(p, w): (&Vec3, &SkinWeights)| match beside(skin, body, *p, w) {
            Some((v, d)) if d < START_GAP_M => body.normals[v] * (START_GAP_M - d).min(FARTHEST_PUSH_M),
            _ => Vec3::ZERO,
        };
        let pushes: Vec<Vec3> = worn.iter().zip(weights).map(push).collect();
        for (v, p) in worn.iter_mut().enumerate() {
            let shared = neighbours[v].iter().map(|u| pushes[*u as usize]).sum::<Vec3>() / neighbours[v].len().max(1) as f32;
            let further = if round + 1 < PUSHES && shared.length_squared() > pushes[v].length_squared() { shared } else { pushes[v] };
            *p += further;
        }
    }
}

/// The part of the body that a vertex lies on.
fn part(skin: &SkinByHeight<'_>, body: &Body, p: Vec3, weights: &SkinWeights, below: Below) -> Part {
    for (side, shoulder, arm, part) in [
        (1.0, Joint::LeftShoulder, Region::LeftArm, Part::LeftArm),
        (-1.0, Joint::RightShoulder, Region::RightArm, Part::RightArm),
    ] {
        let share = arm_share(weights, side);
        let shoulder = body.skeleton.at(shoulder);
        let near = |of: Region| skin.distance_of(p, |v| body.regions[v] == of).is_some_and(|(_, d)| d < HOLLOW_M);
        if p.y < shoulder.y && p.distance(shoulder) < ARMPIT_M && near(arm) && near(Region::Torso) {
            return Part::Hollow;
        }
        if share > 0.5 {
            return part;
        }
    }
    let [left, right] = [Joint::LeftHip, Joint::RightHip].map(|hip| leg_share(weights, hip));
    match below {
        Below::Legs if p.y < body.levels.crotch && left > 0.5 => Part::LeftLeg,
        Below::Legs if p.y < body.levels.crotch && right > 0.5 => Part::RightLeg,
        _ => Part::Trunk,
    }
}
