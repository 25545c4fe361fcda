//! The people in one depth frame, as world points: floor off, then connected pieces of surface that look like a person.

use glam::Vec3;
use toile_assets::numeric::statistics::quantile_of;
use toile_sensors::frame::{DepthFrame, Intrinsics};

/// Nearer than this a structured-light or time-of-flight camera sees nothing (m).
const NEAREST: f32 = 0.4;

/// Farther than this the Kinect's steps exceed 46 mm and a body has under 6,000 pixels (m).
pub const FARTHEST: f32 = 4.5;

/// Surface lower than this is floor and its noise: 26 mm of depth at 4 m, seen at a grazing angle (m).
const FLOOR_CLEARANCE: f32 = 0.03;

/// A floor reaches at least this far into the depth of the picture; a body cut at y = 0 does not (m).
const FLOOR_REACH: f32 = 0.6;

/// The picture is searched in cells so that about this many stand side by side.
const CELLS_ACROSS: usize = 320;

/// Smallest surface of a person worth measuring, half of what one sees from the waist up, and largest, twice that of a
/// large person with arms stretched (m2): walls are larger.
const AREA: std::ops::Range<f32> = 0.10..2.5;

/// Smallest and largest height of what is seen of a person (m).
const HEIGHT: [f32; 2] = [0.45, 2.4];

/// Largest width, arms stretched (m).
const WIDEST: f32 = 2.1;

/// Largest reach towards the camera, an arm stretched (m).
const DEEPEST: f32 = 1.3;

/// Breadths of head and chest that hold three quarters of their points (m).
const HEAD: std::ops::Range<f32> = 0.06..0.32;
const CHEST: std::ops::Range<f32> = 0.15..0.65;

/// One person, as the camera sees them.
#[derive(Debug, Clone, PartialEq)]
pub struct PersonCloud {
    /// Surface points, world (m).
    pub points: Vec<Vec3>,
    /// Pixel that each of them comes from, row by row from the top left.
    pub pixels: Vec<u32>,
    /// Distance between neighbouring points, across the view (m).
    pub pitch: f32,
    /// Median distance from the camera (m).
    pub distance: f32,
    /// Elevation of their highest point seen from the camera, above the horizontal (rad).
    pub elevation: f32,
    /// The picture's edge cuts the person off below.
    pub cut_below: bool,
}

impl PersonCloud {
    /// The frame that the cloud comes from with nothing in it but this person.
    pub fn alone(&self, frame: &DepthFrame) -> DepthFrame {
        let mut depth_mm = vec![0; frame.depth_mm.len()].into_boxed_slice();
        for &i in &self.pixels {
            depth_mm[i as usize] = frame.depth_mm[i as usize];
        }
        DepthFrame { depth_mm, ..frame.clone() }
    }
}

/// What one depth frame holds.
#[derive(Debug, Clone, PartialEq)]
pub struct PeopleInView {
    /// People, the nearest first.
    pub people: Vec<PersonCloud>,
    /// Distance of the nearest thing that would be a person but stands beyond [`FARTHEST`] (m).
    pub too_far: Option<f32>,
}

/// Finds the people of a frame.
pub fn find_people(frame: &DepthFrame) -> PeopleInView {
    let grid = DepthGrid::new(frame);
    let mut found = PeopleInView { people: Vec::new(), too_far: None };
    for piece in grid.pieces() {
        let Some(cloud) = grid.cloud(&piece) else { continue };
        if cloud.distance > FARTHEST {
            found.too_far = Some(found.too_far.map_or(cloud.distance, |d| d.min(cloud.distance)));
        } else {
            found.people.push(cloud);
        }
    }
    found.people.sort_by(|a, b| a.distance.total_cmp(&b.distance));
    found
}

/// The frame in cells of a few pixels, each with the depth of its nearest pixel (m), 0 where there is none or floor.
struct DepthGrid<'a> {
    frame: &'a DepthFrame,
    step: usize,
    columns: usize,
    rows: usize,
    depth: Vec<f32>,
}

impl<'a> DepthGrid<'a> {
    fn new(frame: &'a DepthFrame) -> Self {
        let Intrinsics { width, height, .. } = frame.intrinsics;
        let (width, height) = (width as usize, height as usize);
        let step = (width.max(height) / CELLS_ACROSS).max(1);
        let (columns, rows) = (width / step, height / step);
        let mut grid = Self { frame, step, columns, rows, depth: vec![0.0; columns * rows] };
        for row in 0..rows {
            for column in 0..columns {
                grid.depth[row * columns + column] = grid.nearest_in_cell(row, column);
            }
        }
        grid.remove_floor();
        grid
    }

