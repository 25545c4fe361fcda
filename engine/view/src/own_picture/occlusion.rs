//! Finds the parts of the shopper in front of the garment: by depth where it was measured, elsewhere by the fitted body and the
//! odds of a person.

use glam::{Affine3A, Vec2};
use toile_base::frame::{DepthFrame, Intrinsics};
use toile_sensors::colour_camera::ColourCamera;
use toile_sensors::person_mask::PersonMask;

/// What is measured so much before the cloth, and is no part of the body that is known to lie there, lies before it (m, and m at 1 m, which
/// grow with the square of the distance as a sensor's noise does): less may be own clothes, or noise.
const BEFORE_M: f32 = 0.03;
const BEFORE_GROWS: f32 = 0.004;

/// The same where the fitted body lies under the garment: own clothes are up to so thick (m).
const THICK_M: f32 = 0.08;

/// A part of the body that is measured so near to where it was fitted is there (m).
const THERE_M: f32 = 0.10;

/// Odds of a person from which a part of the fitted body is there, where there is no depth.
const LEAST_ODDS: f32 = 0.35;

/// Poses of two cameras that differ by less are one.
const SAME: f32 = 1e-5;

/// The body at a pixel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BodyThere {
    /// Its distance along the camera's z, farther off by the recess where it is under a garment (m).
    pub z: f32,
    /// Whether a garment covers it.
    pub is_covered: bool,
}

/// Depth in a colour camera's view.
#[derive(Debug, Clone, Default)]
pub struct DepthInPicture {
    /// Distance along the colour camera's z (m), 0 where nothing was measured `[width * height]`.
    z: Vec<f32>,
    size: [u32; 2],
    /// Pixels of the picture across one of these.
    scale: f32,
}

impl DepthInPicture {
    /// Takes a depth image, or none.
    pub fn take(&mut self, depth: Option<&DepthFrame>, camera: &ColourCamera) {
        let Some(depth) = depth.filter(|d| d.depth_mm.len() == d.intrinsics.pixels()) else {
            self.size = [0; 2];
            return;
        };
        let (d, k) = (depth.intrinsics, camera.intrinsics);
        let apart = camera.camera_to_world.inverse() * depth.camera_to_world;
        let one = apart.abs_diff_eq(Affine3A::IDENTITY, SAME) && camera.lens.is_none() && alike(&d, &k);
        self.size = [d.width, d.height];
        self.scale = k.width as f32 / d.width.max(1) as f32;
        self.z.clear();
        if one {
            self.z.extend(depth.depth_mm.iter().map(|mm| f32::from(*mm) * 1e-3));
            return;
        }
        self.z.resize(d.pixels(), 0.0);
        for (at, mm) in depth.depth_mm.iter().enumerate().filter(|(_, mm)| **mm > 0) {
            let (u, v) = ((at % d.width as usize) as f32, (at / d.width as usize) as f32);
            let p = apart.transform_point3(d.unproject(u, v, f32::from(*mm) * 1e-3));
            let Some(seen) = camera.project(p) else { continue };
            self.splat((seen + 0.5) / self.scale - 0.5, p.z);
        }
    }

    /// The nearest of what falls on a pixel and its neighbours to the right and below counts, so that no holes are left.
    fn splat(&mut self, at: Vec2, z: f32) {
        let [width, height] = self.size;
        for (dx, dy) in [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)] {
            let (x, y) = ((at.x + dx).floor(), (at.y + dy).floor());
            if x >= 0.0 && y >= 0.0 && x < width as f32 && y < height as f32 {
                let pixel = &mut self.z[y as usize * width as usize + x as usize];
                *pixel = if *pixel == 0.0 { z } else { pixel.min(z) };
            }
        }
    }

    /// Distance along the camera's z at a pixel of the picture (m).
    pub fn at(&self, pixel: Vec2) -> Option<f32> {
        let at = (pixel + 0.5) / self.scale.max(1e-6);
        let [width, height] = self.size;
        if !(at.x >= 0.0 && at.y >= 0.0 && at.x < width as f32 && at.y < height as f32) {
            return None;
        }
        let z = self.z[at.y as usize * width as usize + at.x as usize];
        (z > 0.0).then_some(z)
    }
}

/// Whether a depth image shows what the picture shows, pixel for pixel but for its size.
fn alike(d: &Intrinsics, k: &Intrinsics) -> bool {
    let scale = k.width as f32 / d.width.max(1) as f32;
    let near = |a: f32, b: f32| (a - b).abs() < 0.5;
    near(d.fx * scale, k.fx)
        && near(d.fy * scale, k.fy)
        && near((d.cx + 0.5) * scale - 0.5, k.cx)
        && near((d.cy + 0.5) * scale - 0.5, k.cy)
}

