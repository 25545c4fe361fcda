//! The shopper in one depth frame, in cells of a few pixels: mean points with normals, and the outline.

use glam::{Affine3A, Vec2, Vec3};
use toile_sensors::frame::{DepthFrame, Intrinsics};

/// Side of a cell on the shopper (m): a good tenth of a limb's breadth, and nine pixels of a Kinect at 2.5 m, which
/// bring its noise down to a third.
const CELL: f32 = 0.013;

/// Pixels of a cell farther than this behind its nearest belong to another surface (m).
const SAME_SURFACE: f32 = 0.05;

/// Share of a cell's pixels that must be there.
const FILLED: f32 = 0.4;

/// A cell of measured surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Cell {
    /// Mean of its points, world (m).
    pub point: Vec3,
    /// Normal towards the camera (unit), or zero where its neighbours give none.
    pub normal: Vec3,
    /// Its place in the grid.
    pub column: u16,
    /// Its place in the grid.
    pub row: u16,
}

/// Nothing there.
const NONE: u32 = u32::MAX;

/// One frame, seen in cells.
#[derive(Debug)]
pub(super) struct View {
    /// Cells of surface.
    pub cells: Vec<Cell>,
    /// Cells across and down.
    pub columns: usize,
    /// Cells across and down.
    pub rows: usize,
    /// Pixels of a cell's side.
    step: usize,
    intrinsics: Intrinsics,
    world_to_camera: Affine3A,
    camera_to_world: Affine3A,
    /// Which of `cells` stands at each place of the grid.
    at: Vec<u32>,
    /// The nearest place of the grid that has a cell.
    nearest: Vec<[u16; 2]>,
    depth: Vec<f32>,
}

impl View {
    /// Nothing seen yet.
    pub(super) fn new() -> Self {
        Self {
            cells: Vec::new(),
            columns: 0,
            rows: 0,
            step: 1,
            intrinsics: Intrinsics::KINECT_V1,
            world_to_camera: Affine3A::IDENTITY,
            camera_to_world: Affine3A::IDENTITY,
            at: Vec::new(),
            nearest: Vec::new(),
            depth: Vec::new(),
        }
    }

    /// Takes in a frame that holds nothing but the shopper. `false` if there is too little to see.
    pub(super) fn look(&mut self, frame: &DepthFrame) -> bool {
        self.intrinsics = frame.intrinsics;
        self.camera_to_world = frame.camera_to_world;
        self.world_to_camera = frame.camera_to_world.inverse();
        self.cells.clear();
        let Some(distance) = mean_depth(frame) else { return false };
        let pixel = distance / frame.intrinsics.fx.max(frame.intrinsics.fy);
        self.step = ((CELL / pixel).round() as usize).clamp(1, 16);
        self.columns = frame.intrinsics.width as usize / self.step;
        self.rows = frame.intrinsics.height as usize / self.step;
        self.read_cells(frame);
        self.read_normals();
        if self.cells.len() < FEWEST_CELLS {
            return false;
        }
        self.spread();
        true
    }

    fn read_cells(&mut self, frame: &DepthFrame) {
        let width = frame.intrinsics.width as usize;
        let least = ((self.step * self.step) as f32 * FILLED).ceil() as u32;
        self.at.clear();
        self.at.resize(self.columns * self.rows, NONE);
        self.depth.clear();
        self.depth.resize(self.columns * self.rows, 0.0);
        for row in 0..self.rows {
            for column in 0..self.columns {
                let block = |v: usize| {
                    let from = (row * self.step + v) * width + column * self.step;
                    &frame.depth_mm[from..from + self.step]
                };
                let Some(mean) = mean_surface(&block, self.step, least) else { continue };
                let z = mean[2] * 1e-3;
                let u = (column * self.step) as f32 + mean[0];
                let v = (row * self.step) as f32 + mean[1];
                let point = self.camera_to_world.transform_point3(self.intrinsics.unproject(u, v, z));
                self.at[row * self.columns + column] = self.cells.len() as u32;
                self.depth[row * self.columns + column] = z;
                self.cells.push(Cell { point, normal: Vec3::ZERO, column: column as u16, row: row as u16 });
            }
        }
    }

    fn read_normals(&mut self) {
        let (columns, rows) = (self.columns as isize, self.rows as isize);
        let eye = self.eye();
        for i in 0..self.cells.len() {
            let (c, r) = (self.cells[i].column as isize, self.cells[i].row as isize);
            let here = self.depth[(r * columns + c) as usize];
            let beside = |dc: isize, dr: isize| {
                let (c, r) = (c + dc, r + dr);
                if c < 0 || r < 0 || c >= columns || r >= rows {
                    return None;
                }
                let place = (r * columns + c) as usize;
                let near = self.at[place] != NONE && (self.depth[place] - here).abs() < SAME_SURFACE;
                near.then(|| self.cells[self.at[place] as usize].point)
            };
            let along = |a: Option<Vec3>, b: Option<Vec3>| match (a, b) {
                (Some(a), Some(b)) => Some(b - a),
                (Some(a), None) => Some(self.cells[i].point - a),
                (None, Some(b)) => Some(b - self.cells[i].point),
                (None, None) => None,
            };
            let across = along(beside(-1, 0), beside(1, 0));
            let down = along(beside(0, -1), beside(0, 1));
            if let (Some(across), Some(down)) = (across, down) {
                let normal = down.cross(across).normalize_or_zero();
                self.cells[i].normal = if normal.dot(eye - self.cells[i].point) < 0.0 { -normal } else { normal };
            }
        }
    }