    fn nearest_in_cell(&self, row: usize, column: usize) -> f32 {
        let width = self.frame.intrinsics.width as usize;
        let mut nearest = u16::MAX;
        for v in row * self.step..(row + 1) * self.step {
            let start = v * width + column * self.step;
            for &mm in &self.frame.depth_mm[start..start + self.step] {
                // 0 is nothing; one less than it wraps to the farthest.
                nearest = nearest.min(mm.wrapping_sub(1));
            }
        }
        let z = (f32::from(nearest) + 1.0) / 1000.0;
        if nearest == u16::MAX || z < NEAREST { 0.0 } else { z }
    }

    /// Pixels of a cell: column, row, depth (mm).
    fn pixels(&self, row: usize, column: usize) -> impl Iterator<Item = (usize, usize, u16)> + '_ {
        let width = self.frame.intrinsics.width as usize;
        (row * self.step..(row + 1) * self.step).flat_map(move |v| {
            (column * self.step..(column + 1) * self.step).map(move |u| (u, v, self.frame.depth_mm[v * width + u]))
        })
    }

    fn world(&self, u: f32, v: f32, z: f32) -> Vec3 {
        let k = &self.frame.intrinsics;
        self.frame.camera_to_world.transform_point3(Vec3::new((u - k.cx) / k.fx * z, (v - k.cy) / k.fy * z, z))
    }

    fn cell_world(&self, cell: usize) -> Vec3 {
        let half = (self.step as f32 - 1.0) * 0.5;
        let (u, v) = ((cell % self.columns * self.step) as f32, (cell / self.columns * self.step) as f32);
        self.world(u + half, v + half, self.depth[cell])
    }

    /// Takes the floor out, if there is one at y = 0: without a known pose of the camera a body may pass there.
    fn remove_floor(&mut self) {
        let valid: Vec<usize> = (0..self.depth.len()).filter(|&c| self.depth[c] > 0.0).collect();
        let height: Vec<f32> = valid.iter().map(|&c| self.cell_world(c).y).collect();
        let mut reach: Vec<f32> = valid
            .iter()
            .zip(&height)
            .filter(|&(_, &y)| y.abs() < FLOOR_CLEARANCE)
            .map(|(&c, _)| self.depth[c])
            .collect();
        reach.sort_unstable_by(f32::total_cmp);
        let n = reach.len();
        if n == 0 || reach[n * 19 / 20] - reach[n / 20] < FLOOR_REACH {
            return;
        }
        for (&cell, &y) in valid.iter().zip(&height) {
            if y < FLOOR_CLEARANCE {
                self.depth[cell] = 0.0;
            }
        }
    }

    /// Largest difference in depth between neighbours on one surface (m): a step of the sensor, which grows with the
    /// square of the distance, and a fold of cloth.
    fn same_surface(z: f32) -> f32 {
        0.05 + 0.01 * z * z
    }

    /// Connected pieces of surface, as lists of cells; a hole of one cell does not part a piece.
    fn pieces(&self) -> Vec<Vec<usize>> {
        const STEPS: [(isize, isize); 8] = [(1, 0), (-1, 0), (0, 1), (0, -1), (2, 0), (-2, 0), (0, 2), (0, -2)];
        let mut seen = vec![false; self.depth.len()];
        let mut pieces = Vec::new();
        for seed in 0..self.depth.len() {
            if seen[seed] || self.depth[seed] == 0.0 {
                continue;
            }
            seen[seed] = true;
            let mut piece = vec![seed];
            let mut next = 0;
            while next < piece.len() {
                let cell = piece[next];
                next += 1;
                let (row, column, z) = (cell / self.columns, cell % self.columns, self.depth[cell]);
                for (dx, dy) in STEPS {
                    let (Some(r), Some(c)) = (row.checked_add_signed(dy), column.checked_add_signed(dx)) else {
                        continue;
                    };
                    if r >= self.rows || c >= self.columns {
                        continue;
                    }
                    let other = r * self.columns + c;
                    let near = (self.depth[other] - z).abs() < Self::same_surface(z);
                    if !seen[other] && self.depth[other] > 0.0 && near {
                        seen[other] = true;
                        piece.push(other);
                    }
                }
            }
            pieces.push(piece);
        }
        pieces
    }

    /// The points of a piece, if it is as large as a person and shaped like one.
    fn cloud(&self, piece: &[usize]) -> Option<PersonCloud> {
        let focal = (self.frame.intrinsics.fx * self.frame.intrinsics.fy).sqrt();
        let side = self.step as f32 / focal;
        let area: f32 = piece.iter().map(|&c| (self.depth[c] * side).powi(2)).sum();
        if !AREA.contains(&area) {
            return None;
        }
        let cells: Vec<Vec3> = piece.iter().map(|&c| self.cell_world(c)).collect();
        if !looks_human(&cells) {
            return None;
        }
        let distance = quantile_of(piece.iter().map(|&c| self.depth[c]), 0.5)?;
        let (points, pixels) = self.points(piece);
        let [_, top] = extent(cells.iter().map(|p| p.y));
        let elevation = ((top - self.frame.camera_to_world.translation.y) / distance).atan();
        Some(PersonCloud {
            cut_below: self.cut_below(piece, &cells),
            pitch: distance / focal,
            distance,
            elevation,
            points,
            pixels,
        })
    }

    fn points(&self, piece: &[usize]) -> (Vec<Vec3>, Vec<u32>) {
        let width = self.frame.intrinsics.width as usize;
        let room = piece.len() * self.step * self.step;
        let (mut points, mut pixels) = (Vec::with_capacity(room), Vec::with_capacity(room));
        for &cell in piece {
            let near = self.depth[cell];
            for (u, v, mm) in self.pixels(cell / self.columns, cell % self.columns) {
                let z = f32::from(mm) / 1000.0;
                if mm != 0 && z - near < Self::same_surface(near) {
                    points.push(self.world(u as f32, v as f32, z));
                    pixels.push((v * width + u) as u32);
                }
            }
        }
        (points, pixels)
    }

    /// Whether the lowest part of a piece lies along the picture's edge.
    fn cut_below(&self, piece: &[usize], cells: &[Vec3]) -> bool {
        let [bottom, top] = extent(cells.iter().map(|p| p.y));
        let low = bottom + 0.04 * (top - bottom);
        let (mut lowest, mut at_edge) = (0, 0);
        for (&cell, _) in piece.iter().zip(cells).filter(|(_, p)| p.y < low) {
            let (row, column) = (cell / self.columns, cell % self.columns);
            lowest += 1;
            at_edge += usize::from(row < 2 || column < 2 || row + 2 >= self.rows || column + 2 >= self.columns);
        }
        at_edge * 5 > lowest
    }
}

