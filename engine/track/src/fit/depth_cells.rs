//! The shopper in one depth frame, averaged into cells of a few pixels: mean points with normals, and the outline.

use std::ops::Range;

use glam::{Affine3A, Vec2, Vec3};
use toile_base::frame::{DepthFrame, Intrinsics};

use super::rim::SurfaceMask;

/// A stretch of the shopper's outline, a cell long.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct RimCell {
    /// Its middle (cells).
    pub at: Vec2,
    /// Unit normal in the image, away from the shopper.
    pub out: Vec2,
    /// The cell of the surface that ends there.
    pub beside: u32,
}

/// Side of a cell on the shopper (m): a good tenth of a limb's breadth, and nine pixels of a Kinect at 2.5 m, which
/// bring its noise down to a third.
const CELL: f32 = 0.013;

/// Pixels of a cell farther than this behind its nearest belong to another surface (m).
const SAME_SURFACE: f32 = 0.05;

/// Least fraction of a cell's pixels that are valid.
const FILLED: f32 = 0.4;

/// A cell of measured surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct DepthCell {
    /// Mean of its points, world (m).
    pub point: Vec3,
    /// Normal towards the camera (unit), or zero where its neighbours give none.
    pub normal: Vec3,
    /// Column in the grid, from the left.
    pub column: u16,
    /// Row in the grid, from the top.
    pub row: u16,
}

/// Width of the border around the shopper in which nearest cells are known (cells): as far as samples are pulled in.
const BORDER: usize = 12;

/// Marks a place of the grid without a cell.
const NONE: u32 = u32::MAX;

/// One frame in cells.
#[derive(Debug)]
pub(super) struct DepthCells {
    /// The cells that have a surface.
    pub cells: Vec<DepthCell>,
    /// Columns of the grid.
    pub columns: usize,
    /// Rows of the grid.
    pub rows: usize,
    /// Side of a cell (pixels).
    step: usize,
    intrinsics: Intrinsics,
    world_to_camera: Affine3A,
    camera_to_world: Affine3A,
    /// Index into `cells` by place in the grid; [`NONE`] where there is none.
    at: Vec<u32>,
    /// The nearest place of the grid that has a cell `[columns x rows]`, valid within `reach`.
    nearest: Vec<[u16; 2]>,
    depth: Vec<f32>,
    /// The part of the grid that holds the shopper, and the same with [`BORDER`] around it.
    extent: CellRange,
    reach: CellRange,
    /// The outline, where nothing but background lies beyond it; empty until it is asked for.
    pub rim: Vec<RimCell>,
    mask: SurfaceMask,
}

/// A part of the grid: first and end of its columns and rows.
#[derive(Debug, Clone, Default, PartialEq)]
struct CellRange {
    columns: Range<usize>,
    rows: Range<usize>,
}

impl CellRange {
    fn widened(&self, by: usize, columns: usize, rows: usize) -> Self {
        let wider = |r: &Range<usize>, end: usize| r.start.saturating_sub(by)..(r.end + by).min(end);
        Self { columns: wider(&self.columns, columns), rows: wider(&self.rows, rows) }
    }
}

