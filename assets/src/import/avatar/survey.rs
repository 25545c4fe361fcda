//! The measuring levels, regions and measures of an imported body, from its joints and the shape of its trunk.
//!
//! Landmarks under the skin cannot be felt on a mesh, so that some levels are conventions: the waist is the narrowest
//! level between hips and bust (the natural waist lies within a few centimetres), the underbust less than half of the
//! way from bust to waist, the acromion a little outwards of the shoulder's joint. Girths are convex hulls of horizontal slices without arms, as for our own bodies.

use glam::Vec3;

use super::error::Flaw;
use crate::body::{Levels, Measures, Region, tape};
use crate::mesh::{Mesh, SkinWeights};
use crate::skeleton::{BONES, Joint, Skeleton, TWISTS};

/// Levels at which the trunk is looked at for its narrowest one.
const SLICES: usize = 64;

/// How far an acromion lies outwards of its joint's centre, and how far around it its height is looked for (share of the
/// stature): on the mannequin, whose shoulders ANSUR II gives, 17.6 mm of 1,628.
const ACROMION_OUT: f32 = 0.0108;
const ACROMION_NEAR: f32 = 0.015;

/// The underbust's share of the way from bust to waist, as on the mannequin.
const UNDERBUST: f32 = 0.45;

/// What is read off an imported body.
pub(super) struct Survey {
    pub regions: Vec<Region>,
    pub levels: Levels,
    pub measures: Measures,
}

/// Reads levels, regions and measures.
pub(super) fn survey(mesh: &Mesh, weights: &[SkinWeights], skeleton: &Skeleton) -> Result<Survey, Flaw> {
    let limbs = bone_regions();
    let regions: Vec<Region> = weights.iter().map(|w| region(w, &limbs)).collect();
    let crotch = crotch(mesh, &regions, skeleton)?;
    // Above the crotch the thighs' skin belongs to the trunk, as the tape goes around both.
    let trunk = |(region, p): (Region, &Vec3)| match region {
        Region::LeftLeg | Region::RightLeg if p.y > crotch => Region::Torso,
        other => other,
    };
    let regions: Vec<Region> = regions.into_iter().zip(&mesh.positions).map(trunk).collect();
    let at = |j: Joint| skeleton.at(j).y;
    let shoulder = acromions(mesh, skeleton);
    let chest_top = shoulder[0].y.min(shoulder[1].y);
    let span = chest_top - crotch;
    let torso = |low: f32, high: f32| {
        let inside = move |(p, r): &(&Vec3, &Region)| **r == Region::Torso && (low..high).contains(&p.y);
        mesh.positions.iter().zip(&regions).filter(inside).map(|(p, _)| *p)
    };
    let seat = torso(crotch, crotch + 0.35 * span).min_by(|a, b| a.z.total_cmp(&b.z));
    let bust = torso(crotch + 0.6 * span, crotch + 0.9 * span).max_by(|a, b| a.z.total_cmp(&b.z));
    let hip = seat.ok_or(Flaw::Level { level: "seat" })?.y;
    let chest = bust.ok_or(Flaw::Level { level: "bust" })?.y;
    let girth = |y: f32| tape::girth_of(mesh, &regions, y);
    let waist = narrowest(hip + 0.25 * (chest - hip), chest - 0.2 * (chest - hip), girth);
    let knee = 0.5 * (at(Joint::LeftKnee) + at(Joint::RightKnee));
    let ankle = 0.5 * (at(Joint::LeftAnkle) + at(Joint::RightAnkle));
    let neck = at(Joint::Neck).max(chest_top);
    let underbust = chest - UNDERBUST * (chest - waist);
    let levels = Levels { neck, shoulder: chest_top, chest, underbust, waist, hip, crotch, knee, ankle };
    let measures = Measures {
        stature: mesh.positions.iter().map(|p| p.y).fold(0.0, f32::max),
        shoulder_breadth: shoulder[0].distance(shoulder[1]),
        chest_girth: girth(chest),
        waist_girth: girth(waist),
        hip_girth: girth(hip),
    };
    for (level, value) in
        [("bust", measures.chest_girth), ("waist", measures.waist_girth), ("seat", measures.hip_girth)]
    {
        if value <= 0.0 {
            return Err(Flaw::Level { level });
        }
    }
    Ok(Survey { regions, levels, measures })
}

