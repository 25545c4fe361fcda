//! How a colour camera sees the world: its lens, and where it stands. What is drawn on its picture is drawn through this.
//!
//! With x, y the coordinates of a ray at distance 1 and r2 = x x + y y, a lens that bends straight lines (Brown 1971) shows it at
//!
//! ```text
//! x' = x (1 + k1 r2 + k2 r2^2 + k3 r2^3) + 2 p1 x y + p2 (r2 + 2 x x)
//! y' = y (1 + k1 r2 + k2 r2^2 + k3 r2^3) + 2 p2 x y + p1 (r2 + 2 y y)
//! ```

use glam::{Affine3A, Vec2, Vec3};

use crate::frame::{Intrinsics, pose_fault};

/// Steps in which a bent ray is made straight: each is a tenth of the one before for lenses of phones and webcams.
const UNBEND_STEPS: usize = 8;

/// A colour camera.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ColourCamera {
    /// Size, focal lengths and centre of its pictures (px).
    pub intrinsics: Intrinsics,
    /// k1, k2, p1, p2, k3 of its lens; zeros of a pinhole.
    pub distortion: [f32; 5],
    /// Camera to world (m): camera x right, y down, z forward.
    pub camera_to_world: Affine3A,
}

impl ColourCamera {
    /// A pinhole at a place.
    pub const fn pinhole(intrinsics: Intrinsics, camera_to_world: Affine3A) -> Self {
        Self { intrinsics, distortion: [0.0; 5], camera_to_world }
    }

    /// The same for pictures of another size of the same view: its focal lengths and centre go with the width.
    pub fn scaled_to(&self, width: u32, height: u32) -> Self {
        let k = &self.intrinsics;
        let scale = width as f32 / k.width.max(1) as f32;
        // Another shape is cut, or has more, above and below.
        let cy = (k.cy + 0.5 - 0.5 * k.height as f32) * scale + 0.5 * height as f32 - 0.5;
        let cx = (k.cx + 0.5) * scale - 0.5;
        let intrinsics = Intrinsics { width, height, fx: k.fx * scale, fy: k.fy * scale, cx, cy };
        Self { intrinsics, ..*self }
    }

    /// Where a place in camera axes (m) is seen (px); none at or behind the lens.
    pub fn project(&self, p: Vec3) -> Option<Vec2> {
        if p.z <= 1e-3 {
            return None;
        }
        let at = self.bend(p.truncate() / p.z);
        let k = &self.intrinsics;
        Some(Vec2::new(k.cx + k.fx * at.x, k.cy + k.fy * at.y))
    }

    /// The ray that is seen at a pixel, at distance 1 along the camera's z, in camera axes.
    pub fn ray(&self, pixel: Vec2) -> Vec3 {
        let k = &self.intrinsics;
        let bent = Vec2::new((pixel.x - k.cx) / k.fx, (pixel.y - k.cy) / k.fy);
        let mut at = bent;
        if self.distortion != [0.0; 5] {
            for _ in 0..UNBEND_STEPS {
                at += bent - self.bend(at);
            }
        }
        at.extend(1.0)
    }

    fn bend(&self, at: Vec2) -> Vec2 {
        let [k1, k2, p1, p2, k3] = self.distortion;
        let r2 = at.length_squared();
        let radial = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3));
        let cross = 2.0 * at.x * at.y;
        Vec2::new(
            at.x * radial + p1 * cross + p2 * (r2 + 2.0 * at.x * at.x),
            at.y * radial + p2 * cross + p1 * (r2 + 2.0 * at.y * at.y),
        )
    }

    /// What is wrong with this camera, or `None`.
    pub fn fault(&self) -> Option<String> {
        let bent = self.distortion.iter().any(|k| !k.is_finite() || k.abs() > 10.0);
        let lens = bent.then(|| "its lens bends lines as no lens does".to_owned());
        self.intrinsics.fault().or(lens).or_else(|| pose_fault(&self.camera_to_world))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn webcam() -> ColourCamera {
        let intrinsics = Intrinsics { width: 640, height: 480, fx: 557.0, fy: 557.0, cx: 319.5, cy: 239.5 };
        ColourCamera {
            distortion: [-0.12, 0.03, 0.001, -0.0005, 0.0],
            ..ColourCamera::pinhole(intrinsics, Affine3A::IDENTITY)
        }
    }

    #[test]
    fn a_bent_ray_is_seen_where_it_came_from() {
        let camera = webcam();
        for pixel in [Vec2::new(319.5, 239.5), Vec2::new(20.0, 30.0), Vec2::new(600.0, 470.0)] {
            let seen = camera.project(camera.ray(pixel) * 2.3).unwrap();
            assert!(seen.distance(pixel) < 0.02, "{pixel} is seen at {seen}");
        }
        // This lens draws the corners inwards.
        let straight = ColourCamera { distortion: [0.0; 5], ..camera };
        let corner = Vec3::new(0.5, 0.4, 1.0);
        let middle = Vec2::new(319.5, 239.5);
        let far = |camera: &ColourCamera| camera.project(corner).unwrap().distance(middle);
        assert!(far(&camera) < far(&straight) - 5.0);
        assert_eq!(camera.project(Vec3::NEG_Z), None);
    }

    #[test]
    fn pictures_of_another_size_show_the_same_view() {
        let (small, point) = (webcam(), Vec3::new(0.3, -0.2, 2.0));
        let large = small.scaled_to(1280, 960);
        let (a, b) = (small.project(point).unwrap(), large.project(point).unwrap());
        assert!(((a + 0.5) * 2.0 - 0.5).distance(b) < 1e-3, "{a} {b}");
        // A wider shape of the same width has less above and below.
        let wide = small.scaled_to(640, 360).project(point).unwrap();
        assert!((wide - a - Vec2::new(0.0, -60.0)).length() < 1e-3);
    }

    #[test]
    fn absurd_lenses_are_named() {
        assert_eq!(webcam().fault(), None);
        assert!(ColourCamera { distortion: [f32::NAN; 5], ..webcam() }.fault().is_some());
    }
}
