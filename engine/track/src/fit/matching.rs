//! Which sample of the body each cell of the picture shows: the nearest one that faces the camera as the cell does.

use glam::{Vec2, Vec3};

use super::figure::Figure;
use super::view::View;

/// Least cosine between the normals of a cell and of the sample that it shows.
const ALIKE: f32 = 0.35;

/// Least cosine between a sample's normal and the direction to the camera.
const FACING: f32 = 0.05;

/// What the picture says of one sample.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Match {
    /// Sum of the points that show it (m).
    sum: Vec3,
    /// How many they are.
    pub count: f32,
    /// Where it is seen, in cells, and its depth (m); meaningless if it does not face the camera.
    pub seen: Vec2,
    /// Its depth (m).
    pub z: f32,
    /// Whether it faces the camera, within the picture.
    pub faces: bool,
}

impl Match {
    /// Mean of the points that show it (m).
    pub(super) fn mean(&self) -> Vec3 {
        self.sum / self.count
    }
}

/// The matches of one frame.
pub(super) struct Matching {
    /// One a sample.
    pub of: Vec<Match>,
    /// Share of the cells that some sample explains.
    pub explained: f32,
    /// Mean square distance of cells from their samples' planes, those of unexplained cells counted as the gate (m2).
    pub off: f32,
    /// Samples by bucket: where each bucket starts, and the list.
    start: Vec<u32>,
    list: Vec<u32>,
}

impl Matching {
    pub(super) fn new(samples: usize) -> Self {
        Self { of: vec![Match::default(); samples], explained: 0.0, off: 0.0, start: Vec::new(), list: Vec::new() }
    }

    /// Finds the matches within a distance (m).
    pub(super) fn find(&mut self, view: &View, figure: &Figure, gate: f32) {
        self.see(view, figure);
        let depth = view.cells.first().map_or(1.0, |c| c.point.distance(view.eye()));
        let side = ((gate / view.cell_size(depth)).ceil() as usize).max(2);
        let (across, down) = (view.columns.div_ceil(side), view.rows.div_ceil(side));
        self.sort(side, across, down);
        let (mut explained, mut squares) = (0usize, 0.0);
        for cell in &view.cells {
            let (bc, br) = (cell.column as usize / side, cell.row as usize / side);
            let mut best = (gate * gate, u32::MAX);
            for r in br.saturating_sub(1)..(br + 2).min(down) {
                // The three buckets of a row lie one after the other.
                let from = self.start[r * across + bc.saturating_sub(1)] as usize;
                let to = self.start[r * across + (bc + 2).min(across)] as usize;
                for &i in &self.list[from..to] {
                    let off = figure.points[i as usize].distance_squared(cell.point);
                    if off < best.0 {
                        let alike = figure.normals[i as usize].dot(cell.normal);
                        if alike > ALIKE || cell.normal == Vec3::ZERO {
                            best = (off, i);
                        }
                    }
                }
            }
            if best.1 == u32::MAX {
                squares += gate * gate;
                continue;
            }
            let i = best.1 as usize;
            explained += 1;
            squares += (figure.points[i] - cell.point).dot(figure.normals[i]).powi(2);
            self.of[i].sum += cell.point;
            self.of[i].count += 1.0;
        }
        let n = view.cells.len().max(1) as f32;
        (self.explained, self.off) = (explained as f32 / n, squares / n);
    }

    /// Which samples face the camera, and where they are seen.
    fn see(&mut self, view: &View, figure: &Figure) {
        let eye = view.eye();
        for ((m, point), normal) in self.of.iter_mut().zip(&figure.points).zip(&figure.normals) {
            *m = Match::default();
            let sight = eye - *point;
            if normal.dot(sight) < FACING * sight.length() {
                continue;
            }
            if let Some((seen, z)) = view.project(*point)
                && view.place(seen).is_some()
            {
                (m.seen, m.z, m.faces) = (seen, z, true);
            }
        }
    }

    /// Sorts the facing samples into buckets of `side` cells.
    fn sort(&mut self, side: usize, across: usize, down: usize) {
        self.start.clear();
        self.start.resize(across * down + 1, 0);
        let bucket = |m: &Match| {
            let at = m.seen.round().max(Vec2::ZERO);
            (at.y as usize / side).min(down - 1) * across + (at.x as usize / side).min(across - 1)
        };
        for m in self.of.iter().filter(|m| m.faces) {
            self.start[bucket(m) + 1] += 1;
        }
        for b in 1..self.start.len() {
            self.start[b] += self.start[b - 1];
        }
        self.list.clear();
        self.list.resize(self.start[across * down] as usize, 0);
        let mut next = self.start.clone();
        for (i, m) in self.of.iter().enumerate().filter(|(_, m)| m.faces) {
            let b = bucket(m);
            self.list[next[b] as usize] = i as u32;
            next[b] += 1;
        }
    }
}
