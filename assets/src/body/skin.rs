//! Skin weights of the mannequin: which bones carry each vertex, and by how much.
//!
//! Shoulders and hips blend by shares laid on the cage and subdivided with it, so that they are as smooth as the
//! surface; along the spine and the limbs the weights are ramps across each joint's plane.

use glam::Vec3;

use toile_base::mesh::SkinWeights;
use toile_base::skeleton::{BONES, Joint, Skeleton, Twist};

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
        // Subdivision has no negative lobes, but rounding may leave a trace.
        let (left, right) = (left.max(Vec3::ZERO), right.max(Vec3::ZERO));
        self.spine(&mut weights, p, (1.0 - left.element_sum() - right.element_sum()).max(0.0));
        for (shares, mirrored) in [(left, false), (right, true)] {
            self.arm(&mut weights, p, shares.x, mirrored);
            self.leg(&mut weights, p, shares.y, mirrored);
            weights[side(Joint::LeftClavicle, mirrored).index()] += shares.z;
        }
        SkinWeights::strongest((0u8..).zip(weights)).0
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
        let (u, f) = ((elbow - shoulder).normalize(), (wrist - elbow).normalize());
        let mm = self.size * 1e-3;
        // The thumb, which stands out in front, goes with the wrist and not with the fingers.
        let thumb = 2.0 * ((p - wrist).z - (p - wrist).dot(f) * f.z - 40.0 * mm).max(0.0);
        let lower = ramp((p - elbow).dot((u + f).normalize()), ELBOW_MM * mm);
        let ramps = [ramp((p - wrist).dot(f), WRIST_MM * mm), ramp((p - hand).dot(f) - thumb, 22.0 * mm)];
        let [e, w, h] = [Joint::LeftElbow, Joint::LeftWrist, Joint::LeftHand].map(joint);
        self.split(weights, p, share * (1.0 - lower), e, [DELTOID_MM, ELBOW_MM]);
        self.split(weights, p, share * lower * (1.0 - ramps[0]), w, [FOREARM_MM; 2]);
        chain(weights, share * lower * ramps[0], &[w, h].map(Joint::index), &ramps[1..]);
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
        let lower = ramp((p - knee).dot(across), KNEE_MM * mm);
        let ramps = [ramp((p - ankle).dot(foot) + 8.0 * mm, ANKLE_MM * mm), ramp((p - toe).z, 26.0 * mm)];
        let [k, a, t] = [Joint::LeftKnee, Joint::LeftAnkle, Joint::LeftToe].map(joint);
        self.split(weights, p, share * (1.0 - lower), k, [BUTTOCK_MM, KNEE_MM]);
        self.split(weights, p, share * lower * (1.0 - ramps[0]), a, [KNEE_MM, ANKLE_MM]);
        chain(weights, share * lower * ramps[0], &[a, t].map(Joint::index), &ramps[1..]);
    }

    /// Divides a share linearly between the bones of the split limb that ends at a joint: from its root bone to its last
    /// twist bone, one after the other along the limb without so much (mm) at its two ends.
    fn split(&self, weights: &mut Bones, p: Vec3, share: f32, to: Joint, ends_mm: [f32; 2]) {
        let Some(twist) = Twist::towards(to) else { return };
        let (root, end) = (self.skeleton.at(twist.from), self.skeleton.at(to));
        let [before, after] = ends_mm.map(|e| e * self.size * 1e-3);
        let length = root.distance(end);
        let way = ((p - root).dot((end - root) / length) - before) / (length - before - after);
        let place = way.clamp(0.0, 1.0) * twist.count as f32;
        let below = (place as usize).min(twist.count - 1);
        let bone = |k: usize| if k == 0 { twist.from.index() } else { twist.first + k - 1 };
        weights[bone(below + 1)] += share * (place - below as f32);
        weights[bone(below)] += share * (1.0 - (place - below as f32));
    }
}

/// Half the length over which a joint's bend is spread (mm, of a body of 1.7 m); twist is divided beyond it.
const ELBOW_MM: f32 = 46.0;
const WRIST_MM: f32 = 28.0;
const KNEE_MM: f32 = 60.0;
const ANKLE_MM: f32 = 34.0;
/// What a forearm does not twist in at either end: next to nothing, so that it twists as gently as its mesh allows.
const FOREARM_MM: f32 = 8.0;
/// From the shoulder's or the hip's joint on, how far the root bone carries all (mm, of a body of 1.7 m).
const DELTOID_MM: f32 = 75.0;
const BUTTOCK_MM: f32 = 90.0;

fn side(joint: Joint, mirrored: bool) -> Joint {
    if mirrored { joint.mirror() } else { joint }
}
