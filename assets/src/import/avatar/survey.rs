//! The measuring levels, regions and measures of an imported body, from its joints and the shape of its trunk.
//!
//! Levels are those of our own bodies' landmarks. What shows on a surface is looked for around the place where ours have
//! it: the seat's and the bust's greatest protrusion, the top of the shoulder, the crotch. What would have to be felt
//! under the skin lies between those as it does on ours: natural waist, underbust, acromion, 7th cervical vertebra,
//! kneecap. Girths are convex hulls of horizontal slices without arms, as for our own bodies.

use glam::Vec3;

use super::error::Flaw;
use crate::body::tape;
use toile_base::body::{Levels, Measures, Region, Sex};
use toile_base::mesh::{Mesh, SkinWeights};
use toile_base::skeleton::{BONES, Joint, Skeleton, TWISTS};

/// How far around an acromion its height is looked for (share of the stature).
const ACROMION_NEAR: f32 = 0.015;

/// How far below and above our own bodies' places seat and bust are looked for (share of the way from the crotch to the
/// acromions): 60 mm of a body of 1.7 m.
const AROUND: f32 = 0.1;

/// Readings of an imported body.
pub(super) struct BodySurvey {
    pub regions: Vec<Region>,
    pub levels: Levels,
    pub measures: Measures,
}

/// Reads levels, regions and measures.
pub(super) fn survey(mesh: &Mesh, weights: &[SkinWeights], skeleton: &Skeleton, sex: Sex) -> Result<BodySurvey, Flaw> {
    let ours = crate::body::fitted::proportions(sex);
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
    let shoulder = acromions(mesh, skeleton, ours.acromion);
    let chest_top = shoulder[0].y.min(shoulder[1].y);
    let span = chest_top - crotch;
    let torso = |share: f32| {
        let [low, high] = [share - AROUND, share + AROUND].map(|s| crotch + s * span);
        let inside = move |(p, r): &(&Vec3, &Region)| **r == Region::Torso && (low..high).contains(&p.y);
        mesh.positions.iter().zip(&regions).filter(inside).map(|(p, _)| *p)
    };
    let seat = torso(ours.seat).min_by(|a, b| a.z.total_cmp(&b.z));
    let bust = torso(ours.bust).max_by(|a, b| a.z.total_cmp(&b.z));
    let hip = seat.ok_or(Flaw::Level { level: "seat" })?.y;
    let chest = bust.ok_or(Flaw::Level { level: "bust" })?.y;
    let girth = |y: f32| tape::girth_of(mesh, &regions, y);
    let waist = hip + ours.waist * (chest - hip);
    let way = |from: f32, to: f32, share: f32| from + share * (to - from);
    let both = |left: Joint, right: Joint| 0.5 * (at(left) + at(right));
    let knee = both(Joint::LeftKnee, Joint::RightKnee);
    let levels = Levels {
        neck: way(at(Joint::Neck), at(Joint::Head), ours.cervicale).max(chest_top),
        shoulder: chest_top,
        chest,
        underbust: way(chest, waist, ours.underbust),
        waist,
        hip,
        crotch,
        knee: way(knee, both(Joint::LeftHip, Joint::RightHip), ours.midpatella),
        ankle: both(Joint::LeftAnkle, Joint::RightAnkle),
    };
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
    Ok(BodySurvey { regions, levels, measures })
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

/// The tops of the two shoulders: the highest place over each acromion, which lies `over` its joint's way from the middle.
fn acromions(mesh: &Mesh, skeleton: &Skeleton, over: f32) -> [Vec3; 2] {
    let stature = mesh.positions.iter().map(|p| p.y).fold(0.0, f32::max);
    [Joint::LeftShoulder, Joint::RightShoulder].map(|joint| {
        let centre = skeleton.at(joint);
        let at = centre.with_x(over * centre.x);
        let near = |p: &&Vec3| (**p - at).with_y(0.0).length() < ACROMION_NEAR * stature;
        let top = mesh.positions.iter().filter(near).map(|p| p.y).fold(at.y, f32::max);
        at.with_y(top)
    })
}
