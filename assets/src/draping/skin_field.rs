//! Distance from the skin of a body at rest: a grid of signed distances, and the nearest triangle by a walk.

use glam::Vec3;

use super::limits::{BAND_M, CELL_M};
use toile_base::body::Body;

/// No triangle is near.
const NONE: u32 = u32::MAX;

/// Signed distances to a body's skin (m), negative inside.
#[derive(Debug, Clone)]
pub struct SkinField {
    low: Vec3,
    size: [usize; 3],
    distance: Vec<f32>,
    nearest: Vec<u32>,
    /// Corners of the skin's triangles, and the unit normals there.
    triangles: Vec<[Vec3; 3]>,
    normals: Vec<[Vec3; 3]>,
}

/// A point of the skin.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SkinPoint {
    /// Index of the triangle.
    pub triangle: u32,
    /// Shares of its corners, which sum to 1.
    pub shares: Vec3,
    /// Signed distance of the place that was asked for (m), negative inside.
    pub distance: f32,
    /// Outward direction (unit).
    pub normal: Vec3,
}

impl SkinField {
    /// The field of a body at rest.
    pub fn new(body: &Body) -> Self {
        let mesh = &body.mesh;
        let triangles: Vec<[Vec3; 3]> = mesh.triangles.iter().map(|t| t.map(|v| mesh.positions[v as usize])).collect();
        let normals = mesh.triangles.iter().map(|t| t.map(|v| body.normals[v as usize])).collect();
        let margin = Vec3::splat(BAND_M + 2.0 * CELL_M);
        let low = mesh.positions.iter().copied().fold(Vec3::MAX, Vec3::min) - margin;
        let high = mesh.positions.iter().copied().fold(Vec3::MIN, Vec3::max) + margin;
        let size = ((high - low) / CELL_M).to_array().map(|n| n.ceil() as usize + 1);
        let count = size.iter().product();
        let mut field =
            Self { low, size, distance: vec![f32::MAX; count], nearest: vec![NONE; count], triangles, normals };
        (0..field.triangles.len()).for_each(|t| field.stamp(t));
        field.fill_inside();
        for i in 0..count {
            field.distance[i] = match field.nearest[i] {
                NONE => BAND_M,
                t => field.point_on(t as usize, field.centre(i)).distance.min(BAND_M),
            };
        }
        field
    }

    fn centre(&self, i: usize) -> Vec3 {
        let [nx, ny, _] = self.size;
        self.low + Vec3::new((i % nx) as f32, (i / nx % ny) as f32, (i / nx / ny) as f32) * CELL_M
    }

    fn index(&self, [x, y, z]: [usize; 3]) -> usize {
        (z * self.size[1] + y) * self.size[0] + x
    }

    /// Offers a triangle to the cells around it.
    fn stamp(&mut self, t: usize) {
        let corners = self.triangles[t];
        let cell = |p: Vec3| ((p - self.low) / CELL_M).to_array();
        let low = cell(corners[0].min(corners[1]).min(corners[2]) - BAND_M).map(|c| c.ceil().max(0.0) as usize);
        let high = cell(corners[0].max(corners[1]).max(corners[2]) + BAND_M).map(|c| c.floor() as usize);
        for z in low[2]..=high[2].min(self.size[2] - 1) {
            for y in low[1]..=high[1].min(self.size[1] - 1) {
                for x in low[0]..=high[0].min(self.size[0] - 1) {
                    let i = self.index([x, y, z]);
                    let p = self.centre(i);
                    let (closest, _) = closest(corners, p);
                    let square = closest.distance_squared(p);
                    if square < self.distance[i] && square < BAND_M * BAND_M {
                        self.distance[i] = square;
                        self.nearest[i] = t as u32;
                    }
                }
            }
        }
    }

    /// Gives cells deep inside the nearest triangle of a neighbour: what got there must find its way out.
    fn fill_inside(&mut self) {
        let [nx, ny, nz] = self.size;
        let steps = [1, nx, nx * ny];
        let mut outside = vec![false; self.nearest.len()];
        let mut open = vec![0usize];
        outside[0] = true;
        while let Some(i) = open.pop() {
            let at = [i % nx, i / nx % ny, i / nx / ny];
            for (axis, step) in steps.into_iter().enumerate() {
                let up = (at[axis] + 1 < [nx, ny, nz][axis]).then(|| i + step);
                let down = (at[axis] > 0).then(|| i - step);
                for j in [up, down].into_iter().flatten() {
                    if !outside[j] && self.nearest[j] == NONE {
                        outside[j] = true;
                        open.push(j);
                    }
                }
            }
        }
        let inside: Vec<usize> = (0..outside.len()).filter(|&i| !outside[i] && self.nearest[i] == NONE).collect();
        for forward in [true, false, true, false] {
            let mut visit = |i: usize| {
                for j in steps.into_iter().flat_map(|s| [i - s, i + s]) {
                    let t = self.nearest[j];
                    if t == NONE {
                        continue;
                    }
                    let p = self.centre(i);
                    let square = closest(self.triangles[t as usize], p).0.distance_squared(p);
                    if square < self.distance[i] {
                        self.distance[i] = square;
                        self.nearest[i] = t;
                    }
                }
            };
            if forward {
                inside.iter().for_each(|&i| visit(i));
            } else {
                inside.iter().rev().for_each(|&i| visit(i));
            }
        }
    }

