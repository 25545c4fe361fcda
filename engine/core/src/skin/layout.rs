//! The layout of a skin: vertices of the same joint set side by side, in blocks of the widest lanes.
//!
//! A set whose vertices do not fill its last block would leave lanes empty. Such remainders are put together where their
//! sets have few enough bones in common, with weight 0 for the bones that a vertex does not follow: fewer blocks, each
//! of which costs a little more.

use std::collections::BTreeMap;
use std::sync::Arc;

use toile_base::limits::{INFLUENCES, MAX_INFLUENCES};

use super::check::{NO_BONE, Vertex};
use super::posed::Posed;
use crate::lanes::{MOST, RecordList, Store, Width};

/// Bones of a set in the order of their indices, [`NO_BONE`] behind them.
type BoneSet = [u8; MAX_INFLUENCES];

/// Blocks on one joint set, one after the other.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct BoneRun {
    /// Its bones, the base first.
    bones: BoneSet,
    /// How many bones there are.
    pub count: usize,
    /// Index of its first rest data in [`SkinLayout::rest`].
    data: usize,
    /// Its first block and how many there are.
    pub first: usize,
    pub blocks: usize,
}

impl BoneRun {
    /// Where the rest data of one of its blocks begins: `[3 position, 3 normal, count - 1 weights][MOST]`.
    #[inline(always)]
    pub fn rest(&self, block: usize) -> usize {
        self.data + block * self.stride()
    }

    #[inline(always)]
    fn stride(&self) -> usize {
        (5 + self.count) * MOST
    }

    /// What a palette has for its `k`th bone; the base is the first.
    #[inline(always)]
    pub fn of<'a, T, const N: usize>(&self, palette: &'a [T; N], k: usize) -> &'a T {
        // Below N: checked at load.
        &palette[usize::from(self.bones[k])]
    }

    /// Its bones, the base first.
    pub fn bones(&self) -> &[u8] {
        &self.bones[..self.count]
    }

    /// What a block costs, in operations a lane, linear; a run's preparation is left out.
    fn cost(count: usize) -> usize {
        51 + 24 * (count - 1)
    }
}

/// Lanes that a run works on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Padding {
    /// Vertices of the skin.
    pub vertices: usize,
    /// Lanes, those that carry no vertex included.
    pub lanes: usize,
    /// Blocks of [`MOST`] lanes.
    pub blocks: usize,
    /// Runs: joint sets that lie apart.
    pub runs: usize,
    /// Influences that the vertices have, and those that their blocks spend on them.
    pub influences: usize,
    /// Influences that their blocks compute for them.
    pub blended: usize,
}

impl Padding {
    /// Share of the lanes that carries no vertex (0..1).
    pub fn share(&self) -> f64 {
        if self.lanes == 0 { 0.0 } else { 1.0 - self.vertices as f64 / self.lanes as f64 }
    }
}

/// A skin in blocks.
#[derive(Debug, Clone)]
pub(super) struct SkinLayout {
    pub runs: Box<[BoneRun]>,
    /// The run at which the second worker's share begins.
    pub half: usize,
    /// Vertices of each block.
    pub filled: Box<[u8]>,
    /// Rest data of all runs.
    pub rest: Store,
    /// Lane of each vertex, counted over all blocks `[vertices]`.
    pub slots: Arc<[u32]>,
    /// The double record of each lane in a [`PosedMesh`](super::PosedMesh); of lanes that carry no vertex a spare one a share.
    pub records: RecordList,
    /// Positions (m) and normals in the rest pose.
    at_rest: Posed,
    influences: usize,
}

/// Vertices on a set that share blocks.
struct VertexGroup {
    set: BoneSet,
    vertices: Vec<usize>,
}

