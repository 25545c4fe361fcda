//! The frame in cells of a few pixels, each with the depth of its nearest pixel and its place above the floor.

use glam::{Vec2, Vec3};

use super::floor::{Floor, sigma};
use toile_base::frame::{DepthFrame, Intrinsics};

/// The image is searched in cells so that about this many stand side by side: a finger at 1 m, a wrist at 4 m.
const CELLS_ACROSS: usize = 320;

/// Nearer than this a depth camera measures nothing that is a body (mm).
const NEAREST_MM: u16 = 300;

/// Lower than this, and than three deviations of the floor's noise, is floor (m).
const CLEARANCE: f32 = 0.015;

/// What was shopper a frame ago stays it at this fraction of the clearance, and across jumps larger by its inverse.
const HYSTERESIS: f32 = 0.6;

/// Largest difference in depth between neighbours on one surface at depth `z` (m): a fold of cloth, and the steps and
/// noise of a Kinect v1, which grow with the square of the distance.
pub fn same_surface(z: f32) -> f32 {
    0.05 + 0.01 * z * z
}

/// The cells of one frame. A cell is named by its index, row by row.
#[derive(Debug, Clone, Default)]
pub(super) struct Grid {
    camera: Option<Intrinsics>,
    /// Pixels along a cell's side.
    step: usize,
    pub columns: usize,
    pub rows: usize,
    /// Depth of the nearest pixel (m), 0 for nothing `[cells]`.
    pub depth: Vec<f32>,
    /// Height above the floor (m) `[cells]`; written by `stand`.
    pub height: Vec<f32>,
    /// Whether the cell was the shopper's in the frame before `[cells]`.
    pub before: Vec<bool>,
    axes: Axes,
}

/// Up, to the right and ahead of the camera along the floor, in camera axes; and the camera's height.
#[derive(Debug, Clone, Copy, Default)]
struct Axes {
    up: Vec3,
    right: Vec3,
    ahead: Vec3,
    height: f32,
    /// Whether a floor was seen, and what lies on it is to go.
    has_floor: bool,
}

impl Grid {
    /// Takes a frame. Another size of image, or a focal length, begins anew.
    pub fn load(&mut self, frame: &DepthFrame) {
        let k = frame.intrinsics;
        let (width, height) = (k.width as usize, k.height as usize);
        self.step = (width.max(height) / CELLS_ACROSS).max(1);
        (self.columns, self.rows) = (width / self.step, height / self.step);
        let cells = self.columns * self.rows;
        if self.camera != Some(k) {
            self.camera = Some(k);
            self.before.clear();
        }
        self.depth.resize(cells, 0.0);
        self.height.resize(cells, 0.0);
        self.before.resize(cells, false);
        for row in 0..self.rows {
            for column in 0..self.columns {
                self.depth[row * self.columns + column] = self.nearest(frame, row, column);
            }
        }
    }

    fn nearest(&self, frame: &DepthFrame, row: usize, column: usize) -> f32 {
        let width = frame.intrinsics.width as usize;
        let mut nearest = u16::MAX;
        for v in row * self.step..(row + 1) * self.step {
            let start = v * width + column * self.step;
            for &mm in &frame.depth_mm[start..start + self.step] {
                if mm >= NEAREST_MM {
                    nearest = nearest.min(mm);
                }
            }
        }
        if nearest == u16::MAX { 0.0 } else { f32::from(nearest) * 1e-3 }
    }

    /// The ray of a cell's middle, camera axes, z = 1.
    pub fn ray(&self, cell: usize) -> Vec3 {
        let Some(k) = self.camera else { return Vec3::Z };
        let half = (self.step as f32 - 1.0) * 0.5;
        let (u, v) = ((cell % self.columns * self.step) as f32 + half, (cell / self.columns * self.step) as f32 + half);
        k.unproject(u, v, 1.0)
    }

    /// Position of a cell, camera axes (m).
    pub fn point(&self, cell: usize) -> Vec3 {
        self.ray(cell) * self.depth[cell]
    }

    /// Position of a cell along the floor (m): to the camera's right, ahead of it.
    pub fn place(&self, cell: usize) -> Vec2 {
        let p = self.point(cell);
        Vec2::new(p.dot(self.axes.right), p.dot(self.axes.ahead))
    }

