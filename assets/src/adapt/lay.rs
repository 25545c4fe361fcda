//! Laid on a shopper: vertices come from the body that the mesh is made for, and out of the shopper's skin.

use glam::Vec3;

use super::layers::PieceOrder;
use super::made_for::arm_share;
use super::mesh::{ForeignMesh, sides};
use super::place::{Below, BodyWay, leg_share};
use crate::rig::skin::SkinByHeight;
use toile_bake::shape::NO_VERTEX;
use toile_base::body::{Body, Region};
use toile_base::garment::Part;
use toile_base::mesh::SkinWeights;
use toile_base::skeleton::{BONES, Joint};

/// Cloth starts at least this far from the skin (m): a little more than the contact offset of the thickest fabric.
const START_GAP_M: f32 = 0.005;

/// No vertex is pushed farther than this (m): from deeper inside it would come out on another side.
const FARTHEST_PUSH_M: f32 = 0.08;

/// Rounds in which cloth is drawn to its own lengths and pushed out of the skin; in all but the last, neighbours share the push.
const ROUNDS: usize = 8;

/// Rounds of drawing before each push.
const DRAWS: usize = 12;

/// Pieces that lie over each other start at least so far apart (m).
const LAYER_GAP_M: f32 = 0.008;

/// Rounds in which skin weights are averaged with those of the neighbours: a skirt's middle follows both legs.
const SMOOTHINGS: usize = 8;

/// A mesh on a shopper; all but the order a value a vertex.
#[derive(Debug, Clone, PartialEq)]
pub struct LaidMesh {
    /// Start position of each vertex (m).
    pub worn: Vec<Vec3>,
    /// How far from the skin that is (m).
    pub clearance: Vec<f32>,
    /// Skin weights, smooth along the cloth.
    pub weights: Vec<SkinWeights>,
    /// The part of the body that it lies on.
    pub parts: Vec<Part>,
    /// Pairs of pieces that lie over each other.
    pub order: PieceOrder,
}

/// Properties of a mesh before it is laid, a value a vertex.
pub struct LayInput<'a> {
    /// Skin weights of the body that it is made for.
    pub weights: &'a [SkinWeights],
    /// What its piece hangs around.
    pub below: &'a [Below],
    /// Number of its piece.
    pub piece: &'a [u32],
}

/// Lays a mesh on a shopper.
pub fn lay(mesh: &ForeignMesh, input: &LayInput<'_>, from: &Body, shopper: &Body) -> LaidMesh {
    let LayInput { weights, below, .. } = *input;
    let way = BodyWay::new(from, shopper);
    let vertices = mesh.positions.iter().zip(weights).zip(below);
    let mut worn: Vec<Vec3> = vertices.map(|((p, w), below)| way.place(*p, w, *below)).collect();
    let neighbours = mesh.neighbours();
    let made = BodySkin::new(from);
    let heights: Vec<f32> =
        mesh.positions.iter().zip(weights).map(|(p, w)| made.beside(*p, w).map_or(1.0, |(_, d)| d)).collect();
    let skin = BodySkin::new(shopper);
    let order = PieceOrder::of(mesh, input.piece, &heights);
    let lengths = Lengths::of(mesh);
    for round in 0..ROUNDS {
        lengths.draw(&mut worn);
        let gaps = gaps(&skin, &order, &worn, weights);
        push_out(&skin, &mut worn, weights, &neighbours, &gaps, round + 1 == ROUNDS);
    }
    let clearance = worn.iter().zip(weights).map(|(p, w)| skin.beside(*p, w).map_or(1.0, |(_, d)| d)).collect();
    let found = worn.iter().zip(weights).map(|(p, w)| on_shopper(shopper, *p, w)).collect::<Vec<_>>();
    let weights = smooth(&found, &neighbours);
    let parts = worn.iter().zip(&weights).zip(below).map(|((p, w), below)| skin.part(*p, w, *below)).collect();
    LaidMesh { worn, clearance, weights, parts, order }
}

/// How far each vertex stays from the skin (m): outer pieces outside of what they lie over, wherever that lies by now.
fn gaps(skin: &BodySkin<'_>, order: &PieceOrder, worn: &[Vec3], weights: &[SkinWeights]) -> Vec<f32> {
    let mut gaps = vec![START_GAP_M; worn.len()];
    for [over, under] in &order.over {
        let (over, under) = (*over as usize, *under as usize);
        let lies = skin.beside(worn[under], &weights[under]).map_or(0.0, |(_, d)| d).clamp(START_GAP_M, MOST_UNDER_M);
        gaps[over] = gaps[over].max(lies + LAYER_GAP_M);
    }
    gaps
}

/// What lies under another piece lifts it by no more than this (m).
const MOST_UNDER_M: f32 = 0.03;

/// The lengths that cloth wants: of its edges and of the diagonals of its quads.
struct Lengths(Vec<([u32; 2], f32)>);

