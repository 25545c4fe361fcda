//! Depth buffer of a surface in a camera: for each pixel the nearest triangle and its depth.

use glam::{DVec2, DVec3};
use toile_sensors::calibration::CalibratedCamera;

/// Nearest depth that is drawn (m).
const NEAREST: f64 = 0.02;

/// The nearest surface in each pixel of a camera, at `scale` pixels of it to one of the picture.
#[derive(Debug, Clone)]
pub struct DepthBuffer {
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Pixels of the buffer a pixel of the picture.
    pub scale: f64,
    /// Depth along the camera's axis (m); infinite where nothing is `[height x width]`.
    pub depth: Vec<f32>,
    /// The triangle that is seen `[height x width]`; [`u32::MAX`] where nothing is.
    pub triangle: Vec<u32>,
}

impl DepthBuffer {
    /// An empty buffer for pictures of a size.
    pub fn new(size: [u32; 2], scale: f64) -> Self {
        let [width, height] = size.map(|s| ((f64::from(s) * scale).ceil() as usize).max(1));
        let pixels = width * height;
        Self { width, height, scale, depth: vec![f32::INFINITY; pixels], triangle: vec![u32::MAX; pixels] }
    }

    /// Draws a surface as a camera whose lens bends nothing sees it.
    pub fn draw(&mut self, camera: &CalibratedCamera, positions: &[DVec3], triangles: &[[u32; 3]]) {
        self.depth.fill(f32::INFINITY);
        self.triangle.fill(u32::MAX);
        let seen: Vec<DVec3> = positions.iter().map(|p| self.project(camera, *p)).collect();
        for (t, corners) in triangles.iter().enumerate() {
            let [a, b, c] = corners.map(|v| seen[v as usize]);
            if a.z.min(b.z).min(c.z) > NEAREST {
                self.fill(t as u32, [a, b, c]);
            }
        }
    }

    /// Where a point is in the buffer (px), with its depth (m).
    pub fn project(&self, camera: &CalibratedCamera, point: DVec3) -> DVec3 {
        let p = camera.to_camera(point);
        let pixel = (p.truncate() / p.z * camera.focal() + camera.centre() + 0.5) * self.scale - 0.5;
        pixel.extend(p.z)
    }

    /// Depth 1/z is linear over the picture, so that it is interpolated and not z.
    fn fill(&mut self, t: u32, [a, b, c]: [DVec3; 3]) {
        let [pa, pb, pc] = [a, b, c].map(DVec3::truncate);
        let area = (pb - pa).perp_dot(pc - pa);
        if area.abs() < 1e-12 {
            return;
        }
        let low = pa.min(pb).min(pc).max(DVec2::ZERO).ceil();
        let high = pa.max(pb).max(pc).min(DVec2::new(self.width as f64 - 1.0, self.height as f64 - 1.0)).floor();
        if !(low.x <= high.x && low.y <= high.y) {
            return;
        }
        for y in low.y as usize..=high.y as usize {
            for x in low.x as usize..=high.x as usize {
                let p = DVec2::new(x as f64, y as f64);
                let wb = (p - pa).perp_dot(pc - pa) / area;
                let wc = (pb - pa).perp_dot(p - pa) / area;
                let wa = 1.0 - wb - wc;
                if wa >= 0.0 && wb >= 0.0 && wc >= 0.0 {
                    let z = (1.0 / (wa / a.z + wb / b.z + wc / c.z)) as f32;
                    let at = y * self.width + x;
                    if z < self.depth[at] {
                        (self.depth[at], self.triangle[at]) = (z, t);
                    }
                }
            }
        }
    }

    /// Whether a surface goes on around a point: whether something that is at most so much deeper (m) is seen in eight directions at a
    /// distance (px of the buffer).
    pub fn goes_on(&self, at: DVec2, reach: f64, depth: f64) -> bool {
        const DIAGONAL: f64 = std::f64::consts::FRAC_1_SQRT_2;
        const AROUND: [(f64, f64); 8] = [
            (1.0, 0.0),
            (-1.0, 0.0),
            (0.0, 1.0),
            (0.0, -1.0),
            (DIAGONAL, DIAGONAL),
            (-DIAGONAL, DIAGONAL),
            (DIAGONAL, -DIAGONAL),
            (-DIAGONAL, -DIAGONAL),
        ];
        AROUND.iter().all(|(x, y)| {
            // Half a pixel on, cut off: rounded, without a call for each.
            let p = at + DVec2::new(*x, *y) * reach + 0.5;
            let inside = p.x > 0.0 && p.y > 0.0 && p.x < self.width as f64 && p.y < self.height as f64;
            inside && f64::from(self.depth[p.y as usize * self.width + p.x as usize]) < depth
        })
    }

    /// The nearest depth in the pixel of a point and those around it (m).
    pub fn nearest_around(&self, at: DVec2) -> f32 {
        let (x, y) = ((at.x + 0.5).floor() as isize, (at.y + 0.5).floor() as isize);
        let (w, h) = (self.width as isize, self.height as isize);
        let mut nearest = f32::INFINITY;
        let columns = (x - 1).clamp(0, w) as usize..(x + 2).clamp(0, w) as usize;
        for row in (y - 1).clamp(0, h)..(y + 2).clamp(0, h) {
            let from = row as usize * self.width;
            for depth in &self.depth[from + columns.start..from + columns.end] {
                nearest = nearest.min(*depth);
            }
        }
        nearest
    }
}

#[cfg(test)]
mod tests {
    use glam::DMat3;
    use toile_sensors::calibration::CameraParameters;

    use super::*;

    /// A camera of 100 x 100 pixels, 1.5 m from the origin and a radian to the side.
    fn camera() -> CalibratedCamera {
        let from = 1.5 * DVec3::new(1f64.sin(), 0.0, 1f64.cos());
        let ahead = -from.normalize();
        let right = ahead.cross(DVec3::Y).normalize();
        let rotation = DMat3::from_cols(right, ahead.cross(right), ahead).transpose();
        let given = CameraParameters {
            size: [100.0; 2],
            matrix: [[140.0, 0.0, 49.5], [0.0, 140.0, 49.5], [0.0, 0.0, 1.0]],
            distortion: Vec::new(),
            rotation,
            translation: -(rotation * from),
        };
        CalibratedCamera::new("c", &given).expect("a camera that looks at a place is one")
    }

    #[test]
    fn what_lies_before_hides_what_lies_behind() {
        let camera = camera();
        let square = |z: f64, half: f64| {
            [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(x, y)| DVec3::new(x * half, y * half, z))
        };
        let positions: Vec<DVec3> = square(0.0, 0.5).into_iter().chain(square(0.3, 0.2)).collect();
        let triangles = [[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7]];
        let mut buffer = DepthBuffer::new([100, 100], 1.0);
        buffer.draw(&camera, &positions, &triangles);
        let of = |p: DVec3| {
            let at = buffer.project(&camera, p);
            buffer.triangle[at.y.round() as usize * 100 + at.x.round() as usize]
        };
        assert!(of(DVec3::new(0.02, 0.05, 0.3)) >= 2, "the small square is nearer to the camera");
        assert!(of(DVec3::new(0.4, 0.05, 0.0)) < 2);
        assert_eq!(buffer.triangle[0], u32::MAX);
    }
}