    /// The surface that a cell shows (m2), as if it faced the camera.
    pub fn area(&self, cell: usize) -> f32 {
        let Some(k) = self.camera else { return 0.0 };
        let side = self.depth[cell] * self.step as f32;
        side * side / (k.fx * k.fy)
    }

    /// Takes the floor, computes heights above it, and empties the cells that show nothing but floor.
    pub fn stand(&mut self, floor: Floor, has_floor: bool) {
        let up = floor.up;
        // Looking straight down, the image's top is ahead.
        let ahead = (Vec3::Z - up * up.z).try_normalize().unwrap_or(Vec3::NEG_Y);
        self.axes = Axes { up, right: up.cross(ahead), ahead, height: floor.height, has_floor };
        // Camera x right, y down, z forward are right-handed, so up x ahead points to the left.
        self.axes.right = -self.axes.right;
        for cell in 0..self.depth.len() {
            let z = self.depth[cell];
            if z == 0.0 {
                continue;
            }
            let ray = self.ray(cell);
            let height = self.axes.up.dot(ray) * z + self.axes.height;
            self.height[cell] = height;
            if has_floor && height < self.clearance(ray, z, self.before[cell]) {
                self.depth[cell] = 0.0;
            }
        }
    }

    /// Height under which what is seen along a ray (z = 1) at a depth (m) is taken for floor (m).
    fn clearance(&self, ray: Vec3, z: f32, before: bool) -> f32 {
        let clearance = CLEARANCE + 3.0 * sigma(z) * self.axes.up.dot(ray).abs();
        if before { clearance * HYSTERESIS } else { clearance }
    }

    /// Whether two neighbouring cells show one surface.
    pub fn joined(&self, a: usize, b: usize) -> bool {
        let (za, zb) = (self.depth[a], self.depth[b]);
        let limit = same_surface(za.min(zb));
        let limit = if self.before[a] && self.before[b] { limit / HYSTERESIS } else { limit };
        zb > 0.0 && (za - zb).abs() < limit
    }

    /// The neighbours of a cell up to two steps away along rows and columns, so that a hole of one cell parts nothing.
    pub fn neighbours(&self, cell: usize) -> impl Iterator<Item = usize> + use<> {
        const STEPS: [(isize, isize); 8] = [(1, 0), (-1, 0), (0, 1), (0, -1), (2, 0), (-2, 0), (0, 2), (0, -2)];
        let (row, column, rows, columns) = (cell / self.columns, cell % self.columns, self.rows, self.columns);
        STEPS.into_iter().filter_map(move |(dx, dy)| {
            let (r, c) = (row.checked_add_signed(dy)?, column.checked_add_signed(dx)?);
            (r < rows && c < columns).then_some(r * columns + c)
        })
    }

    /// Marks the pixels of some cells: those on the cell's surface and above the floor.
    pub fn mask(&self, frame: &DepthFrame, cells: &[u32], mask: &mut [u8]) {
        let width = frame.intrinsics.width as usize;
        for &cell in cells {
            let cell = cell as usize;
            let (near, before) = (self.depth[cell], self.before[cell]);
            let far = near + same_surface(near);
            let low = self.axes.has_floor && self.height[cell] < 0.15;
            for v in cell / self.columns * self.step..(cell / self.columns + 1) * self.step {
                for u in cell % self.columns * self.step..(cell % self.columns + 1) * self.step {
                    let mm = frame.depth_mm[v * width + u];
                    let z = f32::from(mm) * 1e-3;
                    let on = mm >= NEAREST_MM && z <= far;
                    let floor = low && on && {
                        let ray = frame.intrinsics.unproject(u as f32, v as f32, 1.0);
                        self.axes.up.dot(ray) * z + self.axes.height < self.clearance(ray, z, before)
                    };
                    mask[v * width + u] = u8::from(on && !floor);
                }
            }
        }
    }

    /// Remembers the shopper's cells for the next frame.
    pub fn remember(&mut self, cells: &[u32]) {
        self.before.fill(false);
        for &cell in cells {
            self.before[cell as usize] = true;
        }
    }
}