impl Lengths {
    fn of(mesh: &ForeignMesh) -> Self {
        let mut pairs: Vec<[u32; 2]> = mesh.faces.iter().flat_map(sides).map(|[a, b]| [a.min(b), a.max(b)]).collect();
        let quads = mesh.faces.iter().filter(|f| f[3] != NO_VERTEX);
        pairs.extend(quads.flat_map(|&[a, b, c, d]| [[a.min(c), a.max(c)], [b.min(d), b.max(d)]]));
        pairs.sort_unstable();
        pairs.dedup();
        let length = |[a, b]: [u32; 2]| mesh.positions[a as usize].distance(mesh.positions[b as usize]);
        Self(pairs.into_iter().map(|pair| (pair, length(pair))).collect())
    }

    /// Draws cloth to its lengths: each vertex goes the mean of what its lengths ask for, so that left and right go alike.
    fn draw(&self, worn: &mut [Vec3]) {
        let mut asked = vec![(Vec3::ZERO, 0.0f32); worn.len()];
        for _ in 0..DRAWS {
            asked.fill((Vec3::ZERO, 0.0));
            for ([a, b], length) in &self.0 {
                let (a, b) = (*a as usize, *b as usize);
                let way = worn[b] - worn[a];
                let by = way * (0.5 * (1.0 - length / way.length().max(1e-6)));
                asked[a] = (asked[a].0 + by, asked[a].1 + 1.0);
                asked[b] = (asked[b].0 - by, asked[b].1 + 1.0);
            }
            for (p, (by, count)) in worn.iter_mut().zip(&asked) {
                // Twice the mean still converges, because each length moves both of its ends.
                *p += *by * (1.6 / count.max(1.0));
            }
        }
    }
}

/// The skin weights of places near a body, averaged along the cloth.
pub fn smooth_weights(mesh: &ForeignMesh, body: &Body) -> Vec<SkinWeights> {
    let found = toile_bake::weights::transfer(body, &mesh.positions, |_, _| true);
    smooth(&found, &mesh.neighbours())
}

/// The weights of the shopper's skin near a place, of the limb that the mesh's maker laid the cloth on.
fn on_shopper(shopper: &Body, p: Vec3, made: &SkinWeights) -> SkinWeights {
    let carried = |bone: usize| {
        let one = SkinWeights { bones: [bone as u8; 4], weights: [1.0, 0.0, 0.0, 0.0] };
        [1.0, -1.0].iter().all(|side| arm_share(&one, *side) == 0.0 || arm_share(made, *side) > 0.02)
    };
    toile_bake::weights::transfer(shopper, &[p], |_, bone| carried(bone))[0]
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

/// A body's skin, as cloth on one of its limbs meets it.
struct BodySkin<'a> {
    body: &'a Body,
    skin: SkinByHeight<'a>,
}

impl<'a> BodySkin<'a> {
    fn new(body: &'a Body) -> Self {
        Self { body, skin: SkinByHeight::new(body) }
    }

    /// The vertex of the skin that cloth lies on, and how far it is (m): of an arm where arms carry the cloth, else of the rest.
    fn beside(&self, p: Vec3, weights: &SkinWeights) -> Option<(usize, f32)> {
        let arms = [(arm_share(weights, 1.0), Region::LeftArm), (arm_share(weights, -1.0), Region::RightArm)];
        self.skin.distance_of(p, |v| {
            let region = self.body.regions[v];
            arms.iter().all(|(share, of)| if region == *of { *share > 0.3 } else { *share < 0.7 })
        })
    }

    /// The part of the body that a vertex lies on.
    fn part(&self, p: Vec3, weights: &SkinWeights, below: Below) -> Part {
        if self.skin.in_armpit(p) {
            return Part::Hollow;
        }
        for (side, part) in [(1.0, Part::LeftArm), (-1.0, Part::RightArm)] {
            if arm_share(weights, side) > 0.5 {
                return part;
            }
        }
        let [left, right] = [Joint::LeftHip, Joint::RightHip].map(|hip| leg_share(weights, hip));
        match below {
            Below::Legs if p.y < self.body.levels.crotch && left > 0.5 => Part::LeftLeg,
            Below::Legs if p.y < self.body.levels.crotch && right > 0.5 => Part::RightLeg,
            _ => Part::Trunk,
        }
    }
}

/// Pushes cloth out of the skin; neighbours share the push, except the last time.
fn push_out(
    skin: &BodySkin<'_>,
    worn: &mut [Vec3],
    weights: &[SkinWeights],
    neighbours: &[Vec<u32>],
    gaps: &[f32],
    last: bool,
) {
    let push = |((p, w), gap): ((&Vec3, &SkinWeights), &f32)| match skin.beside(*p, w) {
        Some((v, d)) if d < *gap => skin.body.normals[v] * (gap - d).min(FARTHEST_PUSH_M),
        _ => Vec3::ZERO,
    };
    let pushes: Vec<Vec3> = worn.iter().zip(weights).zip(gaps).map(push).collect();
    for (v, p) in worn.iter_mut().enumerate() {
        let shared =
            neighbours[v].iter().map(|u| pushes[*u as usize]).sum::<Vec3>() / neighbours[v].len().max(1) as f32;
        let further = !last && shared.length_squared() > pushes[v].length_squared();
        *p += if further { shared } else { pushes[v] };
    }
}