/// The part of the body that each bone belongs to.
fn bone_regions() -> [Region; BONES] {
    use Joint::*;
    let mut regions = [Region::Torso; BONES];
    for joint in Joint::ALL {
        regions[joint.index()] = match joint {
            Head => Region::Head,
            LeftShoulder | LeftElbow | LeftWrist | LeftHand => Region::LeftArm,
            RightShoulder | RightElbow | RightWrist | RightHand => Region::RightArm,
            LeftHip | LeftKnee | LeftAnkle | LeftToe => Region::LeftLeg,
            RightHip | RightKnee | RightAnkle | RightToe => Region::RightLeg,
            _ => Region::Torso,
        };
    }
    for twist in &TWISTS {
        let limb = regions[twist.from.index()];
        regions[twist.bones()].fill(limb);
    }
    regions
}

/// The part that has most of a vertex.
fn region(weights: &SkinWeights, of_bone: &[Region; BONES]) -> Region {
    const ALL: [Region; 6] =
        [Region::Torso, Region::Head, Region::LeftArm, Region::RightArm, Region::LeftLeg, Region::RightLeg];
    let share = |region: Region| -> f32 {
        let of = weights.bones.iter().zip(&weights.weights).filter(|(b, _)| of_bone[usize::from(**b)] == region);
        of.map(|(_, w)| w).sum()
    };
    let mut best = Region::Torso;
    for region in ALL {
        if share(region) > share(best) {
            best = region;
        }
    }
    best
}

/// The lowest place between the legs: where the middle plane of the body leaves the trunk above the knees.
fn crotch(mesh: &Mesh, regions: &[Region], skeleton: &Skeleton) -> Result<f32, Flaw> {
    let knee = skeleton.at(Joint::LeftKnee).y.max(skeleton.at(Joint::RightKnee).y);
    let hips = 0.5 * (skeleton.at(Joint::LeftHip).y + skeleton.at(Joint::RightHip).y);
    let of_trunk = |t: usize| {
        let trunk = [Region::Torso, Region::LeftLeg, Region::RightLeg];
        mesh.triangles[t].iter().all(|&v| trunk.contains(&regions[v as usize]))
    };
    let cut = tape::slice(mesh, of_trunk, Vec3::ZERO, Vec3::X);
    let heights = cut.iter().flatten().map(|p| p.y).filter(|y| (knee..hips).contains(y));
    heights.min_by(f32::total_cmp).ok_or(Flaw::Level { level: "crotch" })
}

/// The tops of the two shoulders: the highest place over each acromion.
fn acromions(mesh: &Mesh, skeleton: &Skeleton) -> [Vec3; 2] {
    let stature = mesh.positions.iter().map(|p| p.y).fold(0.0, f32::max);
    [Joint::LeftShoulder, Joint::RightShoulder].map(|joint| {
        let centre = skeleton.at(joint);
        let at = centre + Vec3::X * (ACROMION_OUT * stature).copysign(centre.x);
        let near = |p: &&Vec3| (**p - at).with_y(0.0).length() < ACROMION_NEAR * stature;
        let top = mesh.positions.iter().filter(near).map(|p| p.y).fold(at.y, f32::max);
        at.with_y(top)
    })
}

/// The level at which a girth is least.
fn narrowest(low: f32, high: f32, girth: impl Fn(f32) -> f32) -> f32 {
    let level = |k: usize| low + (high - low) * k as f32 / SLICES as f32;
    let all = (0..=SLICES).map(|k| (level(k), girth(level(k)))).filter(|(_, g)| *g > 0.0);
    all.min_by(|a, b| a.1.total_cmp(&b.1)).map_or(0.5 * (low + high), |(y, _)| y)
}
