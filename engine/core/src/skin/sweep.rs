//! Sweep-based deformation of arms and legs around elbows and knees, over a surface that was skinned otherwise.
//!
//! After Hyun, Yoon, Chang, Seong, Kim and Juettler (2005, "Sweep-based human deformation"): a limb is a section that is swept along a
//! spline through its joints. Every vertex is bound at rest to the section that holds it, at the arc length `s` where
//! `(x - C(s)) . T(s) = 0`; the pose moves the sections, and they carry their vertices: `x' = C'(s) + R'(s) k (x - C(s))`. `C'` is two
//! cubic Hermite segments from the upper bone over the joint to the lower one, `R'` goes from one bone's rotation to the other's and
//! is then laid square to the curve, and `k` scales a section so that the volume between neighbours stays: the control ellipses.
//! Away from the joint sections follow their bones, twist and all, and the sweep fades into the skinned surface.

use glam::{Affine3A, Mat3A, Quat, Vec3, Vec3A};
use toile_base::mesh::SkinWeights;
use toile_base::skeleton::{BONES, Joint, Skeleton, Twist};

use super::posed_mesh::PosedMesh;

/// The limbs that are swept: root, hinge, end.
pub const LIMBS: [[Joint; 3]; 4] = [
    [Joint::LeftShoulder, Joint::LeftElbow, Joint::LeftWrist],
    [Joint::RightShoulder, Joint::RightElbow, Joint::RightWrist],
    [Joint::LeftHip, Joint::LeftKnee, Joint::LeftAnkle],
    [Joint::RightHip, Joint::RightKnee, Joint::RightAnkle],
];

/// Half of the stretch that bends, over the limb's radius at its joint: sections of a limb bent by 120 degrees do not cross.
const BEND: f32 = 1.35;

/// The stretch that is swept over the one that bends: beside it the sweep fades.
const REACH: f32 = 1.6;

/// Most of a bone that bends.
const MOST_OF_BONE: f32 = 0.42;

/// How far the curve cuts the corner: 0 goes through the joint, 1 takes the shortest smooth way.
const CUT: f32 = 0.5;

/// Sections of a limb, one more than stretches between them.
pub const SECTIONS: usize = 33;

/// Least and most that a section is scaled.
const SCALES: [f32; 2] = [0.85, 1.18];

/// A limb as it is swept.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SweptLimb {
    /// Root, hinge and end.
    pub joints: [Joint; 3],
    /// Where they are at rest (m).
    pub rest: [Vec3; 3],
    /// Half of the stretch that bends (m).
    pub bend: f32,
    /// Length of the upper bone (m): the hinge's place along the limb.
    pub hinge: f32,
}

/// A vertex and the section that it is bound to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SweepBinding {
    /// The vertex of the mesh.
    pub vertex: u32,
    /// The limb.
    pub limb: u8,
    /// Section before it.
    section: u8,
    /// Share of the way to the next one.
    pub between: f32,
    /// How much the sweep moves it, 0 to 1; the rest is the skinned surface.
    pub share: f32,
    /// The place along the limb (m).
    pub along: f32,
    /// Rest position (m) and normal.
    rest: [Vec3A; 2],
}

impl SweepBinding {
    /// Places along the limb of the two sections that move the vertex (m).
    pub fn sections(&self, limb: &SweptLimb) -> [f32; 2] {
        [0, 1].map(|k| limb.place_of(usize::from(self.section) + k))
    }
}

/// A skin's swept limbs, bound at load. Running it cannot fail and allocates nothing.
#[derive(Debug, Clone, PartialEq)]
pub struct SweptSkin {
    /// The limbs.
    pub limbs: Vec<SweptLimb>,
    /// The vertices that are swept, in the order of the mesh within their limb.
    pub bindings: Vec<SweepBinding>,
    /// Place, tangent (m a metre of limb) of each section at rest `[limbs]`.
    at_rest: Vec<[[Vec3A; 2]; SECTIONS]>,
}

/// A place of a limb's curve.
#[derive(Debug, Clone, Copy)]
struct CurvePoint {
    place: Vec3A,
    /// Change of place a metre of limb.
    tangent: Vec3A,
    turn: Quat,
}

impl SweptLimb {
    fn new(joints: [Joint; 3], skeleton: &Skeleton, radius: f32) -> Self {
        let rest = joints.map(|j| skeleton.at(j));
        let lengths = [rest[0].distance(rest[1]), rest[1].distance(rest[2])];
        let bend = (BEND * radius).min(MOST_OF_BONE * lengths[0].min(lengths[1])).max(1e-3);
        Self { joints, rest, bend, hinge: lengths[0] }
    }

    /// Length of half of what is swept (m).
    fn reach(&self) -> f32 {
        self.bend * REACH
    }

    /// Rotation of a bone at a share of its length, where its skin twists along it: from its first matrix to that of its last twist bone.
    fn turn(&self, bone: usize, share: f32, palette: &[Affine3A; BONES]) -> Quat {
        let of = |b: usize| Quat::from_mat3a(&palette[b].matrix3);
        let first = of(self.joints[bone].index());
        match Twist::towards(self.joints[bone + 1]) {
            Some(twist) => {
                let last = of(twist.first + twist.count - 1);
                let last = if first.dot(last) < 0.0 { -last } else { last };
                first.lerp(last, share / twist.share(twist.count))
            }
            None => first,
        }
    }

