//! The rays of a camera, made once: what a lens bends is made straight step by step, which is too dear for every place of every picture.

use glam::{Vec2, Vec3};
use toile_base::frame::Intrinsics;
use toile_sensors::colour_camera::ColourCamera;
use toile_sensors::lens::BrownConrady;

/// Pixels of the picture between two rays. Between them a wide lens (k1 = -0.3) is wrong by less than 0.3 mm at 2.4 m.
const STEP: u32 = 8;

/// Rays at places of a camera's picture.
#[derive(Debug, Clone, Default)]
pub struct Rays {
    made_for: Option<(Intrinsics, BrownConrady)>,
    /// At distance 1 along the camera's z, in its axes, rows from the top; empty for a pinhole, which bends nothing.
    rays: Vec<Vec2>,
    size: [usize; 2],
}

impl Rays {
    /// Makes them, where it is another camera than before.
    pub fn make(&mut self, camera: &ColourCamera) {
        let asked = camera.lens.map(|lens| (camera.intrinsics, lens));
        if self.made_for == asked {
            return;
        }
        self.made_for = asked;
        let k = &camera.intrinsics;
        let [across, down] = [k.width, k.height].map(|n| (n / STEP + 2) as usize);
        self.size = [across, down];
        self.rays.clear();
        if asked.is_some() {
            let pixel = |i: usize| Vec2::new((i % across) as f32, (i / across) as f32) * STEP as f32;
            self.rays.extend((0..across * down).map(|i| camera.ray(pixel(i)).truncate()));
        }
    }

    /// The ray at a pixel of the picture of the camera they were made for, at distance 1 along its z, in its axes.
    pub fn at(&self, camera: &ColourCamera, pixel: Vec2) -> Vec3 {
        if self.rays.is_empty() {
            return camera.ray(pixel);
        }
        let place = pixel / STEP as f32;
        // Beside the picture it goes on as it ends.
        let cell = |x: f32, n: usize| (x as usize).min(n - 2);
        let (x, y) = (cell(place.x, self.size[0]), cell(place.y, self.size[1]));
        let part = place - Vec2::new(x as f32, y as f32);
        let of = |x: usize, y: usize| self.rays[y * self.size[0] + x];
        let between = |y: usize| of(x, y).lerp(of(x + 1, y), part.x);
        between(y).lerp(between(y + 1), part.y).extend(1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Affine3A;

    #[test]
    fn between_two_places_a_ray_is_the_lens_own() {
        let intrinsics = Intrinsics { width: 640, height: 480, fx: 557.0, fy: 557.0, cx: 319.5, cy: 239.5 };
        let lens = BrownConrady {
            k: [-0.3, 0.08, 0.0, 0.0, 0.0, 0.0],
            p: [0.001, -0.0005],
            centre: [0.0; 2],
            widest: f32::INFINITY,
        };
        let mut rays = Rays::default();
        for lens in [Some(lens), None, Some(BrownConrady { k: [0.1; 6], ..lens })] {
            let camera = ColourCamera { lens, ..ColourCamera::pinhole(intrinsics, Affine3A::IDENTITY) };
            rays.make(&camera);
            for i in 0..1_000_u32 {
                let pixel = Vec2::new((i * 97 % 6_400) as f32, (i * 331 % 4_800) as f32) / 10.0;
                let off = rays.at(&camera, pixel).distance(camera.ray(pixel));
                assert!(off < 1e-4, "{pixel}: {off}");
            }
        }
    }
}
