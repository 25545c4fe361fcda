//! Skin weights over a file's joints become weights over the engine's bones.
//!
//! Joints that are not ours hand their skin to the nearest one above them that is; fingers go with the knuckles. Where
//! a limb is split for twist (Gultepe 2013, section 4.4.3) the skin between its ends is divided linearly between the
//! two bones, and so is that of a spine without a chest. The four largest weights are kept and sum to 1.

use std::ops::Range;

use glam::Vec3;

use super::raw::{RawBody, RawInfluences};
use super::rest::carriers;
use toile_base::limits::INFLUENCES;
use toile_base::mesh::SkinWeights;
use toile_base::skeleton::{BONES, Joint, Skeleton, TWISTS};

/// Loss by pruning to four influences.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PruningLoss {
    /// Most influences of a vertex in the file.
    pub most_influences: usize,
    /// Vertices with more than four in the file.
    pub over_four: usize,
    /// Vertices that lost weight, counted over our bones.
    pub vertices: usize,
    /// Mean over those vertices of the weight lost (1).
    pub mean_lost: f32,
    /// Most weight that a vertex lost (1).
    pub max_lost: f32,
}

/// The weights of every vertex of a standing body. `placed` are the joints that its file lacks.
pub(super) fn weights(raw: &RawBody, skeleton: &Skeleton, placed: &[Joint]) -> (Vec<SkinWeights>, PruningLoss) {
    let carriers = carriers(raw);
    let splits = splits(skeleton, placed);
    let mut pruned = PruningLoss::default();
    let mut sum = 0.0f64;
    let mut out = Vec::with_capacity(raw.influences.len());
    for (influences, &p) in raw.influences.iter().zip(&raw.positions) {
        let count = influences.0.iter().filter(|(_, w)| *w > 0.0).count();
        pruned.most_influences = pruned.most_influences.max(count);
        pruned.over_four += usize::from(count > INFLUENCES);
        let (kept, lost) = four_largest(&over_bones(influences, &carriers, &splits, p));
        if lost > 0.0 {
            pruned.vertices += 1;
            pruned.max_lost = pruned.max_lost.max(lost);
            sum += f64::from(lost);
        }
        out.push(kept);
    }
    pruned.mean_lost = (sum / pruned.vertices.max(1) as f64) as f32;
    (out, pruned)
}

/// A bone whose skin is divided linearly among itself and those that follow it: the chain, where the division begins,
/// and the way to its end.
struct TwistSplit {
    chain: Vec<usize>,
    start: Vec3,
    way: Vec3,
}

fn splits(skeleton: &Skeleton, placed: &[Joint]) -> Vec<TwistSplit> {
    let split = |from: Joint, to: Joint, others: Range<usize>| {
        let start = skeleton.at(from);
        TwistSplit { chain: std::iter::once(from.index()).chain(others).collect(), start, way: skeleton.at(to) - start }
    };
    let mut all: Vec<TwistSplit> = TWISTS.iter().map(|t| split(t.from, t.to, t.bones())).collect();
    if placed.contains(&Joint::Chest) {
        let chest = Joint::Chest.index();
        all.push(split(Joint::Spine, Joint::Chest, chest..chest + 1));
    }
    all
}

fn over_bones(influences: &RawInfluences, carriers: &[Joint], splits: &[TwistSplit], p: Vec3) -> [f32; BONES] {
    let mut bones = [0.0; BONES];
    for (joint, weight) in influences.0 {
        if weight > 0.0 {
            bones[carriers[joint as usize].index()] += weight;
        }
    }
    for split in splits {
        let along = (p - split.start).dot(split.way) / split.way.length_squared().max(1e-12);
        let whole = std::mem::take(&mut bones[split.chain[0]]);
        let last = split.chain.len() - 1;
        let place = along.clamp(0.0, 1.0) * last as f32;
        let below = (place as usize).min(last - 1);
        bones[split.chain[below]] += whole * (1.0 - (place - below as f32));
        bones[split.chain[below + 1]] += whole * (place - below as f32);
    }
    bones
}

/// The four largest weights, made to sum to 1, and what the others had; equal ones in the order of the bones.
fn four_largest(bones: &[f32; BONES]) -> (SkinWeights, f32) {
    let mut order: [usize; BONES] = std::array::from_fn(|i| i);
    order.sort_by(|&a, &b| bones[b].total_cmp(&bones[a]));
    let sum: f32 = order[..INFLUENCES].iter().map(|&i| bones[i]).sum();
    let lost: f32 = order[INFLUENCES..].iter().map(|&i| bones[i]).sum();
    let mut out = SkinWeights::default();
    for k in 0..INFLUENCES {
        if bones[order[k]] > 0.0 {
            out.bones[k] = order[k] as u8;
            out.weights[k] = bones[order[k]] / sum;
        }
    }
    (out, lost)
}