    /// The curve at a place along the limb (m), for a pose.
    fn at(&self, along: f32, palette: &[Affine3A; BONES]) -> CurvePoint {
        let [upper, lower] = [0, 1].map(|k| palette[self.joints[k].index()]);
        let [a, b, c] = self.rest.map(Vec3A::from);
        let (ahead, below) = ((b - a).normalize_or_zero(), (c - b).normalize_or_zero());
        let lengths = [self.hinge, b.distance(c)];
        let by = along - self.hinge;
        let [t1, t2] = [upper.matrix3 * ahead, lower.matrix3 * below];
        if by <= -self.bend {
            let place = upper.transform_point3a(a + ahead * along);
            return CurvePoint { place, tangent: t1, turn: self.turn(0, along / lengths[0], palette) };
        }
        if by >= self.bend {
            let place = lower.transform_point3a(b + below * by);
            return CurvePoint { place, tangent: t2, turn: self.turn(1, by / lengths[1], palette) };
        }
        let d = self.bend;
        let joint = lower.transform_point3a(b);
        let middle = joint + (t2 - t1) * (0.25 * d * CUT);
        let across = (t1 + t2).normalize_or(t1);
        let (from, to, [m0, m1], u) = if by < 0.0 {
            (upper.transform_point3a(b - ahead * d), middle, [t1, across], (by + d) / d)
        } else {
            (middle, lower.transform_point3a(b + below * d), [across, t2], by / d)
        };
        let (place, slope) = hermite(from, to, m0 * d, m1 * d, u);
        let q1 = self.turn(0, 1.0 - d / lengths[0], palette);
        let q2 = self.turn(1, d / lengths[1], palette);
        let q2 = if q1.dot(q2) < 0.0 { -q2 } else { q2 };
        CurvePoint { place, tangent: slope / d, turn: q1.slerp(q2, (by + d) / (2.0 * d)) }
    }

    /// The matrix that moves rest points of a section with it.
    fn section(&self, along: f32, [rest, along_rest]: [Vec3A; 2], palette: &[Affine3A; BONES]) -> Affine3A {
        let now = self.at(along, palette);
        let before = along_rest.normalize_or(Vec3A::Y);
        let turned = now.turn * before;
        let tangent = now.tangent.normalize_or(turned);
        let square = Quat::from_rotation_arc(Vec3::from(turned), Vec3::from(tangent)) * now.turn;
        // As much volume a metre of limb as at rest.
        let scale = (along_rest.length() / now.tangent.length().max(1e-6)).sqrt().clamp(SCALES[0], SCALES[1]);
        let kept = Mat3A::from_cols(before * before.x, before * before.y, before * before.z) * (1.0 - scale);
        let matrix3 = Mat3A::from_quat(square.normalize()) * (Mat3A::from_diagonal(Vec3::splat(scale)) + kept);
        Affine3A { matrix3, translation: now.place - matrix3 * rest }
    }

    fn place_of(&self, section: usize) -> f32 {
        self.hinge + self.reach() * (2.0 * section as f32 / (SECTIONS - 1) as f32 - 1.0)
    }
}

/// Cubic Hermite interpolation at u in 0..1, and its derivative by u.
fn hermite(from: Vec3A, to: Vec3A, m0: Vec3A, m1: Vec3A, u: f32) -> (Vec3A, Vec3A) {
    let (u2, u3) = (u * u, u * u * u);
    let place =
        from * (2.0 * u3 - 3.0 * u2 + 1.0) + m0 * (u3 - 2.0 * u2 + u) + to * (3.0 * u2 - 2.0 * u3) + m1 * (u3 - u2);
    let slope = from * (6.0 * u2 - 6.0 * u)
        + m0 * (3.0 * u2 - 4.0 * u + 1.0)
        + to * (6.0 * u - 6.0 * u2)
        + m1 * (3.0 * u2 - 2.0 * u);
    (place, slope)
}

