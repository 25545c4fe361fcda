//! From the body that a mesh is made for to a shopper's: where each vertex starts on them. Nothing is stretched to fit here; the
//! lengths that cloth wants stay those of the mesh as made.
//!
//! Trunk and legs are followed by their levels and the middles of their sections, arms by their bones; a vertex goes as the
//! skin nearest to it does, and skins blend as their weights do.

use glam::{Quat, Vec2, Vec3};

use super::made_for::arm_share;
use crate::body::tape;
use toile_base::body::{Body, Levels, Region};
use toile_base::mesh::SkinWeights;
use toile_base::skeleton::{Joint, bone_joint};

/// Heights at which the middles of sections are known.
const HEIGHTS: usize = 96;

/// Lowest section of a leg (m): below it are feet.
const ANKLE_M: f32 = 0.1;

/// Below the crotch, trousers go over from following the trunk to following each leg within this height (m).
const LEG_FROM_M: f32 = 0.12;

/// Sections of a leg are known from this far below the crotch on (m): above it they are cut off by the trunk.
const LEG_SECTION_M: f32 = 0.03;

/// The way from one body to another.
pub struct BodyWay {
    levels: [Vec<f32>; 2],
    trunk: [Middles; 2],
    legs: [[Middles; 2]; 2],
    crotch: f32,
    /// How many times broader a garment becomes at each level; 1 leaves it as it is made.
    growth: Vec<f32>,
    arms: [[ArmBone; 3]; 2],
    /// How many times farther out the shoulders of the second body are, between which heights of the first.
    shoulders: (f32, [f32; 2]),
}

/// What a piece of cloth hangs around below the crotch.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Below {
    /// Each leg by itself, as trousers do.
    Legs,
    /// Both legs together, as a skirt does.
    Skirt,
}

impl BodyWay {
    /// From a body in any pose of its arms to another.
    pub fn new(from: &Body, to: &Body) -> Self {
        let bodies = [from, to];
        let x = |b: &Body| b.skeleton.at(Joint::LeftShoulder).x - b.skeleton.at(Joint::RightShoulder).x;
        let legs = [[Region::LeftLeg], [Region::RightLeg]];
        let mut way = Self {
            levels: bodies.map(|b| heights(&b.levels, b.measures.stature)),
            trunk: bodies.map(|b| Middles::new(b, &[Region::Torso, Region::LeftLeg, Region::RightLeg], b.levels.neck)),
            legs: legs.map(|leg| bodies.map(|b| Middles::new(b, &leg, b.levels.crotch - LEG_SECTION_M))),
            crotch: from.levels.crotch,
            growth: vec![1.0; heights(&from.levels, from.measures.stature).len()],
            arms: [1.0, -1.0].map(|side| ArmBone::of(from, to, side, None)),
            shoulders: (x(to) / x(from), [from.levels.chest, from.levels.shoulder]),
        };
        // Where rigs have their shoulders differs by centimetres: an upper arm begins where the trunk takes the first rig's, so
        // that nothing is torn between trunk and arm.
        for (k, side) in [1.0, -1.0].into_iter().enumerate() {
            let shoulder = from.skeleton.at(if side > 0.0 { Joint::LeftShoulder } else { Joint::RightShoulder });
            way.arms[k] = ArmBone::of(from, to, side, Some(way.trunk(shoulder)));
        }
        way
    }

    /// The same for a garment that becomes so many times broader at chest, waist and hip: what grading does to a cut.
    pub fn growing(from: &Body, to: &Body, [chest, waist, hip]: [f32; 3]) -> Self {
        // In the order of `heights`: what lies below the hip grows as the hip does, what lies above the chest as the chest does.
        let growth = vec![hip, hip, hip, hip, hip, waist, 0.5 * (waist + chest), chest, chest, chest, chest];
        Self { growth, ..Self::new(from, to) }
    }

    /// Where a place on the first body is on the second; `weights` are those of the skin beneath it.
    pub fn place(&self, p: Vec3, weights: &SkinWeights, below: Below) -> Vec3 {
        let arms: f32 = [1.0, -1.0].map(|side| arm_share(weights, side)).iter().sum();
        let legs = match below {
            Below::Legs => ((self.crotch - p.y) / LEG_FROM_M).clamp(0.0, 1.0) * (1.0 - arms),
            Below::Skirt => 0.0,
        };
        let mut sum = self.trunk(p) * (1.0 - arms - legs).max(0.0);
        if legs > 0.0 {
            let left = leg_share(weights, Joint::LeftHip) >= leg_share(weights, Joint::RightHip);
            sum += self.leg(p, usize::from(!left)) * legs;
        }
        for side in 0..2 {
            for (bone, w) in weights.iter() {
                if let Some(k) = arm_segment(bone, side) {
                    sum += self.arms[side][k].place(p) * w;
                }
            }
        }
        sum
    }