    /// Finds each place's nearest cell (Danielsson 1980, in two passes).
    fn spread(&mut self) {
        let (columns, rows) = (self.columns, self.rows);
        self.nearest.clear();
        self.nearest.resize(columns * rows, [u16::MAX; 2]);
        for cell in &self.cells {
            self.nearest[cell.row as usize * columns + cell.column as usize] = [cell.column, cell.row];
        }
        let off = |near: [u16; 2], c: usize, r: usize| {
            if near[0] == u16::MAX {
                return u32::MAX;
            }
            let (dc, dr) = (near[0].abs_diff(c as u16) as u32, near[1].abs_diff(r as u16) as u32);
            dc * dc + dr * dr
        };
        let mut pass = |c: usize, r: usize, steps: [(isize, isize); 4]| {
            let here = r * columns + c;
            for (dc, dr) in steps {
                let (Some(c2), Some(r2)) = (c.checked_add_signed(dc), r.checked_add_signed(dr)) else { continue };
                if c2 < columns && r2 < rows {
                    let other = self.nearest[r2 * columns + c2];
                    if off(other, c, r) < off(self.nearest[here], c, r) {
                        self.nearest[here] = other;
                    }
                }
            }
        };
        for r in 0..rows {
            (0..columns).for_each(|c| pass(c, r, [(-1, 0), (-1, -1), (0, -1), (1, -1)]));
            (0..columns).rev().for_each(|c| pass(c, r, [(1, 0), (1, -1), (0, -1), (-1, -1)]));
        }
        for r in (0..rows).rev() {
            (0..columns).rev().for_each(|c| pass(c, r, [(1, 0), (1, 1), (0, 1), (-1, 1)]));
            (0..columns).for_each(|c| pass(c, r, [(-1, 0), (-1, 1), (0, 1), (1, 1)]));
        }
    }

    /// Where the camera stands (m).
    pub(super) fn eye(&self) -> Vec3 {
        self.camera_to_world.translation.into()
    }

    /// Place in the grid, in cells, at which a world point is seen, and its depth (m).
    pub(super) fn project(&self, point: Vec3) -> Option<(Vec2, f32)> {
        let p = self.world_to_camera.transform_point3(point);
        let (u, v) = self.intrinsics.project(p)?;
        let half = 0.5 * (self.step as f32 - 1.0);
        Some((Vec2::new(u - half, v - half) / self.step as f32, p.z))
    }

    /// The place of the grid, if it lies within.
    pub(super) fn place(&self, at: Vec2) -> Option<(usize, usize)> {
        let rounded = at.round();
        let inside =
            rounded.x >= 0.0 && rounded.y >= 0.0 && rounded.x < self.columns as f32 && rounded.y < self.rows as f32;
        inside.then_some((rounded.x as usize, rounded.y as usize))
    }

    /// How far outside of the outline a projected point lies (m) and in which direction (world, unit); `None` inside.
    pub(super) fn outside(&self, at: Vec2, z: f32) -> Option<(f32, Vec3)> {
        let (c, r) = self.place(at)?;
        let place = r * self.columns + c;
        if self.at[place] != NONE {
            return None;
        }
        let near = self.nearest[place];
        let off = at - Vec2::new(f32::from(near[0]), f32::from(near[1]));
        let size = Vec2::new(z / self.intrinsics.fx, z / self.intrinsics.fy) * self.step as f32;
        let off = off * size;
        let distance = off.length();
        let along = self.camera_to_world.transform_vector3(Vec3::new(off.x, off.y, 0.0)).normalize_or_zero();
        // The outline runs half a cell outside of the cell's middle.
        (distance > 0.0).then_some((distance - 0.5 * size.x, along))
    }

    /// Side of a cell at a depth (m).
    pub(super) fn cell_size(&self, z: f32) -> f32 {
        z * self.step as f32 / self.intrinsics.fx
    }
}

/// Fewer cells than this are no person: a tenth of one at 4 m.
const FEWEST_CELLS: usize = 200;

fn mean_depth(frame: &DepthFrame) -> Option<f32> {
    let (mut sum, mut count) = (0u64, 0u64);
    for &mm in frame.depth_mm.iter().step_by(7) {
        sum += u64::from(mm);
        count += u64::from(mm != 0);
    }
    (count > 0).then(|| sum as f32 / count as f32 * 1e-3)
}

/// Mean column, row and depth (mm) of the nearest surface in a block; `None` where too little is there.
fn mean_surface<'a>(block: &impl Fn(usize) -> &'a [u16], step: usize, least: u32) -> Option<[f32; 3]> {
    let nearest = (0..step).flat_map(|v| block(v).iter()).map(|mm| mm.wrapping_sub(1)).min()?;
    if nearest == u16::MAX {
        return None;
    }
    let farthest = u32::from(nearest) + (SAME_SURFACE * 1e3) as u32;
    let (mut sum, mut count) = ([0u32; 3], 0u32);
    for v in 0..step {
        for (u, &mm) in block(v).iter().enumerate() {
            if mm != 0 && u32::from(mm) <= farthest {
                sum = [sum[0] + u as u32, sum[1] + v as u32, sum[2] + u32::from(mm)];
                count += 1;
            }
        }
    }
    (count >= least.max(1)).then(|| sum.map(|s| s as f32 / count as f32))
}