impl SkinLayout {
    pub fn new(vertices: &[Vertex]) -> Self {
        let groups = grouped(vertices);
        let mut runs = Vec::new();
        let (mut filled, mut data, mut slots) = (Vec::new(), 0, vec![0u32; vertices.len()]);
        for group in &groups {
            let blocks = group.vertices.len().div_ceil(MOST);
            let (bones, count) = (based(group, vertices), size(&group.set));
            let run = BoneRun { bones, count, data, first: filled.len(), blocks };
            for (k, &v) in group.vertices.iter().enumerate() {
                slots[v] = (run.first * MOST + k) as u32;
            }
            filled.extend(group.vertices.chunks(MOST).map(|c| c.len() as u8));
            data += blocks * run.stride();
            runs.push(run);
        }
        let mut rest = Store::zeros(data);
        for (run, group) in runs.iter().zip(&groups) {
            group.vertices.iter().enumerate().for_each(|(k, &v)| write(&mut rest, run, k, &vertices[v]));
        }
        let half = halve(&mut runs);
        let slots: Arc<[u32]> = slots.into();
        let mut at_rest = Posed::new(filled.len(), slots.clone());
        vertices.iter().enumerate().for_each(|(v, x)| at_rest.set(v, x.position, x.normal));
        let influences = vertices.iter().map(|v| size(&v.bones)).sum();
        let records = records(&runs[..half], filled.len(), &slots);
        Self { runs: runs.into(), half, filled: filled.into(), rest, slots, records, at_rest, influences }
    }

    pub fn posed(&self) -> Posed {
        self.at_rest.clone()
    }

    /// The bones that a vertex' block is blended from, the base first.
    #[cfg(test)]
    pub fn bones_of(&self, vertex: usize) -> Vec<u8> {
        let block = self.slots[vertex] as usize / MOST;
        let run = self.runs.iter().find(|r| (r.first..r.first + r.blocks).contains(&block));
        run.map(|r| r.bones().to_vec()).unwrap_or_default()
    }

    pub fn padding(&self, width: Width) -> Padding {
        let lanes = |filled: u8| usize::from(filled).next_multiple_of(width.lanes());
        let of_run =
            |r: &BoneRun| r.count * self.filled[r.first..r.first + r.blocks].iter().map(|f| lanes(*f)).sum::<usize>();
        Padding {
            vertices: self.slots.len(),
            lanes: self.filled.iter().map(|f| lanes(*f)).sum(),
            blocks: self.filled.len(),
            runs: self.runs.len(),
            influences: self.influences,
            blended: self.runs.iter().map(of_run).sum(),
        }
    }
}

/// The double record of each lane, that of its vertex; of lanes without one the spare of the share that they are in, of which
/// `first` are the runs of the first.
fn records(first: &[BoneRun], blocks: usize, slots: &[u32]) -> RecordList {
    let spare = |lane: usize| slots.len() + usize::from(lane >= MOST * first.iter().map(|r| r.blocks).sum::<usize>());
    let mut vertices: Vec<u32> = (0..blocks * MOST).map(|lane| spare(lane) as u32).collect();
    (0..).zip(slots).for_each(|(vertex, lane)| vertices[*lane as usize] = vertex);
    RecordList::doubles(vertices)
}

fn size(set: &BoneSet) -> usize {
    set.iter().filter(|b| **b != NO_BONE).count()
}

/// The rest data of the `k`th vertex of a run.
fn write(rest: &mut Store, run: &BoneRun, k: usize, vertex: &Vertex) {
    let at = run.rest(k / MOST) + k % MOST;
    let numbers = vertex.position.to_array().into_iter().chain(vertex.normal.to_array());
    let weight = |bone: &u8| vertex.bones.iter().position(|b| b == bone).map_or(0.0, |i| vertex.weights[i]);
    let weights = run.bones[1..run.count].iter().map(weight);
    numbers.chain(weights).enumerate().for_each(|(c, x)| rest.as_mut()[at + c * MOST] = x);
}

/// The bones of a group with that first which weighs most in all: the others are added to it, so it rounds least.
fn based(group: &VertexGroup, vertices: &[Vertex]) -> BoneSet {
    let weighs = |bone: u8| -> f64 {
        let of = |v: &usize| vertices[*v].bones.iter().zip(vertices[*v].weights).find(|(b, _)| **b == bone);
        group.vertices.iter().filter_map(of).map(|(_, w)| f64::from(w)).sum()
    };
    let mut bones = group.set;
    let count = size(&bones);
    let sums: Vec<f64> = bones[..count].iter().map(|b| weighs(*b)).collect();
    let base = (0..count).rev().max_by(|a, b| sums[*a].total_cmp(&sums[*b])).unwrap_or(0);
    bones[..=base].rotate_right(1);
    bones
}