    fn height(&self, y: f32) -> f32 {
        let [from, to] = &self.levels;
        let k = from.partition_point(|l| *l <= y).clamp(1, from.len() - 1);
        to[k - 1] + (y - from[k - 1]) * (to[k] - to[k - 1]) / (from[k] - from[k - 1])
    }

    /// How many times broader a garment becomes at a height of the first body.
    fn broader(&self, y: f32) -> f32 {
        let from = &self.levels[0];
        let k = from.partition_point(|l| *l <= y).clamp(1, from.len() - 1);
        let way = ((y - from[k - 1]) / (from[k] - from[k - 1])).clamp(0.0, 1.0);
        self.growth[k - 1] + way * (self.growth[k] - self.growth[k - 1])
    }

    fn trunk(&self, p: Vec3) -> Vec3 {
        let y = self.height(p.y);
        let broader = self.broader(p.y);
        let (a, b) = (self.trunk[0].at(p.y), self.trunk[1].at(y));
        let (wider, [low, high]) = self.shoulders;
        let x = 1.0 + (wider - 1.0) * ((p.y - low) / (high - low)).clamp(0.0, 1.0);
        Vec3::new(b.x + (p.x - a.x) * x * broader, y, b.y + (p.z - a.y) * broader)
    }

    fn leg(&self, p: Vec3, side: usize) -> Vec3 {
        let y = self.height(p.y);
        let (a, b) = (self.legs[side][0].at(p.y), self.legs[side][1].at(y));
        let broader = self.broader(p.y);
        Vec3::new(b.x + (p.x - a.x) * broader, y, b.y + (p.z - a.y) * broader)
    }
}

/// How much of a vertex the leg of a hip carries (0..1).
pub fn leg_share(weights: &SkinWeights, hip: Joint) -> f32 {
    let of_leg = |bone: u8| {
        bone_joint(usize::from(bone)).is_some_and(|j| {
            let left = if hip == Joint::LeftHip { j } else { j.mirror() };
            matches!(left, Joint::LeftHip | Joint::LeftKnee | Joint::LeftAnkle | Joint::LeftToe)
        })
    };
    weights.iter().filter(|(bone, _)| of_leg(*bone)).map(|(_, w)| w).sum()
}

/// Levels from the floor to the crown, rising.
fn heights(levels: &Levels, stature: f32) -> Vec<f32> {
    let Levels { neck, shoulder, chest, underbust, waist, hip, crotch, knee, ankle } = *levels;
    let mut all = vec![0.0, ankle, knee, crotch, hip, waist, underbust, chest, shoulder, neck, stature];
    // A body by others may have levels that touch.
    for k in 1..all.len() {
        all[k] = all[k].max(all[k - 1] + 1e-3);
    }
    all
}

/// The middle of a body's section (x and z, m) by its height.
struct Middles {
    top: f32,
    middles: Vec<Vec2>,
}

impl Middles {
    fn new(body: &Body, regions: &[Region], top: f32) -> Self {
        let of = |v: &u32| regions.contains(&body.regions[*v as usize]);
        let keep = |t: usize| body.mesh.triangles[t].iter().all(of);
        let middle = |k: usize| {
            let y = (top * k as f32 / (HEIGHTS - 1) as f32).max(ANKLE_M);
            let cut = tape::slice(&body.mesh, keep, Vec3::Y * y, Vec3::Y);
            let start = [Vec2::INFINITY, Vec2::NEG_INFINITY];
            let points = cut.iter().flatten().map(|p| Vec2::new(p.x, p.z));
            let [low, high] = points.fold(start, |[low, high], p| [low.min(p), high.max(p)]);
            (low.is_finite()).then_some(0.5 * (low + high))
        };
        let found: Vec<Option<Vec2>> = (0..HEIGHTS).map(middle).collect();
        // Where there is no section, the nearest one below counts; below the lowest, that.
        let mut last = found.iter().flatten().next().copied().unwrap_or_default();
        let mut middles = Vec::with_capacity(HEIGHTS);
        for middle in found {
            last = middle.unwrap_or(last);
            middles.push(last);
        }
        Self { top, middles }
    }

