//! One camera: lens and pose, from the world to a pixel and back.

use glam::{DMat3, DVec2, DVec3};

use super::parameters::CameraParameters;

/// Rounds of undoing the distortion: each leaves a hundredth of the error before with lenses that are not fisheyes.
const UNDISTORT_ROUNDS: usize = 10;

/// Nearest that a point may lie before a camera and be seen (m).
const NEAREST: f64 = 1e-3;

/// The cameras of one recording.
#[derive(Debug, Clone, PartialEq)]
pub struct Rig {
    /// In the order of their names.
    pub cameras: Vec<CalibratedCamera>,
    /// Frames a second, where given.
    pub frame_rate: Option<f64>,
}

/// One camera: lens and pose.
#[derive(Debug, Clone, PartialEq)]
pub struct CalibratedCamera {
    /// Its name in the calibration.
    pub name: String,
    /// Width and height of its pictures (px).
    pub size: [u32; 2],
    focal: DVec2,
    centre: DVec2,
    distortion: [f64; 5],
    rotation: DMat3,
    translation: DVec3,
}

impl CalibratedCamera {
    /// A camera of these parameters.
    ///
    /// # Errors
    /// Their fault, to follow the camera's name.
    pub fn new(name: &str, given: &CameraParameters) -> Result<Self, String> {
        given.check()?;
        let [[fx, _, cx], [_, fy, cy], _] = given.matrix;
        let mut distortion = [0.0; 5];
        distortion[..given.distortion.len()].copy_from_slice(&given.distortion);
        Ok(Self {
            name: name.to_owned(),
            size: given.size.map(|s| s as u32),
            focal: DVec2::new(fx, fy),
            centre: DVec2::new(cx, cy),
            distortion,
            rotation: given.rotation,
            translation: given.translation,
        })
    }

    /// The rows of the matrix from world to camera.
    pub fn rows(&self) -> ([DVec3; 3], DVec3) {
        let r = self.rotation;
        ([r.row(0), r.row(1), r.row(2)], self.translation)
    }

    /// Rotation from world to camera.
    pub const fn rotation(&self) -> DMat3 {
        self.rotation
    }

    /// Focal lengths (px).
    pub const fn focal(&self) -> DVec2 {
        self.focal
    }

    /// Principal point (px).
    pub const fn centre(&self) -> DVec2 {
        self.centre
    }

    /// Position of the camera (m, world).
    pub fn position(&self) -> DVec3 {
        -(self.rotation.transpose() * self.translation)
    }

    /// A point in the camera's axes: x right, y down, z ahead (m).
    pub fn to_camera(&self, point: DVec3) -> DVec3 {
        self.rotation * point + self.translation
    }

    /// Whether the lens bends straight lines.
    pub fn is_bent(&self) -> bool {
        self.distortion.iter().any(|k| *k != 0.0)
    }

    /// The same camera with a lens that bends nothing: of its pictures when they are straightened.
    #[must_use]
    pub fn straightened(&self) -> Self {
        Self { distortion: [0.0; 5], ..self.clone() }
    }

    /// The same camera in a world that is turned: what was at X is at `by X`.
    #[must_use]
    pub fn in_turned_world(&self, by: DMat3) -> Self {
        Self { rotation: self.rotation * by.transpose(), ..self.clone() }
    }

    /// A pixel without distortion, as x/z and y/z in camera axes.
    pub fn ray(&self, pixel: DVec2) -> DVec2 {
        let seen = (pixel - self.centre) / self.focal;
        let mut flat = seen;
        for _ in 0..UNDISTORT_ROUNDS {
            let next = seen - (self.distorted(flat) - flat);
            if !next.is_finite() {
                return seen;
            }
            flat = next;
        }
        flat
    }

    /// Pixel of a ray (x/z, y/z without distortion) (px).
    pub fn pixel_of_ray(&self, ray: DVec2) -> DVec2 {
        self.distorted(ray) * self.focal + self.centre
    }

    /// Projection of a point (m, world), as x/z and y/z without distortion; `None` behind the camera.
    pub fn project(&self, point: DVec3) -> Option<DVec2> {
        let p = self.to_camera(point);
        (p.z > NEAREST).then(|| p.truncate() / p.z)
    }

    /// The pixel at which a point (m, world) is seen; `None` behind the camera.
    pub fn pixel(&self, point: DVec3) -> Option<DVec2> {
        self.project(point).map(|ray| self.pixel_of_ray(ray))
    }

    fn distorted(&self, p: DVec2) -> DVec2 {
        let [k1, k2, p1, p2, k3] = self.distortion;
        let r2 = p.length_squared();
        let radial = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3));
        let tangential = DVec2::new(
            2.0 * p1 * p.x * p.y + p2 * (r2 + 2.0 * p.x * p.x),
            p1 * (r2 + 2.0 * p.y * p.y) + 2.0 * p2 * p.x * p.y,
        );
        p * radial + tangential
    }
}