/// Whether something lies before cloth at a distance `cloth` (m) at a pixel of the picture.
pub fn is_before(
    pixel: Vec2,
    cloth: f32,
    body: Option<BodyThere>,
    depth: &DepthInPicture,
    mask: Option<&PersonMask>,
) -> bool {
    let fitted_before = body.is_some_and(|b| b.z < cloth);
    if let Some(measured) = depth.at(pixel) {
        return match body {
            // A bare part of the body that was fitted there: it is there if what was measured is nearer to it than to the cloth.
            Some(b) if !b.is_covered && (measured - b.z).abs() < THERE_M => {
                (fitted_before && measured < 0.5 * (b.z + cloth)) || measured < cloth - THERE_M
            }
            Some(b) if b.is_covered => measured < cloth - THICK_M - BEFORE_GROWS * measured * measured,
            _ => measured < cloth - BEFORE_M - BEFORE_GROWS * measured * measured,
        };
    }
    fitted_before && mask.and_then(|mask| mask.at(pixel)).is_none_or(|odds| odds >= LEAST_ODDS)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    fn camera() -> ColourCamera {
        let intrinsics = Intrinsics { width: 64, height: 48, fx: 55.0, fy: 55.0, cx: 31.5, cy: 23.5 };
        ColourCamera::pinhole(intrinsics, Affine3A::from_translation(Vec3::Y))
    }

    fn frame(camera_to_world: Affine3A, mm: u16) -> DepthFrame {
        let intrinsics = Intrinsics { width: 32, height: 24, fx: 27.5, fy: 27.5, cx: 15.5, cy: 11.5 };
        DepthFrame { time_ns: 0, intrinsics, camera_to_world, depth_mm: vec![mm; 32 * 24].into() }
    }

    #[test]
    fn depth_of_another_camera_is_seen_from_the_pictures() {
        let (mut depth, camera) = (DepthInPicture::default(), camera());
        let middle = Vec2::new(31.5, 23.5);
        depth.take(Some(&frame(camera.camera_to_world, 2000)), &camera);
        assert_eq!(depth.at(middle), Some(2.0));
        // 25 mm beside the picture's camera and 100 mm behind it.
        let beside = camera.camera_to_world * Affine3A::from_translation(Vec3::new(0.025, 0.0, -0.1));
        depth.take(Some(&frame(beside, 2000)), &camera);
        assert!((depth.at(middle).unwrap() - 1.9).abs() < 1e-5);
        assert_eq!(depth.at(Vec2::new(-3.0, 5.0)), None);
        depth.take(None, &camera);
        assert_eq!(depth.at(middle), None);
    }

    #[test]
    fn arms_before_the_garment_hide_it_and_own_clothes_under_it_do_not() {
        let (mut depth, camera) = (DepthInPicture::default(), camera());
        let at = Vec2::new(31.5, 23.5);
        let arm = |z| Some(BodyThere { z, is_covered: false });
        let trunk = |z| Some(BodyThere { z, is_covered: true });
        // By the body alone; without a body there is no arm.
        assert!(is_before(at, 2.0, arm(1.95), &depth, None));
        assert!(!is_before(at, 2.0, arm(2.05), &depth, None) && !is_before(at, 2.0, None, &depth, None));
        let mask =
            |odds| PersonMask { side: 1, odds: vec![odds], from_picture: glam::Affine2::from_scale(Vec2::splat(0.01)) };
        assert!(is_before(at, 2.0, arm(1.95), &depth, Some(&mask(0.9))));
        assert!(!is_before(at, 2.0, arm(1.95), &depth, Some(&mask(0.1))));
        // By depth: an arm where it was fitted, one where none was fitted, a coat under the garment, an arm that is not there.
        depth.take(Some(&frame(camera.camera_to_world, 1960)), &camera);
        assert!(is_before(at, 2.0, arm(1.95), &depth, None));
        assert!(!is_before(at, 2.0, trunk(2.03), &depth, None));
        depth.take(Some(&frame(camera.camera_to_world, 1850)), &camera);
        assert!(is_before(at, 2.0, None, &depth, None) && is_before(at, 2.0, trunk(2.03), &depth, None));
        depth.take(Some(&frame(camera.camera_to_world, 2300)), &camera);
        assert!(!is_before(at, 2.0, arm(1.95), &depth, None));
    }
}