    fn at(&self, y: f32) -> Vec2 {
        let way = (y / self.top).clamp(0.0, 1.0) * (HEIGHTS - 1) as f32;
        let k = (way as usize).min(HEIGHTS - 2);
        self.middles[k].lerp(self.middles[k + 1], way - k as f32)
    }
}

/// One segment of an arm: how it is turned, moved and drawn out.
struct ArmBone {
    from: Vec3,
    to: Vec3,
    turn: Quat,
    /// Direction of the segment on the first body, and how many times longer it is on the second.
    along: Vec3,
    longer: f32,
}

impl ArmBone {
    /// Upper arm, forearm and hand of a side; the upper arm begins at `shoulder` on the second body, or at its joint.
    fn of(from: &Body, to: &Body, side: f32, shoulder: Option<Vec3>) -> [Self; 3] {
        let sided = |j: Joint| if side > 0.0 { j } else { j.mirror() };
        let chain = [Joint::LeftShoulder, Joint::LeftElbow, Joint::LeftWrist, Joint::LeftHand].map(sided);
        std::array::from_fn(|k| {
            let a = from.skeleton.at(chain[k]);
            let b = shoulder.filter(|_| k == 0).unwrap_or_else(|| to.skeleton.at(chain[k]));
            let (u, v) = (from.skeleton.at(chain[k + 1]) - a, to.skeleton.at(chain[k + 1]) - b);
            let along = u.normalize_or(Vec3::X);
            let turn = Quat::from_rotation_arc(along, v.normalize_or(along));
            Self { from: a, to: b, turn, along, longer: v.length() / u.length().max(1e-3) }
        })
    }

    fn place(&self, p: Vec3) -> Vec3 {
        let way = p - self.from;
        let along = self.along * way.dot(self.along);
        self.to + self.turn * (way + along * (self.longer - 1.0))
    }
}

/// Which segment of a side's arm a bone belongs to.
fn arm_segment(bone: u8, side: usize) -> Option<usize> {
    let joint = bone_joint(usize::from(bone))?;
    let left = if side == 0 { joint } else { joint.mirror() };
    match left {
        Joint::LeftShoulder => Some(0),
        Joint::LeftElbow => Some(1),
        Joint::LeftWrist | Joint::LeftHand => Some(2),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use toile_bake::weights;
    use toile_base::body::{Measures, Sex};

    fn woman(times: f32) -> Body {
        let m = Measures::average(Sex::Female);
        crate::body::build(Sex::Female, &Measures { stature: m.stature * times, ..m }).unwrap()
    }

    /// Places 2 cm above the skin of one body come to lie as far above the other's, where no joint bends. Between fingers and
    /// between the legs they lie in another finger or leg.
    #[test]
    fn the_skin_of_one_body_comes_to_the_skin_of_the_other() {
        let (from, to) = (woman(1.0), woman(1.07));
        let way = BodyWay::new(&from, &to);
        let skin = crate::rig::skin::SkinByHeight::new(&to);
        let vertices: Vec<usize> = (0..from.mesh.positions.len()).step_by(7).collect();
        let lifted: Vec<Vec3> = vertices.iter().map(|v| from.mesh.positions[*v] + 0.02 * from.normals[*v]).collect();
        let of = weights::transfer(&from, &lifted, |_, _| true);
        let wrist = from.skeleton.at(Joint::LeftWrist).x;
        let mut off: Vec<f32> = lifted
            .iter()
            .zip(&of)
            .filter(|(p, _)| (0.15..from.levels.neck).contains(&p.y) && p.x.abs() < wrist)
            .filter(|(p, _)| p.y > from.levels.crotch || p.x.abs() > 0.03)
            .map(|(p, w)| (skin.distance_of(way.place(*p, w, Below::Legs), |_| true).unwrap().1 - 0.02).abs())
            .collect();
        let p95 = toile_base::numeric::statistics::quantile(&mut off, 0.95).unwrap();
        assert!(p95 < 0.005, "{p95}");
    }

    #[test]
    fn the_same_body_leaves_everything_where_it_is() {
        let body = woman(1.0);
        let way = BodyWay::new(&body, &body);
        for v in (0..body.mesh.positions.len()).step_by(101) {
            let p = body.mesh.positions[v];
            for below in [Below::Legs, Below::Skirt] {
                assert!(way.place(p, &body.weights[v], below).distance(p) < 1e-5, "{p}");
            }
        }
    }
}