impl SweptSkin {
    /// Binds the vertices of a skin near elbows and knees to sections of their limbs; lengths in metres, one entry a vertex each.
    ///
    /// # Panics
    /// Where positions, normals and weights are not of one length.
    pub fn new(skeleton: &Skeleton, positions: &[Vec3], normals: &[Vec3], weights: &[SkinWeights]) -> Self {
        assert!(positions.len() == normals.len() && positions.len() == weights.len(), "an entry a vertex");
        let rest = [Affine3A::IDENTITY; BONES];
        let mut skin = Self { limbs: Vec::new(), bindings: Vec::new(), at_rest: Vec::new() };
        for (i, joints) in LIMBS.into_iter().enumerate() {
            let own: Vec<f32> = weights.iter().map(|w| own_weight(w, joints)).collect();
            let limb = SweptLimb::new(joints, skeleton, radius(skeleton, joints, positions, &own));
            let sections = std::array::from_fn(|k| {
                let at = limb.at(limb.place_of(k), &rest);
                [at.place, at.tangent]
            });
            for (v, position) in positions.iter().enumerate().filter(|(v, _)| own[*v] > 0.5) {
                let Some(along) = bound(&limb, Vec3A::from(*position), &rest) else { continue };
                let off = (along - limb.hinge).abs();
                let share = smooth((limb.reach() - off) / (limb.reach() - limb.bend)) * smooth(2.0 * own[v] - 1.0);
                if share > 0.0 {
                    let at = (along - limb.place_of(0)) / (2.0 * limb.reach()) * (SECTIONS - 1) as f32;
                    let section = (at as usize).min(SECTIONS - 2);
                    skin.bindings.push(SweepBinding {
                        vertex: v as u32,
                        limb: i as u8,
                        section: section as u8,
                        between: at - section as f32,
                        share,
                        along,
                        rest: [Vec3A::from(*position), Vec3A::from(normals[v])],
                    });
                }
            }
            skin.limbs.push(limb);
            skin.at_rest.push(sections);
        }
        skin
    }

    /// The matrices of all sections in a pose `[limbs][SECTIONS]`.
    fn sections(&self, palette: &[Affine3A; BONES]) -> [[Affine3A; SECTIONS]; LIMBS.len()] {
        std::array::from_fn(|i| {
            std::array::from_fn(|k| {
                let limb = &self.limbs[i];
                limb.section(limb.place_of(k), self.at_rest[i][k], palette)
            })
        })
    }

    /// Moves the swept vertices of a skin that was posed by the same palette; those of rotations and translations alone are meant.
    pub fn run(&self, palette: &[Affine3A; BONES], posed: &mut PosedMesh) {
        let sections = self.sections(palette);
        let vertices = posed.vertices_mut();
        for b in &self.bindings {
            let of = &sections[usize::from(b.limb)];
            let [m0, m1] = [of[usize::from(b.section)], of[usize::from(b.section) + 1]];
            let place = m0.transform_point3a(b.rest[0]).lerp(m1.transform_point3a(b.rest[0]), b.between);
            let normal = (m0.matrix3 * b.rest[1]).lerp(m1.matrix3 * b.rest[1], b.between);
            let to = &mut vertices[b.vertex as usize];
            let at = Vec3A::from(to.position).lerp(place, b.share);
            let n = Vec3A::from(to.normal).lerp(normal.normalize_or_zero(), b.share);
            to.position = at.to_array();
            to.normal = n.normalize_or_zero().to_array();
        }
    }
}

/// Weight of a vertex on a limb's own bones: those of its root and hinge, their twist bones, and half of its end.
fn own_weight(weights: &SkinWeights, joints: [Joint; 3]) -> f32 {
    let of = |bone: u8| {
        let bone = usize::from(bone);
        let twists = |end: Joint| Twist::towards(end).is_some_and(|t| t.bones().contains(&bone));
        let own = joints.iter().any(|j| j.index() == bone) || twists(joints[1]) || twists(joints[2]);
        f32::from(u8::from(own))
    };
    weights.iter().map(|(bone, w)| w * of(bone)).sum()
}

/// Mean distance of a limb's vertices within a third of a bone's breadth of its hinge from it (m), square to the limb.
fn radius(skeleton: &Skeleton, joints: [Joint; 3], positions: &[Vec3], own: &[f32]) -> f32 {
    let [a, b, c] = joints.map(|j| skeleton.at(j));
    let along = (c - a).normalize_or(Vec3::Y);
    let near = positions.iter().zip(own).filter(|(p, w)| **w > 0.5 && (**p - b).dot(along).abs() < 0.02);
    let (sum, count) = near.fold((0.0, 0.0), |(s, n), (p, _)| (s + (*p - b).reject_from(along).length(), n + 1.0));
    if count > 0.0 { sum / count } else { 0.04 }
}

/// The place along a limb whose section holds a point at rest (m); none outside of what is swept.
fn bound(limb: &SweptLimb, point: Vec3A, rest: &[Affine3A; BONES]) -> Option<f32> {
    const TRIED: usize = 24;
    const NEAR: f32 = 0.2;
    let place = |k: usize| limb.hinge + limb.reach() * (2.0 * k as f32 / TRIED as f32 - 1.0);
    let off = |s: f32| limb.at(s, rest).place.distance_squared(point);
    let first = (0..=TRIED).min_by(|a, b| off(place(*a)).total_cmp(&off(place(*b))))?;
    let mut along = place(first);
    for _ in 0..8 {
        let at = limb.at(along, rest);
        along += (point - at.place).dot(at.tangent) / at.tangent.length_squared().max(1e-9);
    }
    let inside = (along - limb.hinge).abs() < limb.reach() && off(along) < NEAR * NEAR;
    inside.then_some(along)
}

/// 3 x^2 - 2 x^3 of what is held between 0 and 1.
fn smooth(x: f32) -> f32 {
    let x = x.clamp(0.0, 1.0);
    x * x * (3.0 - 2.0 * x)
}
