//! Samples that each camera sees: before it, inside of its pictures, from the right side, and not hidden.

use glam::{DVec3, Vec3};
use toile_sensors::calibration::CalibratedCamera;

use super::patches::LevelSamples;
use crate::surface::CapturedSurface;
use toile_pose::depth_buffer::DepthBuffer;

/// Pixels of the depth buffer a pixel of the picture: half is enough to find what is hidden.
const SCALE: f64 = 0.5;

/// A sample is hidden where something lies this much nearer (m), besides what its slope over two pixels explains.
const NEARER: f64 = 2.5e-3;

/// Smoothing reaches so far (px of the level): what lies nearer to the surface's outline is mixed with what is behind it.
const SMOOTHED: f64 = 1.8;

/// Behind a sample, what is this much deeper (m) is not the surface around it, besides what its slope explains.
const DEEPER: f64 = 20e-3;

/// Least cosine of the angle between a triangle's normal and the view.
pub(super) const LEAST_FACING: f64 = 0.2;

/// What a camera sees of the surface as it lies.
#[derive(Debug, Clone)]
pub(super) struct Visibility {
    buffer: DepthBuffer,
    occlusion: bool,
    /// Cosine of the angle between each triangle's normal and the view, negative from behind `[triangles]`.
    pub facing: Vec<f64>,
}

impl Visibility {
    pub fn new(size: [u32; 2], triangles: usize) -> Self {
        Self { buffer: DepthBuffer::new(size, SCALE), occlusion: true, facing: vec![0.0; triangles] }
    }

    /// Looks at the surface at `x`; without `occlusion`, nothing is hidden.
    pub fn look(&mut self, camera: &CalibratedCamera, surface: &CapturedSurface, x: &[DVec3], occlusion: bool) {
        let from = camera.position();
        for (facing, t) in self.facing.iter_mut().zip(&surface.triangles) {
            let [a, b, c] = t.map(|v| x[v as usize]);
            let normal = (b - a).cross(c - a).normalize_or_zero();
            *facing = normal.dot((from - (a + b + c) / 3.0).normalize_or_zero());
        }
        self.occlusion = occlusion;
        if occlusion {
            self.buffer.draw(camera, x, &surface.triangles);
        } else {
            self.buffer.depth.fill(f32::INFINITY);
        }
    }

    /// Which samples of a level are seen: 1 or 0 `[samples]`; `size` is that of a pixel of the level (px of the picture).
    pub fn mask(
        &self,
        size: f64,
        camera: &CalibratedCamera,
        surface: &CapturedSurface,
        x: &[DVec3],
        level: &LevelSamples,
        mask: &mut [f32],
    ) {
        let [w, h] = camera.size.map(f64::from);
        let focal = camera.focal().x;
        for (t, corners) in surface.triangles.iter().enumerate() {
            let (from, to) = (level.starts[t], level.starts[t + 1]);
            let facing = self.facing[t].abs();
            if facing < LEAST_FACING {
                mask[from..to].fill(0.0);
                continue;
            }
            let [a, b, c] = corners.map(|v| camera.to_camera(x[v as usize]));
            let slope = (1.0 / (facing * facing) - 1.0).sqrt();
            for (m, share) in mask[from..to].iter_mut().zip(&level.shares[from..to]) {
                let p = weighted(*share, [a, b, c]);
                let pixel = p.truncate() / p.z * camera.focal() + camera.centre();
                let inside = p.z > 0.0 && pixel.x >= 0.0 && pixel.y >= 0.0 && pixel.x < w && pixel.y < h;
                let reach = 2.0 * slope * p.z / (focal * SCALE);
                let near = self.buffer.nearest_around((pixel + 0.5) * SCALE - 0.5);
                let nothing_before = p.z - NEARER - reach < f64::from(near);
                let around = (SMOOTHED * size * SCALE).max(1.0);
                let deeper = p.z + DEEPER + 0.5 * around * reach;
                let at = (pixel + 0.5) * SCALE - 0.5;
                let whole = !self.occlusion || self.buffer.goes_on(at, around, deeper);
                *m = if inside && nothing_before && whole { 1.0 } else { 0.0 };
            }
        }
    }
}

fn weighted(share: Vec3, [a, b, c]: [DVec3; 3]) -> DVec3 {
    a * f64::from(share.x) + b * f64::from(share.y) + c * f64::from(share.z)
}
