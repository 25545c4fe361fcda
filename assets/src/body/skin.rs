//! Skin weights of the mannequin: which bones carry each vertex, and by how much.
//!
//! Shoulders and hips blend by shares laid on the cage and subdivided with it, so that they are as smooth as the
//! surface; along the spine and the limbs the weights are ramps across each joint's plane.

use glam::Vec3;

use super::Region;
use crate::mesh::SkinWeights;
use crate::skeleton::{BONES, Joint, Skeleton, TWIST_BONES};

/// The region of a final vertex.
pub(super) fn region(part: Vec3, position: Vec3) -> Region {
    let left = position.x > 0.0;
    match part {
        p if p.x > 0.5 => [Region::RightArm, Region::LeftArm][usize::from(left)],
        p if p.y > 0.5 => [Region::RightLeg, Region::LeftLeg][usize::from(left)],
        p if p.z > 0.5 => Region::Head,
        _ => Region::Torso,
    }
}

/// A ramp from 0 at `-width` to 1 at `+width`, with level ends.
fn ramp(x: f32, width: f32) -> f32 {
    let t = ((x / width) * 0.5 + 0.5).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// Weights of every bone at one vertex while they are being added up.
type Bones = [f32; BONES];

/// Blends a chain of bones: each ramp hands what is left over to the next bone.
fn chain(weights: &mut Bones, share: f32, bones: &[usize], ramps: &[f32]) {
    let mut left = share;
    for (k, &bone) in bones.iter().enumerate() {
        let on = ramps.get(k).copied().unwrap_or(0.0);
        weights[bone] += left * (1.0 - on);
        left *= on;
    }
}

/// The skinning of one body: its skeleton and its size against a body of 1.7 m.
pub(super) struct Skinning<'a> {
    skeleton: &'a Skeleton,
    size: f32,
}

impl<'a> Skinning<'a> {
    pub(super) fn new(skeleton: &'a Skeleton, stature: f32) -> Self {
        Self { skeleton, size: stature / 1.7 }
    }

    /// Weights of a vertex at `p` with its left and right shares.
    pub(super) fn weights(&self, p: Vec3, left: Vec3, right: Vec3) -> SkinWeights {
        let mut weights = [0.0; BONES];
        // Subdivision's negative lobes are none, but rounding may leave a trace.
        let (left, right) = (left.max(Vec3::ZERO), right.max(Vec3::ZERO));
        self.spine(&mut weights, p, (1.0 - left.element_sum() - right.element_sum()).max(0.0));
        for (shares, mirrored) in [(left, false), (right, true)] {
            self.arm(&mut weights, p, shares.x, mirrored);
            self.leg(&mut weights, p, shares.y, mirrored);
            weights[side(Joint::LeftClavicle, mirrored).index()] += shares.z;
        }
        four_largest(&weights)
    }

    fn spine(&self, weights: &mut Bones, p: Vec3, share: f32) {
        use Joint::*;
        let at = |joint: Joint| p - self.skeleton.at(joint);
        let mm = self.size * 1e-3;
        // The neck's plane leans forwards and spares the shoulders' slope; the head's keeps chin and occiput together.
        let shoulders = 0.5 * (p.x.abs() - 50.0 * mm).max(0.0);
        let ramps = [
            ramp(at(Spine).y, 100.0 * mm),
            ramp(at(Chest).y, 100.0 * mm),
            ramp(at(Neck).dot(Vec3::new(0.0, 0.93, 0.37)) - shoulders, 38.0 * mm),
            ramp(at(Head).dot(Vec3::new(0.0, 0.77, 0.64)), 36.0 * mm),
        ];
        chain(weights, share, &[Pelvis, Spine, Chest, Neck, Head].map(Joint::index), &ramps);
    }

    fn arm(&self, weights: &mut Bones, p: Vec3, share: f32, mirrored: bool) {
        if share <= 0.0 {
            return;
        }
        let joint = |j: Joint| side(j, mirrored);
        let at = |j: Joint| self.skeleton.at(joint(j));
        let (shoulder, elbow, wrist, hand) =
            (at(Joint::LeftShoulder), at(Joint::LeftElbow), at(Joint::LeftWrist), at(Joint::LeftHand));
        let (upper, fore) = (elbow - shoulder, wrist - elbow);
        let (u, f) = (upper.normalize(), fore.normalize());
        let mm = self.size * 1e-3;
        // The thumb, which stands out in front, goes with the wrist and not with the fingers.
        let thumb = 2.0 * ((p - wrist).z - (p - wrist).dot(f) * f.z - 40.0 * mm).max(0.0);
        let ramps = [
            ramp((p - shoulder).dot(u) - 0.5 * upper.length(), 0.32 * upper.length()),
            ramp((p - elbow).dot((u + f).normalize()), 46.0 * mm),
            ramp((p - elbow).dot(f) - 0.5 * fore.length(), 0.36 * fore.length()),
            ramp((p - wrist).dot(f), 28.0 * mm),
            ramp((p - hand).dot(f) - thumb, 22.0 * mm),
        ];
        let [upper_twist, fore_twist] = if mirrored { [2, 3] } else { [0, 1] }.map(|k| TWIST_BONES[k].0);
        let [s, e, w, h] =
            [Joint::LeftShoulder, Joint::LeftElbow, Joint::LeftWrist, Joint::LeftHand].map(|j| joint(j).index());
        chain(weights, share, &[s, upper_twist, e, fore_twist, w, h], &ramps);
    }

    fn leg(&self, weights: &mut Bones, p: Vec3, share: f32, mirrored: bool) {
        if share <= 0.0 {
            return;
        }
        let joint = |j: Joint| side(j, mirrored);
        let at = |j: Joint| self.skeleton.at(joint(j));
        let (hip, knee, ankle, toe) =
            (at(Joint::LeftHip), at(Joint::LeftKnee), at(Joint::LeftAnkle), at(Joint::LeftToe));
        let mm = self.size * 1e-3;
        let across = ((knee - hip).normalize() + (ankle - knee).normalize()).normalize();
        let foot = Vec3::new(0.0, -0.94, 0.34);
        let ramps = [
            ramp((p - knee).dot(across), 60.0 * mm),
            ramp((p - ankle).dot(foot) + 8.0 * mm, 34.0 * mm),
            ramp((p - toe).z, 26.0 * mm),
        ];
        let bones = [Joint::LeftHip, Joint::LeftKnee, Joint::LeftAnkle, Joint::LeftToe].map(|j| joint(j).index());
        chain(weights, share, &bones, &ramps);
    }
}

fn side(joint: Joint, mirrored: bool) -> Joint {
    if mirrored { joint.mirror() } else { joint }
}

/// The four largest weights, made to sum to 1; equal ones in the order of the bones.
fn four_largest(weights: &Bones) -> SkinWeights {
    let mut order: [usize; BONES] = std::array::from_fn(|i| i);
    order.sort_by(|&a, &b| weights[b].total_cmp(&weights[a]));
    let kept = [0, 1, 2, 3].map(|k| weights[order[k]]);
    let sum: f32 = kept.iter().sum();
    let mut out = SkinWeights::default();
    for k in 0..4 {
        if kept[k] > 0.0 {
            out.bones[k] = order[k] as u8;
            out.weights[k] = kept[k] / sum;
        }
    }
    out
}
