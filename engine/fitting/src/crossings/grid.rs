//! A uniform grid over the boxes of a mesh's triangles, so that an edge is tested with those near it only.
//!
//! Its cells are hashed into buckets (Teschner et al. 2003, "Optimized spatial hashing for collision detection of
//! deformable objects"), so it needs no limits in space. Cells that share a bucket cost time and nothing else, because the box of
//! each triangle found in one is compared.

use glam::DVec3;

use super::bounds::Bounds;
use super::mesh::{CrossingMesh, are_testable};

/// Most cells that a box is written into or looked up by, 8 along each axis of a cube. A triangle that covers more is
/// compared with every edge, an edge that covers more with every triangle.
const MAX_CELLS: i64 = 512;

/// Least size of a cell (m), where all edges have no length.
const MIN_CELL: f64 = 1e-6;

/// Buckets per triangle, at least: a surface fills about half a cell per triangle, and each touches some more.
const BUCKETS: usize = 2;

/// The triangles of a mesh by the cells that their boxes lie in.
#[derive(Debug)]
pub(super) struct TriangleGrid<'a> {
    /// What it is of.
    pub mesh: CrossingMesh<'a>,
    /// Box of each triangle; empty where a corner cannot be tested.
    boxes: Vec<Bounds>,
    /// Around all boxes.
    around: Bounds,
    /// Cells per m.
    per_m: f64,
    /// Where each bucket begins in `entries`; their number is a power of two, and one.
    starts: Vec<u32>,
    /// Triangles, by bucket.
    entries: Vec<u32>,
    /// Triangles that cover more than [`MAX_CELLS`].
    large: Vec<u32>,
}

/// Which triangles an edge has met, so that none is met twice where they share several cells (mailboxes: Amanatides and
/// Woo 1987, "A fast voxel traversal algorithm for ray tracing").
#[derive(Debug)]
pub(super) struct Mailboxes {
    rounds: Vec<u32>,
    round: u32,
}

impl Mailboxes {
    /// Of a mesh of so many triangles.
    pub fn new(triangles: usize) -> Self {
        Self { rounds: vec![0; triangles], round: 0 }
    }

    /// Whether a triangle is met for the first time in this round.
    fn is_first(&mut self, triangle: u32) -> bool {
        std::mem::replace(&mut self.rounds[triangle as usize], self.round) != self.round
    }
}

/// A box of cells, both corners included.
#[derive(Debug, Clone, Copy)]
struct Cells {
    low: [i32; 3],
    high: [i32; 3],
}

impl Cells {
    /// Whether there are more than [`MAX_CELLS`].
    fn are_many(&self) -> bool {
        let along = |axis: usize| (i64::from(self.high[axis]) - i64::from(self.low[axis])).min(MAX_CELLS) + 1;
        along(0) * along(1) * along(2) > MAX_CELLS
    }

    /// Calls for each cell.
    fn each(&self, mut call: impl FnMut([i32; 3])) {
        for x in self.low[0]..=self.high[0] {
            for y in self.low[1]..=self.high[1] {
                for z in self.low[2]..=self.high[2] {
                    call([x, y, z]);
                }
            }
        }
    }
}

impl<'a> TriangleGrid<'a> {
    /// Over a mesh's triangles, cells as large as the median of its edges; a triangle with a corner that cannot be tested
    /// is left out.
    pub fn new(mesh: CrossingMesh<'a>, edges: &[[u32; 2]]) -> Self {
        let boxes: Vec<Bounds> = (0..mesh.triangles.len() as u32).map(|t| box_of(&mesh, t)).collect();
        let around = boxes.iter().fold(Bounds::EMPTY, |all, one| all.union(one));
        let buckets = (BUCKETS * boxes.len()).next_power_of_two();
        let starts = vec![0; buckets + 1];
        let per_m = cell_size(&mesh, edges).recip();
        let mut grid = Self { mesh, boxes, around, per_m, starts, entries: Vec::new(), large: Vec::new() };
        grid.fill();
        grid
    }

    /// Sorts the triangles into the buckets by counting.
    fn fill(&mut self) {
        let mut small = Vec::with_capacity(self.boxes.len());
        for (triangle, of) in (0..).zip(&self.boxes).filter(|(_, of)| of.low.x <= of.high.x) {
            let cells = self.cells(of);
            if cells.are_many() {
                self.large.push(triangle);
            } else {
                small.push((triangle, cells));
            }
        }
        let mask = self.starts.len() - 2;
        for (_, cells) in &small {
            cells.each(|cell| self.starts[bucket(cell, mask)] += 1);
        }
        // Each bucket's end, from which it is filled backwards: the last triangle first.
        let mut sum = 0;
        for start in &mut self.starts {
            sum += *start;
            *start = sum;
        }
        self.entries = vec![0; sum as usize];
        for (triangle, cells) in small.iter().rev() {
            cells.each(|cell| {
                let place = &mut self.starts[bucket(cell, mask)];
                *place -= 1;
                self.entries[*place as usize] = *triangle;
            });
        }
    }

    /// Calls for each triangle whose box overlaps another, once, in no order that means anything.
    pub fn each_near(&self, of: &Bounds, met: &mut Mailboxes, mut call: impl FnMut(u32)) {
        if !self.around.overlaps(of) {
            return;
        }
        let cells = self.cells(of);
        if cells.are_many() {
            let all = (0..).zip(&self.boxes);
            all.filter(|(_, one)| one.overlaps(of)).for_each(|(triangle, _)| call(triangle));
            return;
        }
        met.round += 1;
        let mask = self.starts.len() - 2;
        cells.each(|cell| {
            let bucket = bucket(cell, mask);
            let range = self.starts[bucket] as usize..self.starts[bucket + 1] as usize;
            for &triangle in &self.entries[range] {
                if self.boxes[triangle as usize].overlaps(of) && met.is_first(triangle) {
                    call(triangle);
                }
            }
        });
        self.large.iter().filter(|t| self.boxes[**t as usize].overlaps(of)).for_each(|t| call(*t));
    }

    /// The cells that a box lies in. Rounding is monotone, so boxes that overlap have a cell in common.
    fn cells(&self, of: &Bounds) -> Cells {
        // A cast of what is too large gives the last cell there is.
        let cell = |p: DVec3| (p * self.per_m).floor().to_array().map(|x| x as i32);
        Cells { low: cell(of.low), high: cell(of.high) }
    }
}

/// The box of a triangle, empty where a corner cannot be tested.
fn box_of(mesh: &CrossingMesh, triangle: u32) -> Bounds {
    let corners = mesh.corners(triangle);
    if are_testable(&corners) { Bounds::of(&corners) } else { Bounds::EMPTY }
}

/// The median of the edges (m), which a few torn ones leave as it is.
fn cell_size(mesh: &CrossingMesh, edges: &[[u32; 2]]) -> f64 {
    let ends = edges.iter().map(|&edge| mesh.ends(edge)).filter(|ends| are_testable(ends));
    let mut lengths: Vec<f64> = ends.map(|[p, q]| p.distance(q)).collect();
    if lengths.is_empty() {
        return 1.0;
    }
    let middle = lengths.len() / 2;
    lengths.select_nth_unstable_by(middle, f64::total_cmp).1.max(MIN_CELL)
}

/// The bucket of a cell, by the large primes of Teschner et al.
fn bucket([x, y, z]: [i32; 3], mask: usize) -> usize {
    let hash = x.wrapping_mul(73_856_093) ^ y.wrapping_mul(19_349_663) ^ z.wrapping_mul(83_492_791);
    hash as u32 as usize & mask
}
