//! The body that a mesh is made for, standing in it: by its own base mesh, or the mannequin with its arms held as the sleeves are.

use glam::{Quat, Vec3};

use super::mesh::ForeignMesh;
use super::report::MadeForReport;
use super::surface::loops;
use crate::body::{Body, BodyError, Measures, Sex};
use crate::mesh::SkinWeights;
use crate::skeleton::{Joint, bone_joint};

/// Arms that are held this much otherwise (rad) are turned; less is within what the search of a cuff errs.
const LEAST_TURN: f32 = 0.05;

/// No sleeve turns the mannequin's arms by more (rad): from half raised to hanging down or stretched out.
const MOST_TURN: f32 = 1.2;

/// A cuff lies at least this far from the shoulder's joint (m): what is nearer is an armhole.
const LEAST_SLEEVE_M: f32 = 0.1;

/// A cuff lies at least this share of the shoulder's breadth beside the middle.
const BESIDE: f32 = 1.1;

/// A body that a mesh is made for, in the mesh's own pose.
#[derive(Debug, Clone, PartialEq)]
pub struct MadeFor {
    /// The body; its arms are held as the mesh's sleeves are.
    pub body: Body,
    /// How it is known, in a few words.
    pub how: String,
}

impl MadeFor {
    /// The mannequin of these measures.
    ///
    /// # Errors
    /// Measures that no body has.
    pub fn mannequin(sex: Sex, measures: &Measures, how: String) -> Result<Self, BodyError> {
        Ok(Self { body: Body::build(sex, measures)?, how })
    }

    /// Turns the mannequin's arms so that they go through the cuffs of a mesh.
    pub fn hold_arms(&mut self, mesh: &ForeignMesh) {
        for side in [1.0, -1.0] {
            if let Some(turn) = self.arm_turn(mesh, side) {
                turn_arm(&mut self.body, turn, side);
            }
        }
    }

    /// By how much the arm of a side (1 is the left) has to turn about its shoulder.
    fn arm_turn(&self, mesh: &ForeignMesh, side: f32) -> Option<Quat> {
        let at = |j: Joint| self.body.skeleton.at(if side > 0.0 { j } else { j.mirror() });
        let (shoulder, wrist) = (at(Joint::LeftShoulder), at(Joint::LeftWrist));
        let middle =
            |ring: Vec<u32>| ring.iter().map(|v| mesh.positions[*v as usize]).sum::<Vec3>() / ring.len() as f32;
        let beside = |p: &Vec3| p.x * side > BESIDE * shoulder.x * side && p.distance(shoulder) > LEAST_SLEEVE_M;
        let cuffs = loops(mesh).into_iter().map(middle).filter(beside).filter(|p| p.y > self.body.levels.crotch);
        let cuff = cuffs.max_by(|a, b| (a.x * side).total_cmp(&(b.x * side)))?;
        let turn = Quat::from_rotation_arc((wrist - shoulder).normalize(), (cuff - shoulder).normalize());
        let angle = turn.to_axis_angle().1;
        (LEAST_TURN..=MOST_TURN).contains(&angle).then_some(turn)
    }

    /// What is reported of it.
    pub fn report(&self) -> MadeForReport {
        let Measures { stature, chest_girth, waist_girth, hip_girth, .. } = self.body.measures;
        let [stature_mm, chest_girth_mm, waist_girth_mm, hip_girth_mm] =
            [stature, chest_girth, waist_girth, hip_girth].map(|m| m * 1e3);
        MadeForReport { how: self.how.clone(), stature_mm, chest_girth_mm, waist_girth_mm, hip_girth_mm }
    }
}

/// How much of a vertex the arm of a side carries (0..1).
pub fn arm_share(weights: &SkinWeights, side: f32) -> f32 {
    let of_arm = |bone: u8| {
        bone_joint(usize::from(bone)).is_some_and(|j| {
            let left = if side > 0.0 { j } else { j.mirror() };
            matches!(left, Joint::LeftShoulder | Joint::LeftElbow | Joint::LeftWrist | Joint::LeftHand)
        })
    };
    weights.iter().filter(|(bone, _)| of_arm(*bone)).map(|(_, w)| w).sum()
}

/// Turns an arm about its shoulder, skin and joints.
fn turn_arm(body: &mut Body, turn: Quat, side: f32) {
    let sided = |j: Joint| if side > 0.0 { j } else { j.mirror() };
    let shoulder = body.skeleton.at(sided(Joint::LeftShoulder));
    let turned = |p: Vec3| shoulder + turn * (p - shoulder);
    for joint in [Joint::LeftElbow, Joint::LeftWrist, Joint::LeftHand].map(sided) {
        body.skeleton.rest[joint.index()] = turned(body.skeleton.at(joint));
    }
    let skin = body.mesh.positions.iter_mut().zip(&mut body.normals).zip(&body.weights);
    for ((p, n), weights) in skin {
        let share = arm_share(weights, side);
        *p = p.lerp(turned(*p), share);
        *n = n.lerp(turn * *n, share).normalize_or_zero();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn average() -> MadeFor {
        MadeFor::mannequin(Sex::Female, &Measures::average(Sex::Female), "the average woman".into()).unwrap()
    }

    /// Rings around both arms, far out, as cuffs that hang lower than the arms at rest.
    #[test]
    fn arms_go_through_the_cuffs() {
        let mut made_for = average();
        let before = made_for.body.clone();
        let shoulder = before.skeleton.at(Joint::LeftShoulder);
        let centre = shoulder + Vec3::new(0.3, -0.45, 0.02);
        let mut mesh = ForeignMesh::default();
        for side in [1.0f32, -1.0] {
            let first = mesh.positions.len() as u32;
            for (row, k) in [0, 1].into_iter().flat_map(|row| (0..12).map(move |k| (row, k))) {
                let (s, c) = (k as f32 / 12.0 * std::f32::consts::TAU).sin_cos();
                let along = Vec3::new(-0.02, 0.03, 0.0) * row as f32 * 4.0;
                let p = centre + along + Vec3::new(0.05 * c, 0.0, 0.05 * s);
                mesh.positions.push(p * Vec3::new(side, 1.0, 1.0));
            }
            for k in 0..12 {
                let j = (k + 1) % 12;
                mesh.faces.push([k, j, j + 12, k + 12].map(|v| v + first));
            }
        }
        made_for.hold_arms(&mesh);
        for side in [1.0f32, -1.0] {
            let at = |j: Joint| made_for.body.skeleton.at(if side > 0.0 { j } else { j.mirror() });
            let arm = (at(Joint::LeftWrist) - at(Joint::LeftShoulder)).normalize();
            let wanted = (centre - shoulder).normalize() * Vec3::new(side, 1.0, 1.0);
            assert!(arm.dot(wanted) > 0.9999, "{arm} {wanted}");
        }
        let length = |b: &Body| b.skeleton.at(Joint::LeftShoulder).distance(b.skeleton.at(Joint::LeftWrist));
        assert!((length(&before) - length(&made_for.body)).abs() < 1e-6);
        let feet = |b: &Body| b.mesh.positions.iter().filter(|p| p.y < 0.3).copied().collect::<Vec<_>>();
        assert_eq!(feet(&before), feet(&made_for.body));
    }
}