/// All vertices by their sets, most bones first, remainders put together.
fn grouped(vertices: &[Vertex]) -> Vec<VertexGroup> {
    let mut by_set: BTreeMap<BoneSet, Vec<usize>> = BTreeMap::new();
    for (v, vertex) in vertices.iter().enumerate() {
        by_set.entry(vertex.bones).or_default().push(v);
    }
    let mut left: Vec<VertexGroup> = Vec::new();
    for (set, all) in &mut by_set {
        let whole = all.len() - all.len() % MOST;
        let vertices = all.split_off(whole);
        if !vertices.is_empty() {
            left.push(VertexGroup { set: *set, vertices });
        }
    }
    for group in together(left) {
        // Behind the whole blocks of its set, if there are any; two remainders of one set would not both fit there.
        by_set.entry(group.set).or_default().extend(group.vertices);
    }
    let filled = by_set.into_iter().filter(|(_, v)| !v.is_empty());
    let mut groups: Vec<VertexGroup> = filled.map(|(set, vertices)| VertexGroup { set, vertices }).collect();
    groups.sort_by_key(|g| std::cmp::Reverse(size(&g.set)));
    groups
}

/// Puts remainders into common blocks: each, the largest sets first, to where it costs least, or into its own.
fn together(mut left: Vec<VertexGroup>) -> Vec<VertexGroup> {
    left.sort_by_key(|g| (std::cmp::Reverse(size(&g.set)), std::cmp::Reverse(g.vertices.len()), g.set));
    let mut bins: Vec<VertexGroup> = Vec::new();
    for group in left {
        let own = BoneRun::cost(size(&group.set));
        let fits = |bin: &VertexGroup| {
            let union = union(&bin.set, &group.set)?;
            let most = size(&bin.set).max(INFLUENCES);
            let enough = bin.vertices.len() + group.vertices.len() <= MOST;
            (enough && size(&union) <= most).then(|| BoneRun::cost(size(&union)) - BoneRun::cost(size(&bin.set)))
        };
        let best = (0..bins.len()).filter_map(|i| Some((fits(&bins[i])?, i))).min().filter(|(cost, _)| *cost < own);
        match best {
            Some((_, i)) => {
                bins[i].set = union(&bins[i].set, &group.set).unwrap_or(bins[i].set);
                bins[i].vertices.extend(group.vertices);
            }
            None => bins.push(group),
        }
    }
    bins
}

/// The bones of two sets, unless they are too many.
fn union(a: &BoneSet, b: &BoneSet) -> Option<BoneSet> {
    let mut all: Vec<u8> = a.iter().chain(b).copied().filter(|x| *x != NO_BONE).collect();
    all.sort_unstable();
    all.dedup();
    let mut set = [NO_BONE; MAX_INFLUENCES];
    set.get_mut(..all.len())?.copy_from_slice(&all);
    Some(set)
}

/// Splits the runs where half of their cost lies, and says which is the first of the second half.
fn halve(runs: &mut Vec<BoneRun>) -> usize {
    let total: usize = runs.iter().map(|r| r.blocks * BoneRun::cost(r.count)).sum();
    let mut before = 0;
    for i in 0..runs.len() {
        let (run, cost) = (runs[i], BoneRun::cost(runs[i].count));
        if before + run.blocks * cost >= total.div_ceil(2) {
            let blocks = (total.div_ceil(2) - before).div_ceil(cost).min(run.blocks);
            if blocks < run.blocks {
                runs[i].blocks = blocks;
                let (data, first) = (run.rest(blocks), run.first + blocks);
                runs.insert(i + 1, BoneRun { data, first, blocks: run.blocks - blocks, ..run });
            }
            return i + 1;
        }
        before += run.blocks * cost;
    }
    runs.len()
}