impl DepthCells {
    /// An empty grid.
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
            extent: CellRange::default(),
            reach: CellRange::default(),
            rim: Vec::new(),
            mask: SurfaceMask::default(),
        }
    }

    /// Reads a frame that holds nothing but the shopper. `false` if it has too few cells.
    pub(super) fn read(&mut self, frame: &DepthFrame) -> bool {
        self.intrinsics = frame.intrinsics;
        self.camera_to_world = frame.camera_to_world;
        self.world_to_camera = frame.camera_to_world.inverse();
        self.cells.clear();
        self.rim.clear();
        let Some(distance) = mean_depth(frame) else { return false };
        let pixel = distance / frame.intrinsics.fx.max(frame.intrinsics.fy);
        self.step = ((CELL / pixel).round() as usize).clamp(1, 16);
        self.columns = frame.intrinsics.width as usize / self.step;
        self.rows = frame.intrinsics.height as usize / self.step;
        self.extent = self.occupied(frame);
        self.reach = self.extent.widened(BORDER, self.columns, self.rows);
        self.read_cells(frame);
        self.read_normals();
        if self.cells.len() < FEWEST_CELLS {
            return false;
        }
        self.distance_transform();
        true
    }

    /// The part of the grid that holds anything.
    fn occupied(&self, frame: &DepthFrame) -> CellRange {
        let width = frame.intrinsics.width as usize;
        let mut any = vec![0u16; width];
        let mut rows: Option<Range<usize>> = None;
        for (v, row) in frame.depth_mm.chunks_exact(width).enumerate() {
            if row.iter().fold(0, |all, mm| all | mm) != 0 {
                any.iter_mut().zip(row).for_each(|(a, mm)| *a |= mm);
                rows = Some(rows.map_or(v, |r| r.start)..v + 1);
            }
        }
        let first = any.iter().position(|a| *a != 0).unwrap_or(0);
        let end = any.iter().rposition(|a| *a != 0).map_or(0, |u| u + 1);
        let cells = |pixels: Range<usize>, most: usize| {
            (pixels.start / self.step).min(most)..pixels.end.div_ceil(self.step).min(most)
        };
        CellRange { columns: cells(first..end, self.columns), rows: cells(rows.unwrap_or(0..0), self.rows) }
    }

    fn read_cells(&mut self, frame: &DepthFrame) {
        let width = frame.intrinsics.width as usize;
        let least = ((self.step * self.step) as f32 * FILLED).ceil() as u32;
        self.at.clear();
        self.at.resize(self.columns * self.rows, NONE);
        self.depth.clear();
        self.depth.resize(self.columns * self.rows, 0.0);
        for row in self.extent.rows.clone() {
            for column in self.extent.columns.clone() {
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
                self.cells.push(DepthCell { point, normal: Vec3::ZERO, column: column as u16, row: row as u16 });
            }
        }
    }

    fn read_normals(&mut self) {
        let (columns, rows) = (self.columns as isize, self.rows as isize);
        let camera = self.camera_position();
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
                self.cells[i].normal = if normal.dot(camera - self.cells[i].point) < 0.0 { -normal } else { normal };
            }
        }
    }

    /// Finds each place's nearest cell (Euclidean distance transform, Danielsson 1980, in two passes).
    fn distance_transform(&mut self) {
        let columns = self.columns;
        self.nearest.clear();
        self.nearest.resize(columns * self.rows, [u16::MAX; 2]);
        for cell in &self.cells {
            self.nearest[cell.row as usize * columns + cell.column as usize] = [cell.column, cell.row];
        }
        let CellRange { columns: across, rows: down } = self.reach.clone();
        let off = |near: [u16; 2], c: usize, r: usize| {
            if near[0] == u16::MAX {
                return u32::MAX;
            }
            let (dc, dr) = (near[0].abs_diff(c as u16) as u32, near[1].abs_diff(r as u16) as u32);
            dc * dc + dr * dr
        };
        let mut pass = |c: usize, r: usize, steps: [(isize, isize); 4]| {
            let here = r * columns + c;
            let mut best = (off(self.nearest[here], c, r), self.nearest[here]);
            for (dc, dr) in steps {
                let (c2, r2) = (c.wrapping_add_signed(dc), r.wrapping_add_signed(dr));
                if across.contains(&c2) && down.contains(&r2) {
                    let other = self.nearest[r2 * columns + c2];
                    let far = off(other, c, r);
                    if far < best.0 {
                        best = (far, other);
                    }
                }
            }
            self.nearest[here] = best.1;
        };
        for r in down.clone() {
            across.clone().for_each(|c| pass(c, r, [(-1, 0), (-1, -1), (0, -1), (1, -1)]));
            across.clone().rev().for_each(|c| pass(c, r, [(1, 0), (1, -1), (0, -1), (-1, -1)]));
        }
        for r in down.clone().rev() {
            across.clone().rev().for_each(|c| pass(c, r, [(1, 0), (1, 1), (0, 1), (-1, 1)]));
            across.clone().for_each(|c| pass(c, r, [(-1, 0), (-1, 1), (0, 1), (1, 1)]));
        }
    }

    /// Finds the outline of the frame that was read: stretches of it beyond which a gap of some cells lies, so that lost pixels make none.
    pub(super) fn read_rim(&mut self, frame: &DepthFrame) {
        let step = self.step;
        let CellRange { columns, rows } = self.extent.clone();
        let pixels = |cells: &Range<usize>| cells.start * step..cells.end * step;
        self.mask.read(&frame.depth_mm, frame.intrinsics.width as usize, [pixels(&columns), pixels(&rows)]);
        self.rim.clear();
        let half = 0.5 * (step as f32 - 1.0);
        for r in rows {
            for c in columns.clone() {
                let Some(point) = self.mask.stretch(pixels(&(c..c + 1)), pixels(&(r..r + 1))) else { continue };
                let at = (point.at - Vec2::splat(half)) / step as f32;
                let open = |by: f32| {
                    self.place(at + by * point.out).is_some_and(|(c, r)| self.at[r * self.columns + c] == NONE)
                };
                let near = self.nearest[r * self.columns + c];
                if GAP.into_iter().all(open) && near[0] != u16::MAX {
                    let beside = near[1] as usize * self.columns + near[0] as usize;
                    self.rim.push(RimCell { at, out: point.out, beside: self.at[beside] });
                }
            }
        }
    }

    /// A world direction as it lies in the image, not normalised: what of it points along the line of sight is left out.
    pub(super) fn in_image(&self, direction: Vec3) -> Vec2 {
        self.world_to_camera.transform_vector3(direction).truncate()
    }

    /// The direction in the world that an image direction has (unit for a unit).
    pub(super) fn in_world(&self, direction: Vec2) -> Vec3 {
        self.camera_to_world.transform_vector3(direction.extend(0.0))
    }

    /// Position of the camera, world (m).
    pub(super) fn camera_position(&self) -> Vec3 {
        self.camera_to_world.translation.into()
    }

    /// Projection of a world point (cells), and its depth (m).
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
        if self.at[r * self.columns + c] != NONE {
            return None;
        }
        // Beyond the border the nearest cell is that of the border's edge.
        let c = c.clamp(self.reach.columns.start, self.reach.columns.end - 1);
        let r = r.clamp(self.reach.rows.start, self.reach.rows.end - 1);
        let near = self.nearest[r * self.columns + c];
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

/// Distances beyond the outline at which there must be no surface (cells): two to four hands' breadths of a cell.
const GAP: [f32; 3] = [1.5, 2.5, 3.5];

/// Fewest cells of a person: a tenth of one at 4 m.
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
