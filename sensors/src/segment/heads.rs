//! The heads of a piece: its peaks. Two people who touch are one piece with two peaks, and are parted where the ways over
//! the surface to both are equally long.
//!
//! A peak counts by its persistence (Edelsbrunner et al. 2002): how far one has to go down from it before a higher place
//! can be reached. A head stands 25 cm above the shoulder over which another person is reached; a raised hand is a peak
//! too, but what belongs to it is no person.

use super::grid::Grid;

/// How far a peak stands out of what it is part of (m).
const STANDS_OUT: f32 = 0.12;

/// Distance over the surface from the border between two people within which a cell is given to neither (m): a forearm
/// with its hand.
const TOUCHING: f32 = 0.4;

/// Most peaks of a piece: two people with raised hands have six.
pub(super) const MAX_PEAKS: usize = 8;

/// Marks a cell that is in no hill yet.
const NO_HILL: u32 = u32::MAX;

/// Owner of a cell outside the piece, of one not reached yet, and of one near a border.
const OUTSIDE: u8 = u8::MAX - 2;
const FREE: u8 = u8::MAX;
const AT_BORDER: u8 = u8::MAX - 1;

/// Finds peaks and parts pieces; its arrays are as large as the grid.
#[derive(Debug, Clone, Default)]
pub(super) struct Heads {
    /// Cells of the piece from high to low.
    order: Vec<u32>,
    /// For each cell of the grid the one that stands for its hill, while the water falls; itself at a peak.
    hill: Vec<u32>,
    /// For each cell of the grid the number of its peak.
    owner: Vec<u8>,
    queue: Vec<u32>,
}

impl Heads {
    /// The peaks of a piece, the highest first, at most [`MAX_PEAKS`].
    pub fn peaks(&mut self, grid: &Grid, cells: &[u32]) -> Vec<u32> {
        self.hill.resize(grid.depth.len(), NO_HILL);
        self.order.clear();
        self.order.extend_from_slice(cells);
        self.order
            .sort_unstable_by(|a, b| grid.height[*b as usize].total_cmp(&grid.height[*a as usize]).then(a.cmp(b)));
        let mut peaks = Vec::new();
        for i in 0..self.order.len() {
            let cell = self.order[i];
            self.hill[cell as usize] = cell;
            for other in grid.neighbours(cell as usize) {
                if self.hill[other] == NO_HILL || !grid.joined(cell as usize, other) {
                    continue;
                }
                let (a, b) = (self.root(cell), self.root(other as u32));
                if a == b {
                    continue;
                }
                let (high, low) = if self.above(grid, a, b) { (a, b) } else { (b, a) };
                // Two hills meet here: the lower one ends, and counts if it stood out.
                if grid.height[low as usize] - grid.height[cell as usize] > STANDS_OUT {
                    peaks.push(low);
                }
                self.hill[low as usize] = high;
            }
        }
        // What never met a higher hill is a peak; within one piece that is the highest cell.
        peaks.extend(self.order.iter().copied().filter(|c| self.hill[*c as usize] == *c));
        for cell in cells {
            self.hill[*cell as usize] = NO_HILL;
        }
        peaks.sort_unstable_by(|a, b| grid.height[*b as usize].total_cmp(&grid.height[*a as usize]).then(a.cmp(b)));
        peaks.truncate(MAX_PEAKS);
        peaks
    }

    fn above(&self, grid: &Grid, a: u32, b: u32) -> bool {
        (grid.height[a as usize], b) > (grid.height[b as usize], a)
    }

    fn root(&mut self, mut cell: u32) -> u32 {
        while self.hill[cell as usize] != cell {
            let up = self.hill[cell as usize];
            // Shorten the way for the next who asks.
            self.hill[cell as usize] = self.hill[up as usize];
            cell = up;
        }
        cell
    }

    /// Parts a piece among its peaks: every cell goes to the peak that is nearest over the surface. Gives the cells of
    /// each, in the order of the peaks.
    pub fn part(&mut self, grid: &Grid, cells: &[u32], peaks: &[u32]) -> Vec<Vec<u32>> {
        self.owner.resize(grid.depth.len(), OUTSIDE);
        cells.iter().for_each(|c| self.owner[*c as usize] = FREE);
        self.queue.clear();
        let mut parts = vec![Vec::new(); peaks.len()];
        for (i, peak) in peaks.iter().enumerate() {
            self.owner[*peak as usize] = i as u8;
            self.queue.push(*peak);
        }
        // Breadth first, all peaks in turn.
        let mut next = 0;
        while next < self.queue.len() {
            let cell = self.queue[next] as usize;
            next += 1;
            let owner = self.owner[cell];
            parts[usize::from(owner)].push(cell as u32);
            for other in grid.neighbours(cell) {
                if self.owner[other] == FREE && grid.joined(cell, other) {
                    self.owner[other] = owner;
                    self.queue.push(other as u32);
                }
            }
        }
        if peaks.len() > 1 {
            self.draw_back(grid, cells, &mut parts);
        }
        cells.iter().for_each(|c| self.owner[*c as usize] = OUTSIDE);
        parts
    }

    /// Takes cells near a border between two parts out of both: the way to the heads cannot tell to whom a touching hand
    /// belongs, and no cell of another person may be in the shopper.
    fn draw_back(&mut self, grid: &Grid, cells: &[u32], parts: &mut [Vec<u32>]) {
        let parted =
            |a: usize, b: usize, owner: &[u8]| owner[b] != OUTSIDE && grid.joined(a, b) && owner[a] != owner[b];
        self.queue.clear();
        for cell in cells {
            let cell = *cell as usize;
            if grid.neighbours(cell).any(|other| parted(cell, other, &self.owner)) {
                self.queue.push(cell as u32);
            }
        }
        let (mut begin, mut way) = (0, 0.0);
        while begin < self.queue.len() && way < TOUCHING {
            let end = self.queue.len();
            // A step reaches two cells along rows and columns, and one and a half aslant.
            way += 1.4 * grid.area(self.queue[begin] as usize).sqrt();
            for i in begin..end {
                let cell = self.queue[i] as usize;
                self.owner[cell] = AT_BORDER;
                for other in grid.neighbours(cell) {
                    if self.owner[other] != AT_BORDER && self.owner[other] != OUTSIDE && grid.joined(cell, other) {
                        self.owner[other] = AT_BORDER;
                        self.queue.push(other as u32);
                    }
                }
            }
            begin = end;
        }
        parts.iter_mut().for_each(|part| part.retain(|c| self.owner[*c as usize] != AT_BORDER));
    }
}
