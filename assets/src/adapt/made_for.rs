//! The body that a mesh is made for, standing in it: by its own base mesh, or the mannequin with its arms and legs held as sleeves and trouser
//! legs are.

use glam::{Quat, Vec3};

use super::mesh::ForeignMesh;
use super::report::MadeForReport;
use super::surface::loops;
use crate::body::BodyError;
use toile_base::body::{Body, Measures, Sex};
use toile_base::mesh::SkinWeights;
use toile_base::skeleton::{Joint, bone_joint};

/// Arms that are held this much otherwise (rad) are turned; less is within what the search of a cuff errs.
const LEAST_TURN: f32 = 0.05;

/// No sleeve turns the mannequin's arms by more (rad): from half raised to hanging down or stretched out.
const MOST_TURN: f32 = 1.2;

/// No trouser leg turns the mannequin's legs by more (rad).
const MOST_SPREAD: f32 = 0.5;

/// The hem of a leg lies at least this far below the crotch (m).
const LEAST_LEG_M: f32 = 0.05;

/// A cuff lies at least this far from the shoulder's joint (m): what is nearer is an armhole.
const LEAST_SLEEVE_M: f32 = 0.1;

/// A cuff lies at least this share of the shoulder's breadth beside the middle.
const BESIDE: f32 = 1.1;

/// A body that a mesh is made for, in the mesh's own pose.
#[derive(Debug, Clone, PartialEq)]
pub struct MadeFor {
    /// The body; its arms and legs are held as the mesh's sleeves and trouser legs are.
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
        Ok(Self { body: crate::body::build(sex, measures)?, how })
    }

    /// Turns the mannequin's arms and legs so that they go through the cuffs and the hems of a mesh.
    pub fn hold_limbs(&mut self, mesh: &ForeignMesh) {
        for side in [1.0, -1.0] {
            if let Some(turn) = self.arm_turn(mesh, side) {
                turn_limb(&mut self.body, &ARM, turn, side);
            }
            if let Some(turn) = self.leg_turn(mesh, side) {
                turn_limb(&mut self.body, &LEG, turn, side);
            }
        }
    }

    /// By how much the leg of a side (1 is the left) has to turn about its hip: where the lowest border below the crotch that lies on
    /// that side alone has its middle, as a trouser leg's hem has and no skirt's.
    fn leg_turn(&self, mesh: &ForeignMesh, side: f32) -> Option<Quat> {
        let at = |j: Joint| self.body.skeleton.at(if side > 0.0 { j } else { j.mirror() });
        let (hip, ankle) = (at(Joint::LeftHip), at(Joint::LeftAnkle));
        let points = |ring: &[u32]| ring.iter().map(|v| mesh.positions[*v as usize]).collect::<Vec<_>>();
        let below = |p: &Vec<Vec3>| p.iter().all(|p| p.y < self.body.levels.crotch - LEAST_LEG_M && p.x * side > 0.0);
        let hems = loops(mesh).iter().map(|ring| points(ring)).filter(below).collect::<Vec<_>>();
        let middle = |p: &Vec<Vec3>| p.iter().sum::<Vec3>() / p.len() as f32;
        let hem = hems.iter().map(middle).min_by(|a, b| a.y.total_cmp(&b.y))?;
        let turn = Quat::from_rotation_arc((ankle - hip).normalize(), (hem - hip).normalize());
        let angle = turn.to_axis_angle().1;
        (LEAST_TURN..=MOST_SPREAD).contains(&angle).then_some(turn)
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

    /// Its report.
    pub fn report(&self) -> MadeForReport {
        let Measures { stature, chest_girth, waist_girth, hip_girth, .. } = self.body.measures;
        let [stature_mm, chest_girth_mm, waist_girth_mm, hip_girth_mm] =
            [stature, chest_girth, waist_girth, hip_girth].map(|m| m * 1e3);
        MadeForReport { how: self.how.clone(), stature_mm, chest_girth_mm, waist_girth_mm, hip_girth_mm }
    }
}

/// A limb of the left side, from the joint that it turns about outwards.
type Limb = [Joint; 4];

const ARM: Limb = [Joint::LeftShoulder, Joint::LeftElbow, Joint::LeftWrist, Joint::LeftHand];
const LEG: Limb = [Joint::LeftHip, Joint::LeftKnee, Joint::LeftAnkle, Joint::LeftToe];

/// How much of a vertex the arm of a side carries (0..1).
pub fn arm_share(weights: &SkinWeights, side: f32) -> f32 {
    limb_share(weights, &ARM, side)
}

fn limb_share(weights: &SkinWeights, limb: &Limb, side: f32) -> f32 {
    let of_limb = |bone: u8| {
        bone_joint(usize::from(bone)).is_some_and(|j| limb.contains(&if side > 0.0 { j } else { j.mirror() }))
    };
    weights.iter().filter(|(bone, _)| of_limb(*bone)).map(|(_, w)| w).sum()
}

/// Turns a limb about its first joint, skin and joints.
fn turn_limb(body: &mut Body, limb: &Limb, turn: Quat, side: f32) {
    let sided = |j: Joint| if side > 0.0 { j } else { j.mirror() };
    let root = body.skeleton.at(sided(limb[0]));
    let turned = |p: Vec3| root + turn * (p - root);
    for joint in limb[1..].iter().map(|j| sided(*j)) {
        body.skeleton.rest[joint.index()] = turned(body.skeleton.at(joint));
    }
    let skin = body.mesh.positions.iter_mut().zip(&mut body.normals).zip(&body.weights);
    for ((p, n), weights) in skin {
        let share = limb_share(weights, limb, side);
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
        made_for.hold_limbs(&mesh);
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

    /// Rings around both legs, wider apart than the mannequin's, as the hems of trousers; and a skirt's around both.
    #[test]
    fn legs_go_through_the_hems_of_trousers_and_not_of_skirts() {
        let ring = |mesh: &mut ForeignMesh, centre: Vec3, radius: f32| {
            let first = mesh.positions.len() as u32;
            for (row, k) in [0, 1].into_iter().flat_map(|row| (0..12).map(move |k| (row, k))) {
                let (s, c) = (k as f32 / 12.0 * std::f32::consts::TAU).sin_cos();
                mesh.positions.push(centre + Vec3::new(radius * c, 0.05 * row as f32, radius * s));
            }
            for k in 0..12 {
                let j = (k + 1) % 12;
                mesh.faces.push([k, j, j + 12, k + 12].map(|v| v + first));
            }
        };
        let mut made_for = average();
        let before = made_for.body.clone();
        let ankle = before.skeleton.at(Joint::LeftAnkle);
        let mut trousers = ForeignMesh::default();
        for side in [1.0, -1.0] {
            ring(&mut trousers, Vec3::new((ankle.x + 0.12) * side, 0.1, ankle.z), 0.09);
        }
        made_for.hold_limbs(&trousers);
        for side in [1.0f32, -1.0] {
            let at = |j: Joint| made_for.body.skeleton.at(if side > 0.0 { j } else { j.mirror() });
            let hip = at(Joint::LeftHip);
            let down = (at(Joint::LeftAnkle) - hip).normalize();
            // The lower border of each ring.
            let wanted = (Vec3::new((ankle.x + 0.12) * side, 0.1, ankle.z) - hip).normalize();
            assert!(down.dot(wanted) > 0.9999, "{down} {wanted}");
        }
        let mut skirted = average();
        let mut skirt = ForeignMesh::default();
        ring(&mut skirt, Vec3::new(0.0, 0.4, 0.0), 0.3);
        skirted.hold_limbs(&skirt);
        assert_eq!(skirted.body, before);
    }
}
