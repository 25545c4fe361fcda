//! A skin vertex by vertex, for posing it elsewhere, such as on a GPU: the numbers of the kernels in their order, so their bits.

use glam::Vec3;
use toile_base::limits::MAX_INFLUENCES;

use super::SkinningJob;
use crate::lanes::MOST;

/// A vertex as the kernels have it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LaidVertex {
    /// Index in the mesh.
    pub vertex: usize,
    /// Which of [`SkinningJob::runs`] it belongs to.
    pub run: usize,
    /// Position in the rest pose (m).
    pub position: Vec3,
    /// Its unit normal at rest, or zero.
    pub normal: Vec3,
    /// What each bone of the run weighs but the first, to which the others are added; behind them nothing.
    pub weights: [f32; MAX_INFLUENCES - 1],
}

impl SkinningJob {
    /// The bones of each run of vertices: the first is what the differences of the others from it, weighted, are added to,
    /// in this order.
    pub fn runs(&self) -> impl Iterator<Item = &[u8]> {
        self.layout.runs.iter().map(|run| run.bones())
    }

    /// All vertices in the order of the runs. At load.
    pub fn laid(&self) -> impl Iterator<Item = LaidVertex> {
        let layout = &self.layout;
        let mut order: Vec<usize> = (0..layout.slots.len()).collect();
        order.sort_unstable_by_key(|&v| layout.slots[v]);
        order.into_iter().map(|vertex| {
            let (block, lane) = (layout.slots[vertex] as usize / MOST, layout.slots[vertex] as usize % MOST);
            // Runs follow each other block by block.
            let number = layout.runs.partition_point(|r| r.first <= block) - 1;
            let run = &layout.runs[number];
            let at = run.rest(block - run.first) + lane;
            let number_at = |k: usize| layout.rest.as_slice()[at + k * MOST];
            let three = |k: usize| Vec3::new(number_at(k), number_at(k + 1), number_at(k + 2));
            let weight = |k: usize| if k + 1 < run.count { number_at(6 + k) } else { 0.0 };
            let weights = std::array::from_fn(weight);
            LaidVertex { vertex, run: number, position: three(0), normal: three(3), weights }
        })
    }
}
