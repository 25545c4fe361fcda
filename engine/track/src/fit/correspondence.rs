//! Correspondences: the sample of the body that each depth cell shows, the nearest one that faces the camera as the
//! cell does.

use glam::{Vec2, Vec3};

use super::depth_cells::{DepthCell, DepthCells, RimCell};
use super::posed_body::{BodyModel, PosedBody};

/// Least cosine between the normals of a cell and of its sample.
const ALIKE: f32 = 0.35;

/// Least cosine between a sample's normal and the direction to the camera: a little beyond the horizon, so that cells at
/// the horizon find samples on either side.
const FACING: f32 = -0.1;

/// Least cosine between a cell's normal and the direction to the camera: seen more slantingly, a cell is a mean over too
/// long a stretch of surface.
const SLANTING: f32 = 0.25;

/// Greatest cosine between the normal of a sample of the rim and the direction to the camera.
const RIM_FACING: f32 = 0.3;

/// Least cosine between a rim sample's normal and that of the outline, both in the image.
const RIM_ALIKE: f32 = 0.7;

/// Greatest distance between the surface that ends at an outline and the sample that makes it (m).
const RIM_NEAR: f32 = 0.10;

/// What a sample that faces the camera costs beside its distance (cells for a cosine of 1): a trunk's surface that turns by
/// a tenth of a radian has come half a cell nearer to the outline.
const RIM_TURN: f32 = 10.0;

/// How far from an outline its samples are looked for (buckets).
const RIM_RINGS: usize = 4;

/// Side of the buckets into which samples are sorted, in cells.
const BUCKET: usize = 2;

/// No sample.
const NONE: u32 = u32::MAX;

/// The cells that correspond to one sample.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Correspondence {
    /// Sum of its cells' points, world (m).
    sum: Vec3,
    /// Number of its cells.
    pub count: f32,
    /// Its projection (cells); undefined if it does not face the camera.
    pub seen: Vec2,
    /// Its depth before the camera (m); undefined if it does not face the camera.
    pub z: f32,
    /// Whether it faces the camera and projects into the image.
    pub faces: bool,
    /// Cosine between its normal and the direction to the camera; undefined if it does not face the camera.
    facing: f32,
}

impl Correspondence {
    /// Mean of its cells' points (m).
    pub(super) fn mean(&self) -> Vec3 {
        self.sum / self.count
    }

    /// Distance of the body's surface outside that mean (m), along the normal.
    pub(super) fn outside(&self, point: Vec3, normal: Vec3) -> f32 {
        normal.dot(point - self.mean())
    }
}

/// The correspondences of one frame.
pub(super) struct Correspondences {
    /// The correspondence of each sample `[samples]`.
    pub of: Vec<Correspondence>,
    /// Fraction of the cells that have a sample.
    pub explained: f32,
    /// Mean square distance of cells from their samples' planes, that of unexplained cells counted as the gate (m2).
    pub off: f32,
    /// One cell in this many is used, and counts for all of them.
    pub every: usize,
    /// The sample of each cell, [`NONE`] without one `[cells]`.
    of_cell: Vec<u32>,
    /// Samples by bucket: where each bucket starts, and the list.
    start: Vec<u32>,
    list: Vec<u32>,
    /// Columns and rows of buckets.
    buckets: [usize; 2],
}

impl Correspondences {
    pub(super) fn new(samples: usize) -> Self {
        Self {
            of: vec![Correspondence::default(); samples],
            explained: 0.0,
            off: 0.0,
            every: 1,
            of_cell: Vec::new(),
            start: Vec::new(),
            list: Vec::new(),
            buckets: [0; 2],
        }
    }

    /// Finds the correspondences within a distance (m).
    pub(super) fn find(&mut self, view: &DepthCells, posed: &PosedBody, gate: f32) {
        self.project(view, posed);
        let (across, down) = (view.columns.div_ceil(BUCKET), view.rows.div_ceil(BUCKET));
        self.sort(across, down);
        self.buckets = [across, down];
        let camera = view.camera_position();
        let (mut explained, mut squares) = (0usize, 0.0);
        self.of_cell.clear();
        self.of_cell.resize(view.cells.len(), NONE);
        for (number, cell) in view.cells.iter().enumerate().step_by(self.every) {
            let Some(i) = self.nearest(view, posed, cell, gate, [across, down]) else {
                squares += gate * gate;
                continue;
            };
            explained += 1;
            self.of_cell[number] = i as u32;
            squares += (posed.points[i] - cell.point).dot(posed.normals[i]).powi(2);
            let slanting = cell.normal.dot((camera - cell.point).normalize_or_zero()) < SLANTING;
            if !slanting || cell.normal == Vec3::ZERO {
                let count = self.every as f32;
                self.of[i].sum += cell.point * count;
                self.of[i].count += count;
            }
        }
        let n = view.cells.len().div_ceil(self.every).max(1) as f32;
        (self.explained, self.off) = (explained as f32 / n, squares / n);
    }

