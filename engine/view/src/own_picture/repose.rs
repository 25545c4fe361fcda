//! From the moment of a snapshot to that of a picture: each stretch of the body goes from where the snapshot has its two joints to where
//! they were seen in the picture, and skin and cloth go with it.
//!
//! A point x beside the limb from a to b goes to a' + M (x - a), with M the shortest turn of the limb's direction d to its new one, after
//! the limb's length was made that of the joints that were seen: M = R (1 + (k - 1) d d^T), k = |b' - a'| / |b - a|. Hips and shoulders
//! each take a frame of three joints, and what lies between them a mean of both.

use glam::{Affine3A, Mat3A, Quat, Vec3, Vec3A};
use toile_base::frame::Joints;
use toile_base::mesh::SkinWeights;
use toile_base::skeleton::{BONES, JOINTS, Joint, TWISTS};

/// Accepted ratio of a limb's seen length to the body's; beyond it the joints belong to another person, or to none.
pub const LENGTHS: std::ops::RangeInclusive<f32> = 0.72..=1.35;

/// Ratios by which limbs are drawn longer or shorter at most: the rest is the sensor's error, and no body is stretched for it.
const DRAWN_LENGTHS: std::ops::RangeInclusive<f32> = 0.9..=1.12;

/// Shortest limb whose direction is one (m).
const SHORTEST_M: f32 = 0.02;

/// Joints that begin a limb, and where it ends.
const LIMBS: [(Joint, Joint); 13] = {
    use Joint::*;
    [
        (LeftShoulder, LeftElbow),
        (LeftElbow, LeftWrist),
        (LeftWrist, LeftHand),
        (LeftHip, LeftKnee),
        (LeftKnee, LeftAnkle),
        (LeftAnkle, LeftToe),
        (RightShoulder, RightElbow),
        (RightElbow, RightWrist),
        (RightWrist, RightHand),
        (RightHip, RightKnee),
        (RightKnee, RightAnkle),
        (RightAnkle, RightToe),
        (Neck, Head),
    ]
};

/// Ends of limbs that are too short for their length to say whose they are.
const SHORT: [Joint; 4] = [Joint::LeftHand, Joint::RightHand, Joint::LeftToe, Joint::RightToe];

/// Joints of the trunk, and how far each goes with the shoulders rather than with the hips.
const TRUNK: [(Joint, f32); 6] = {
    use Joint::*;
    [(Pelvis, 0.0), (Spine, 0.35), (Chest, 0.8), (Neck, 1.0), (LeftClavicle, 1.0), (RightClavicle, 1.0)]
};

/// Transform of each bone.
pub type BoneMoves = [Affine3A; BONES];

/// Change from a snapshot's joints to those of a picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Repose {
    /// Transform of each bone.
    pub moves: BoneMoves,
    /// Least and greatest length of a limb against the body's.
    pub lengths: [f32; 2],
    /// How far the middle of the hips goes (m).
    pub shift_m: f32,
}

impl Repose {
    /// From joints of the snapshot (m) to those that were seen; none where neither hip or neither shoulder was. From the side the
    /// body hides one of each: that one is where the snapshot has it against the other.
    pub fn new(from: &[Vec3; JOINTS], seen: &Joints) -> Option<Self> {
        use Joint::{LeftHip, LeftShoulder, RightHip, RightShoulder};
        let own = |joint: Joint| from[joint.index()];
        let to = |joint: Joint| seen.believed(joint);
        let (hips, shoulders) = ([LeftHip, RightHip], [LeftShoulder, RightShoulder]);
        let pair = |[left, right]: [Joint; 2]| match [to(left), to(right)] {
            [Some(a), Some(b)] => Some([a, b]),
            [Some(a), None] => Some([a, a + own(right) - own(left)]),
            [None, Some(b)] => Some([b + own(left) - own(right), b]),
            [None, None] => None,
        };
        let (seen_hips, seen_shoulders) = (pair(hips)?, pair(shoulders)?);
        let trunk = Trunk { hips: hips.map(own), shoulders: shoulders.map(own) };
        let seen_trunk = Trunk { hips: seen_hips, shoulders: seen_shoulders };
        let (below, above) = (
            seen_trunk.at_hips()? * trunk.at_hips()?.inverse(),
            seen_trunk.at_shoulders()? * trunk.at_shoulders()?.inverse(),
        );
        let mut lengths = [seen_trunk.height() / trunk.height().max(SHORTEST_M); 2];
        let mut joints = [Affine3A::IDENTITY; JOINTS];
        for (joint, share) in TRUNK {
            joints[joint.index()] = between(&below, &above, share);
        }
        for (a, b) in LIMBS {
            let [i, j] = [a, b].map(Joint::index);
            let parent = a.parent().map_or(below, |p| joints[p.index()]);
            let end = own(b);
            // What was not seen goes along with what it hangs from.
            let begin = to(a).unwrap_or_else(|| parent.transform_point3(own(a)));
            let (way, seen_way) = (end - own(a), to(b).map(|b| b - begin));
            joints[i] = match seen_way.filter(|w| w.length().min(way.length()) > SHORTEST_M) {
                Some(seen_way) => {
                    let ratio = seen_way.length() / way.length();
                    // Hands, feet and the head are short, and say little.
                    if b != Joint::Head && !SHORT.contains(&b) {
                        lengths = [lengths[0].min(ratio), lengths[1].max(ratio)];
                    }
                    limb(own(a), begin, way, seen_way, ratio.clamp(*DRAWN_LENGTHS.start(), *DRAWN_LENGTHS.end()))
                }
                None => Affine3A {
                    translation: (begin - Vec3::from(parent.matrix3 * Vec3A::from(own(a)))).into(),
                    ..parent
                },
            };
            joints[j] = joints[i];
        }
        let mut moves = [Affine3A::IDENTITY; BONES];
        moves[..JOINTS].copy_from_slice(&joints);
        for twist in &TWISTS {
            twist.bones().for_each(|bone| moves[bone] = joints[twist.from.index()]);
        }
        let shift_m = trunk.middle().distance(seen_trunk.middle());
        moves.iter().all(|m| m.is_finite()).then_some(Self { moves, lengths, shift_m })
    }