    /// The point of a triangle that is nearest to a place.
    fn point_on(&self, t: usize, p: Vec3) -> SkinPoint {
        let (point, shares) = closest(self.triangles[t], p);
        let [a, b, c] = self.triangles[t];
        let own = (b - a).cross(c - a).normalize_or_zero();
        let inner = shares.min_element() > 1e-4;
        let [l, m, n] = self.normals[t];
        let smooth = (l * shares.x + m * shares.y + n * shares.z).normalize_or(own);
        let out = p - point;
        let side = if out.dot(if inner { own } else { smooth }) < 0.0 { -1.0 } else { 1.0 };
        let distance = out.length() * side;
        let normal = if distance.abs() > 1e-6 { out / distance } else { smooth };
        SkinPoint { triangle: t as u32, shares, distance, normal }
    }

    /// Signed distance and outward direction, by interpolation (m; unit). Beyond the band, the distance is [`BAND_M`].
    pub fn sample(&self, p: Vec3) -> (f32, Vec3) {
        let cell = (p - self.low) / CELL_M;
        let top = Vec3::from(self.size.map(|n| n as f32 - 2.0));
        if cell.min_element() < 0.0 || (top - cell).min_element() < 0.0 {
            return (BAND_M, Vec3::ZERO);
        }
        let base = cell.floor();
        let f = cell - base;
        let [nx, ny, _] = self.size;
        let i = self.index([base.x as usize, base.y as usize, base.z as usize]);
        let d = |dx: usize, dy: usize, dz: usize| self.distance[i + dx + dy * nx + dz * nx * ny];
        let along = |dy: usize, dz: usize| (d(0, dy, dz), d(1, dy, dz));
        let mix = |(a, b): (f32, f32), t: f32| a + (b - a) * t;
        let rows = [along(0, 0), along(1, 0), along(0, 1), along(1, 1)];
        let x = rows.map(|r| mix(r, f.x));
        let slope = rows.map(|r| r.1 - r.0);
        let y = [mix((x[0], x[1]), f.y), mix((x[2], x[3]), f.y)];
        let gradient = Vec3::new(
            mix((mix((slope[0], slope[1]), f.y), mix((slope[2], slope[3]), f.y)), f.z),
            mix((x[1] - x[0], x[3] - x[2]), f.z),
            y[1] - y[0],
        );
        (mix((y[0], y[1]), f.z), gradient.normalize_or_zero())
    }

    /// The nearest point of the skin, exactly: the best of the triangles that the cells around the place know. `None` beyond the band.
    pub fn nearest(&self, p: Vec3) -> Option<SkinPoint> {
        let cell = (p - self.low) / CELL_M;
        let top = Vec3::from(self.size.map(|n| n as f32 - 2.0));
        if cell.min_element() < 0.0 || (top - cell).min_element() < 0.0 {
            return None;
        }
        let base = cell.floor();
        let [nx, ny, _] = self.size;
        let i = self.index([base.x as usize, base.y as usize, base.z as usize]);
        let mut best: Option<SkinPoint> = None;
        for corner in 0..8 {
            let t = self.nearest[i + (corner & 1) + (corner >> 1 & 1) * nx + (corner >> 2) * nx * ny];
            if t != NONE {
                let found = self.point_on(t as usize, p);
                if best.is_none_or(|b| found.distance.abs() < b.distance.abs()) {
                    best = Some(found);
                }
            }
        }
        best
    }
}

/// The point of a triangle nearest to a place, and the shares of its corners (Ericson 2005, "Real-time collision detection", 5.1.5).
fn closest([a, b, c]: [Vec3; 3], p: Vec3) -> (Vec3, Vec3) {
    let (ab, ac, ap) = (b - a, c - a, p - a);
    let (d1, d2) = (ab.dot(ap), ac.dot(ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return (a, Vec3::X);
    }
    let bp = p - b;
    let (d3, d4) = (ab.dot(bp), ac.dot(bp));
    if d3 >= 0.0 && d4 <= d3 {
        return (b, Vec3::Y);
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        let t = d1 / (d1 - d3);
        return (a + ab * t, Vec3::new(1.0 - t, t, 0.0));
    }
    let cp = p - c;
    let (d5, d6) = (ab.dot(cp), ac.dot(cp));
    if d6 >= 0.0 && d5 <= d6 {
        return (c, Vec3::Z);
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        let t = d2 / (d2 - d6);
        return (a + ac * t, Vec3::new(1.0 - t, 0.0, t));
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 >= d3 && d5 >= d6 {
        let t = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return (b + (c - b) * t, Vec3::new(0.0, 1.0 - t, t));
    }
    let sum = (va + vb + vc).recip();
    let (v, w) = (vb * sum, vc * sum);
    (a + ab * v + ac * w, Vec3::new(1.0 - v - w, v, w))
}