    /// The sample nearest to a cell, in rings of buckets until no nearer one can come.
    fn nearest(
        &self,
        view: &DepthCells,
        posed: &PosedBody,
        cell: &DepthCell,
        gate: f32,
        [across, down]: [usize; 2],
    ) -> Option<usize> {
        let (bc, br) = (cell.column as usize / BUCKET, cell.row as usize / BUCKET);
        let width = BUCKET as f32 * view.cell_size(cell.point.distance(view.camera_position()));
        let rings = (gate / width).ceil() as usize;
        let mut best = (gate * gate, None);
        let mut look = |from: u32, to: u32| {
            for &i in &self.list[from as usize..to as usize] {
                let off = posed.points[i as usize].distance_squared(cell.point);
                let alike = || posed.normals[i as usize].dot(cell.normal) > ALIKE || cell.normal == Vec3::ZERO;
                if off < best.0 && alike() {
                    best = (off, Some(i as usize));
                }
            }
            best
        };
        for ring in 0..=rings {
            let (low, high) = (br.saturating_sub(ring), (br + ring).min(down - 1));
            let (left, right) = (bc.saturating_sub(ring), (bc + ring).min(across - 1));
            let mut found = (f32::MAX, None);
            for r in low..=high {
                let bucket = |c: usize| r * across + c;
                if r + ring == br || r == br + ring {
                    // A whole row of the ring: its buckets lie one after the other.
                    found = look(self.start[bucket(left)], self.start[bucket(right) + 1]);
                    continue;
                }
                if left + ring == bc {
                    found = look(self.start[bucket(left)], self.start[bucket(left) + 1]);
                }
                if right == bc + ring && ring > 0 {
                    found = look(self.start[bucket(right)], self.start[bucket(right) + 1]);
                }
            }
            if found.1.is_some() && found.0 < (ring as f32 * width).powi(2) {
                break;
            }
        }
        best.1
    }

    /// The sample of the body's own rim that belongs to a stretch of outline: beside it, with its normal, and where the
    /// surface turns away from the camera. An arm's outline is never the trunk's, before which it may lie.
    pub(super) fn rim_sample(
        &self,
        view: &DepthCells,
        (model, posed): (&BodyModel, &PosedBody),
        rim: &RimCell,
    ) -> Option<usize> {
        let beside = *self.of_cell.get(rim.beside as usize).filter(|s| **s != NONE)?;
        let arm = model.samples[beside as usize].arm;
        let ends = view.cells[rim.beside as usize].point;
        let [across, down] = self.buckets;
        let cell = |x: f32, most: usize| ((x / BUCKET as f32).round().max(0.0) as usize).min(most.saturating_sub(1));
        let (bc, br) = (cell(rim.at.x, across), cell(rim.at.y, down));
        let mut best = (f32::MAX, None);
        for r in br.saturating_sub(RIM_RINGS)..=(br + RIM_RINGS).min(down.saturating_sub(1)) {
            let row = r * across;
            let (left, right) = (bc.saturating_sub(RIM_RINGS), (bc + RIM_RINGS).min(across - 1));
            for &i in &self.list[self.start[row + left] as usize..self.start[row + right + 1] as usize] {
                let m = &self.of[i as usize];
                let near = posed.points[i as usize].distance_squared(ends) < RIM_NEAR * RIM_NEAR;
                if m.facing > RIM_FACING || !near || model.samples[i as usize].arm != arm {
                    continue;
                }
                let off = m.seen - rim.at;
                let (out, beside) = (off.dot(rim.out), off.perp_dot(rim.out));
                let cost = (2.0 * beside).powi(2) + (0.25 * out).powi(2) + (RIM_TURN * m.facing).powi(2);
                if cost < best.0 && view.in_image(posed.normals[i as usize]).dot(rim.out) > RIM_ALIKE {
                    best = (cost, Some(i as usize));
                }
            }
        }
        best.1
    }

    /// Finds the samples that face the camera, and projects them.
    fn project(&mut self, view: &DepthCells, posed: &PosedBody) {
        let camera = view.camera_position();
        for ((m, point), normal) in self.of.iter_mut().zip(&posed.points).zip(&posed.normals) {
            *m = Correspondence::default();
            let to_camera = camera - *point;
            let facing = normal.dot(to_camera) / to_camera.length();
            if facing < FACING {
                continue;
            }
            if let Some((seen, z)) = view.project(*point)
                && view.place(seen).is_some()
            {
                (m.seen, m.z, m.faces, m.facing) = (seen, z, true, facing);
            }
        }
    }

    /// Sorts the facing samples into buckets.
    fn sort(&mut self, across: usize, down: usize) {
        self.start.clear();
        self.start.resize(across * down + 1, 0);
        let bucket = |m: &Correspondence| {
            let at = m.seen.round().max(Vec2::ZERO);
            (at.y as usize / BUCKET).min(down - 1) * across + (at.x as usize / BUCKET).min(across - 1)
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
