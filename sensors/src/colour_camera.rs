//! A colour camera: its lens and its pose. Everything drawn on its picture is projected through it.

use glam::{Affine3A, Mat3, Vec2, Vec3};

use crate::lens::BrownConrady;
use toile_base::frame::{Intrinsics, pose_fault};

/// Steps in which a bent ray is made straight: each is a tenth of the one before for lenses of phones and webcams.
const UNBEND_STEPS: usize = 8;

/// A lens whose model holds to no more than this radius of the normalised image is none: a view of 23 degrees.
const NARROWEST: f32 = 0.2;

/// A colour camera.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ColourCamera {
    /// Size, focal lengths and centre of its pictures (px).
    pub intrinsics: Intrinsics,
    /// How its lens bends straight lines; none is a pinhole.
    pub lens: Option<BrownConrady>,
    /// Camera to world (m): camera x right, y down, z forward.
    pub camera_to_world: Affine3A,
}

impl ColourCamera {
    /// A pinhole at a place.
    pub const fn pinhole(intrinsics: Intrinsics, camera_to_world: Affine3A) -> Self {
        Self { intrinsics, lens: None, camera_to_world }
    }

    /// One with a lens, in the axes of the depth camera beside it, of which a point p is at R p + t (m) in its own.
    pub fn beside(intrinsics: Intrinsics, lens: Option<BrownConrady>, rotation: Mat3, translation: Vec3) -> Self {
        // Beyond the radius to which the model holds it would fold what is outside of the picture into it.
        let lens = lens.map(|lens| BrownConrady { widest: lens.sound_radius(), ..lens });
        let camera_to_world = Affine3A::from_mat3_translation(rotation, translation).inverse();
        Self { intrinsics, lens, camera_to_world }
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

    /// Where a place in camera axes (m) is seen (px); none at or behind the lens, or outside of what the lens is known for.
    pub fn project(&self, p: Vec3) -> Option<Vec2> {
        if p.z <= 1e-3 {
            return None;
        }
        let straight = p.truncate() / p.z;
        let at = match &self.lens {
            None => straight,
            Some(lens) if straight.distance(Vec2::from(lens.centre)) > lens.widest => return None,
            Some(lens) => Vec2::from(lens.bend(straight.to_array())),
        };
        let k = &self.intrinsics;
        Some(Vec2::new(k.cx + k.fx * at.x, k.cy + k.fy * at.y))
    }

    /// The ray that is seen at a pixel, at distance 1 along the camera's z, in camera axes.
    pub fn ray(&self, pixel: Vec2) -> Vec3 {
        let k = &self.intrinsics;
        let bent = Vec2::new((pixel.x - k.cx) / k.fx, (pixel.y - k.cy) / k.fy);
        let mut at = bent;
        if let Some(lens) = &self.lens {
            for _ in 0..UNBEND_STEPS {
                at += bent - Vec2::from(lens.bend(at.to_array()));
            }
        }
        at.extend(1.0)
    }

    /// The fault of this camera, or `None`.
    pub fn fault(&self) -> Option<String> {
        let sound = |lens: &BrownConrady| {
            lens.k.iter().chain(&lens.p).chain(&lens.centre).all(|k| k.is_finite()) && lens.widest >= NARROWEST
        };
        let bent = self.lens.is_some_and(|lens| !sound(&lens));
        let lens = bent.then(|| "its lens bends lines as no lens does".to_owned());
        self.intrinsics.fault().or(lens).or_else(|| pose_fault(&self.camera_to_world))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn webcam() -> ColourCamera {
        let intrinsics = Intrinsics { width: 640, height: 480, fx: 557.0, fy: 557.0, cx: 319.5, cy: 239.5 };
        let lens = BrownConrady {
            k: [-0.12, 0.03, 0.0, 0.0, 0.0, 0.0],
            p: [0.001, -0.0005],
            centre: [0.0; 2],
            widest: f32::INFINITY,
        };
        ColourCamera::beside(intrinsics, Some(lens), Mat3::IDENTITY, Vec3::ZERO)
    }

    #[test]
    fn a_bent_ray_is_seen_where_it_came_from() {
        let camera = webcam();
        for pixel in [Vec2::new(319.5, 239.5), Vec2::new(20.0, 30.0), Vec2::new(600.0, 470.0)] {
            let seen = camera.project(camera.ray(pixel) * 2.3).unwrap();
            assert!(seen.distance(pixel) < 0.02, "{pixel} is seen at {seen}");
        }
        // This lens draws the corners inwards.
        let straight = ColourCamera { lens: None, ..camera };
        let corner = Vec3::new(0.5, 0.4, 1.0);
        let middle = Vec2::new(319.5, 239.5);
        let far = |camera: &ColourCamera| camera.project(corner).unwrap().distance(middle);
        assert!(far(&camera) < far(&straight) - 5.0);
        assert_eq!(camera.project(Vec3::NEG_Z), None);
    }

    #[test]
    fn a_lens_of_eight_numbers_folds_nothing_from_outside_into_the_picture() {
        // The colour lens of an Azure Kinect; its radial part is a fraction.
        let lens = BrownConrady {
            k: [0.330_121, -2.489_397, 1.453_671, 0.208_912, -2.302_915, 1.375_128],
            p: [-1.617_8e-4, -1.294_5e-4],
            centre: [0.0; 2],
            widest: f32::INFINITY,
        };
        let intrinsics = Intrinsics { width: 1280, height: 720, fx: 611.8, fy: 611.9, cx: 639.3, cy: 365.9 };
        let camera = ColourCamera::beside(intrinsics, Some(lens), Mat3::IDENTITY, Vec3::ZERO);
        assert_eq!(camera.fault(), None);
        for pixel in [Vec2::new(639.0, 365.0), Vec2::new(3.0, 5.0), Vec2::new(1270.0, 700.0)] {
            let seen = camera.project(camera.ray(pixel) * 1.7).unwrap();
            assert!(seen.distance(pixel) < 0.1, "{pixel} is seen at {seen}");
        }
        // Ever farther from the axis, nothing comes back into the picture once it left it.
        let mut outside = false;
        for step in 0..2_000 {
            let seen = camera.project(Vec3::new(step as f32 * 0.01, 0.0, 1.0));
            let inside = seen.is_some_and(|at| (0.0..1_280.0).contains(&at.x));
            assert!(!(outside && inside), "{step}: {seen:?}");
            outside |= !inside;
        }
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
        let lens = webcam().lens.unwrap();
        for k in [[f32::NAN; 6], [-1e9, 0.0, 0.0, 0.0, 0.0, 0.0]] {
            let bent =
                ColourCamera::beside(webcam().intrinsics, Some(BrownConrady { k, ..lens }), Mat3::IDENTITY, Vec3::ZERO);
            assert!(bent.fault().is_some(), "{k:?}");
        }
    }
}