/// The 1st and 99th percentile; zeros of nothing.
fn extent(values: impl Iterator<Item = f32>) -> [f32; 2] {
    let mut sorted: Vec<f32> = values.collect();
    sorted.sort_unstable_by(f32::total_cmp);
    match sorted.len() {
        0 => [0.0; 2],
        n => [sorted[(n - 1) / 100], sorted[n - 1 - (n - 1) / 100]],
    }
}

/// A person is upright, no wider than two arms, no deeper than one, and carries a head narrower than the chest.
fn looks_human(cells: &[Vec3]) -> bool {
    let [left, right] = extent(cells.iter().map(|p| p.x));
    let [bottom, top] = extent(cells.iter().map(|p| p.y));
    let [back, front] = extent(cells.iter().map(|p| p.z));
    if !(HEIGHT[0]..HEIGHT[1]).contains(&(top - bottom)) || right - left > WIDEST || front - back > DEEPEST {
        return false;
    }
    // Raised hands are higher than the head, so the head is sought above the middle of the lower half.
    let low = cells.iter().filter(|p| p.y < 0.5 * (bottom + top)).map(|p| p.x);
    let Some(axis) = quantile_of(low, 0.5) else { return false };
    let [_, crown] = extent(cells.iter().filter(|p| (p.x - axis).abs() < 0.13).map(|p| p.y));
    // Someone half hidden behind another has their axis elsewhere: then their highest point is their head.
    head_and_chest(cells, axis, crown) || head_and_chest(cells, axis, top)
}

/// Whether a head and a chest lie below a crown.
fn head_and_chest(cells: &[Vec3], axis: f32, crown: f32) -> bool {
    // Breadth that holds three quarters of a band's points around the axis.
    let core = |from: f32, to: f32, reach: f32| {
        let within = |p: &&Vec3| (from..to).contains(&(crown - p.y)) && (p.x - axis).abs() < reach;
        let mut xs: Vec<f32> = cells.iter().filter(within).map(|p| p.x).collect();
        xs.sort_unstable_by(f32::total_cmp);
        let n = xs.len();
        (n >= 8).then(|| xs[n * 7 / 8] - xs[n / 8])
    };
    match (core(0.02, 0.16, 0.25), core(0.30, 0.45, 0.35)) {
        (Some(head), Some(chest)) => HEAD.contains(&head) && CHEST.contains(&chest) && chest > head,
        _ => false,
    }
}
