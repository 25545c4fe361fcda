//! Scene before the cameras: a printed surface, the light on it, a shadow that moves, and an arm that passes before it.

use glam::{DMat3, DVec2, DVec3, Vec2};
use toile_sensors::calibration::{CalibratedCamera, CameraParameters};

use super::print::Print;

/// A surface with a print, in one moment.
#[derive(Debug, Clone, Copy)]
pub struct PrintedSurface<'a> {
    /// Positions (m, world) `[vertices]`.
    pub positions: &'a [DVec3],
    /// Where each lies on the print, 0 to 1 `[vertices]`.
    pub uvs: &'a [Vec2],
    /// Corners `[triangles]`.
    pub triangles: &'a [[u32; 3]],
    /// What is printed on it.
    pub print: &'a Print,
}

/// A cylinder with round ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bar {
    /// Its ends (m).
    pub ends: [DVec3; 2],
    /// Its radius (m).
    pub radius: f64,
}

/// The light of one moment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lighting {
    /// Towards the light, unit length.
    pub towards: DVec3,
    /// The part of the light that comes from all sides, 0 to 1.
    pub ambient: f32,
    /// A shadow: a band across the world's x that is darker by this factor around this place (m) within this half width (m), with
    /// an edge as wide again.
    pub shadow: Option<(f32, f64, f64)>,
}

impl Default for Lighting {
    fn default() -> Self {
        Self { towards: DVec3::new(0.3, 0.5, 0.8).normalize(), ambient: 0.7, shadow: None }
    }
}

impl Lighting {
    /// How bright a place is.
    pub(super) fn on(&self, at: DVec3, normal: DVec3) -> f32 {
        let lit = self.ambient + (1.0 - self.ambient) * normal.dot(self.towards).abs() as f32;
        let Some((factor, place, half)) = self.shadow else { return lit };
        let cover = (2.0 - (at.x - place).abs() / half).clamp(0.0, 1.0) as f32;
        lit * (1.0 - (1.0 - factor) * cover)
    }
}

impl Bar {
    /// Where a ray from `from` along `along` (unit length) first meets it, and the normal there.
    pub(super) fn hit(&self, from: DVec3, along: DVec3) -> Option<(f64, DVec3)> {
        // Nearest points of ray and axis give the hit to second order; refined by three Newton steps on the distance.
        let [a, b] = self.ends;
        let nearest = |p: DVec3| {
            let axis = b - a;
            a + axis * ((p - a).dot(axis) / axis.length_squared()).clamp(0.0, 1.0)
        };
        let mut t = (self.ends[0] - from).dot(along).min((self.ends[1] - from).dot(along)) - 4.0 * self.radius;
        // Sphere tracing: the distance to the surface is a step that passes nothing.
        for _ in 0..64 {
            let p = from + along * t;
            let n = p - nearest(p);
            let off = n.length() - self.radius;
            if off < 1e-4 {
                return Some((t, n.normalize()));
            }
            if off > 3.0 {
                return None;
            }
            t += off;
        }
        None
    }
}

/// A camera at a place that looks at another, its pictures' down away from `up`.
///
/// # Panics
/// Where the two places are one, or one above the other.
pub fn look_at(name: &str, size: [u32; 2], focal: f64, [from, to]: [DVec3; 2], up: DVec3) -> CalibratedCamera {
    let ahead = (to - from).normalize();
    let right = ahead.cross(up).normalize();
    let down = ahead.cross(right);
    let rotation = DMat3::from_cols(right, down, ahead).transpose();
    let middle = DVec2::new(f64::from(size[0]), f64::from(size[1])) / 2.0 - 0.5;
    let given = CameraParameters {
        size: size.map(f64::from),
        matrix: [[focal, 0.0, middle.x], [0.0, focal, middle.y], [0.0, 0.0, 1.0]],
        distortion: Vec::new(),
        rotation,
        translation: -(rotation * from),
    };
    CalibratedCamera::new(name, &given).expect("a camera that looks at a place is one")
}
