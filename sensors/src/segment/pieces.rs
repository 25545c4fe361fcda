//! Connected pieces of surface.

use super::grid::Grid;

/// Label of a cell in no piece.
pub(super) const NONE: u32 = u32::MAX;

/// The pieces of a frame: cells one piece after the other, each from its first found cell on.
#[derive(Debug, Clone, Default)]
pub(super) struct Pieces {
    /// All cells that are in a piece, in the order found.
    cells: Vec<u32>,
    /// Start of each piece in `cells`.
    begins: Vec<u32>,
    /// The piece of each cell, or [`NONE`].
    label: Vec<u32>,
}

impl Pieces {
    /// Finds the pieces of a grid that show at least so many cells nearer than a distance (m).
    pub fn find(&mut self, grid: &Grid, fewest: usize, farthest: f32) {
        self.cells.clear();
        self.begins.clear();
        self.label.clear();
        self.label.resize(grid.depth.len(), NONE);
        for seed in 0..grid.depth.len() {
            if self.label[seed] != NONE || grid.depth[seed] == 0.0 || grid.depth[seed] > farthest {
                continue;
            }
            let begin = self.cells.len();
            let piece = self.begins.len() as u32;
            self.label[seed] = piece;
            self.cells.push(seed as u32);
            let mut next = begin;
            while next < self.cells.len() {
                let cell = self.cells[next] as usize;
                next += 1;
                for other in grid.neighbours(cell) {
                    if self.label[other] == NONE && grid.depth[other] <= farthest && grid.joined(cell, other) {
                        self.label[other] = piece;
                        self.cells.push(other as u32);
                    }
                }
            }
            if self.cells.len() - begin >= fewest {
                self.begins.push(begin as u32);
            } else {
                // Too small to be anything; its label must not be taken for the next piece's.
                self.cells[begin..].iter().for_each(|c| self.label[*c as usize] = NONE - 1);
                self.cells.truncate(begin);
            }
        }
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        self.begins.len()
    }

    /// The cells of one piece.
    pub fn cells(&self, piece: usize) -> &[u32] {
        let begin = self.begins[piece] as usize;
        let end = self.begins.get(piece + 1).map_or(self.cells.len(), |e| *e as usize);
        &self.cells[begin..end]
    }
}