    /// Moves points (m) and their unit normals, each by its bones.
    pub fn apply(&self, weights: &[SkinWeights], points: &mut [Vec3], normals: &mut [Vec3]) {
        for ((weights, point), normal) in weights.iter().zip(points).zip(normals) {
            let (mut at, mut out) = (Vec3A::ZERO, Vec3A::ZERO);
            let (p, n) = (Vec3A::from(*point), Vec3A::from(*normal));
            for (bone, weight) in weights.iter() {
                let motion = &self.moves[usize::from(bone)];
                at += motion.transform_point3a(p) * weight;
                out += (motion.matrix3 * n) * weight;
            }
            (*point, *normal) = (at.into(), Vec3::from(out).normalize_or(*normal));
        }
    }
}

/// A limb's way from a to b becomes one that begins at `begin`.
fn limb(a: Vec3, begin: Vec3, way: Vec3, seen_way: Vec3, ratio: f32) -> Affine3A {
    let along = Vec3A::from(way.normalize_or_zero());
    let turn = Quat::from_rotation_arc(along.into(), seen_way.normalize_or(way));
    let outer = Mat3A::from_cols(along * along.x, along * along.y, along * along.z);
    let matrix3 = Mat3A::from_quat(turn) * (Mat3A::IDENTITY + outer * (ratio - 1.0));
    Affine3A { matrix3, translation: Vec3A::from(begin) - matrix3 * Vec3A::from(a) }
}

/// A share of the way from one motion to another.
fn between(from: &Affine3A, to: &Affine3A, share: f32) -> Affine3A {
    let turn = Quat::from_mat3a(&from.matrix3).slerp(Quat::from_mat3a(&to.matrix3), share);
    Affine3A { matrix3: Mat3A::from_quat(turn), translation: from.translation.lerp(to.translation, share) }
}

/// Hips and shoulders, left and right.
struct Trunk {
    hips: [Vec3; 2],
    shoulders: [Vec3; 2],
}

impl Trunk {
    fn middle(&self) -> Vec3 {
        (self.hips[0] + self.hips[1]) * 0.5
    }

    fn top(&self) -> Vec3 {
        (self.shoulders[0] + self.shoulders[1]) * 0.5
    }

    fn height(&self) -> f32 {
        self.top().distance(self.middle())
    }

    fn at_hips(&self) -> Option<Affine3A> {
        self.frame(self.middle(), self.hips[0] - self.hips[1])
    }

    fn at_shoulders(&self) -> Option<Affine3A> {
        self.frame(self.top(), self.shoulders[0] - self.shoulders[1])
    }

    /// Axes at a place: up the trunk, and to the left as far as that is square to it.
    fn frame(&self, at: Vec3, left: Vec3) -> Option<Affine3A> {
        let up = (self.top() - self.middle()).try_normalize()?;
        let left = (left - up * left.dot(up)).try_normalize()?;
        let matrix3 = Mat3A::from_cols(left.into(), up.into(), left.cross(up).into());
        Some(Affine3A { matrix3, translation: at.into() })
    }
}
