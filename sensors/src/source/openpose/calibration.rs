//! The cameras' calibration: TOML, a table a camera, as Pose2Sim and Anipose write it.
//!
//! `size` (px), `matrix` (3 x 3), `distortions` (k1, k2, p1, p2 and perhaps k3: Brown 1971), `rotation` (Rodrigues
//! vector) and `translation` (m), from world to camera. A table `metadata` may give `frame_rate`.

use glam::{DMat3, DVec2, DVec3};
use serde::Deserialize;

use crate::error::{Fault, Place};
use crate::limits::{MAX_CAMERAS, MAX_COORDINATE, MAX_SIDE};

const CURE: &str = "give the calibration as Pose2Sim writes it";

/// Rounds of undoing the distortion: each leaves a hundredth of the error before with lenses that are not fisheyes.
const UNDISTORT_ROUNDS: usize = 10;

/// Largest distortion coefficient of a lens that is no fisheye.
const LARGEST_DISTORTION: f64 = 10.0;

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
    focal: DVec2,
    centre: DVec2,
    distortion: [f64; 5],
    rotation: DMat3,
    translation: DVec3,
}

#[derive(Deserialize)]
struct CameraTable {
    size: [f64; 2],
    matrix: [[f64; 3]; 3],
    #[serde(default)]
    distortions: Vec<f64>,
    rotation: [f64; 3],
    translation: [f64; 3],
    #[serde(default)]
    fisheye: bool,
}

/// Reads a calibration.
pub fn read(bytes: &[u8]) -> Result<Rig, Fault> {
    let fault = |problem: String| Fault::new(Place::Whole, problem, CURE);
    let text = std::str::from_utf8(bytes).map_err(|_| fault("not text".to_owned()))?;
    let tables: toml::Table = text.parse().map_err(|e: toml::de::Error| fault(format!("not TOML: {}", e.message())))?;
    let rate = tables.get("metadata").and_then(|m| m.get("frame_rate"));
    let rate = rate.and_then(|r| r.as_float().or(r.as_integer().map(|i| i as f64)));
    let mut named: Vec<(&String, &toml::Value)> = tables.iter().filter(|(_, t)| t.get("matrix").is_some()).collect();
    named.sort_by_key(|(name, _)| *name);
    if named.len() < 2 || named.len() > MAX_CAMERAS {
        return Err(fault(format!("{} cameras where 2 to {MAX_CAMERAS} are read", named.len())));
    }
    let mut cameras = Vec::with_capacity(named.len());
    for (name, table) in named {
        let table: CameraTable = table
            .clone()
            .try_into()
            .map_err(|e: toml::de::Error| fault(format!("the camera '{name}' is not described: {}", e.message())))?;
        cameras.push(CalibratedCamera::new(&table).map_err(|e| fault(format!("the camera '{name}': {e}")))?);
    }
    if let Some(rate) = rate.filter(|r| !(1.0..=1000.0).contains(r)) {
        return Err(fault(format!("a frame rate of {rate} is not that of a camera")));
    }
    Ok(Rig { cameras, frame_rate: rate })
}

impl CalibratedCamera {
    fn new(table: &CameraTable) -> Result<Self, String> {
        let [[fx, _, cx], [_, fy, cy], _] = table.matrix;
        let side = f64::from(MAX_SIDE);
        if table.fisheye {
            return Err("a fisheye lens is not read".to_owned());
        }
        if !table.size.iter().all(|s| (1.0..=side).contains(s)) {
            return Err("its image has no plausible size".to_owned());
        }
        if ![fx, fy].iter().all(|f| (1.0..1e6).contains(f)) || ![cx, cy].iter().all(|c| c.abs() < 1e6) {
            return Err("its matrix is not that of a camera".to_owned());
        }
        let mut distortion = [0.0; 5];
        if table.distortions.len() > distortion.len() {
            return Err(format!("{} distortion coefficients where at most 5 are read", table.distortions.len()));
        }
        distortion[..table.distortions.len()].copy_from_slice(&table.distortions);
        let turn = DVec3::from_array(table.rotation);
        let translation = DVec3::from_array(table.translation);
        let far = |v: DVec3, limit: f64| !v.is_finite() || v.abs().max_element() > limit;
        if !distortion.iter().all(|k| k.abs() < LARGEST_DISTORTION)
            || far(turn, 100.0)
            || far(translation, f64::from(MAX_COORDINATE))
        {
            return Err("its distortion or pose is not that of a camera".to_owned());
        }
        let rotation = DMat3::from_quat(glam::DQuat::from_scaled_axis(turn));
        Ok(Self { focal: DVec2::new(fx, fy), centre: DVec2::new(cx, cy), distortion, rotation, translation })
    }

    /// The rows of the matrix from world to camera.
    pub fn rows(&self) -> ([DVec3; 3], DVec3) {
        let r = self.rotation;
        ([r.row(0), r.row(1), r.row(2)], self.translation)
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

    /// Where a point (m, world) is seen, as x/z and y/z without distortion; `None` behind the camera.
    pub fn project(&self, point: DVec3) -> Option<DVec2> {
        let p = self.rotation * point + self.translation;
        (p.z > 1e-3).then(|| p.truncate() / p.z)
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

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// Two cameras three metres away, looking at the origin from the front and the left; z up.
    pub const TWO: &str = "
[metadata]
frame_rate = 50
[b]
size = [1000.0, 1000.0]
matrix = [[1000.0, 0.0, 500.0], [0.0, 1000.0, 500.0], [0.0, 0.0, 1.0]]
distortions = [-0.1, 0.02, 0.001, -0.001]
rotation = [1.2091995761561452, -1.2091995761561452, 1.2091995761561452]
translation = [0.0, 1.0, 3.0]
[a]
size = [1000.0, 1000.0]
matrix = [[1000.0, 0.0, 500.0], [0.0, 1000.0, 500.0], [0.0, 0.0, 1.0]]
rotation = [1.5707963267948966, 0.0, 0.0]
translation = [0.0, 1.0, 3.0]
";

    /// The pixel at which a camera sees a point, distortion and all.
    pub fn pixel(camera: &CalibratedCamera, point: DVec3) -> DVec2 {
        camera.distorted(camera.project(point).unwrap()) * camera.focal + camera.centre
    }

    #[test]
    fn cameras_come_by_name_and_rays_lead_back_through_the_lens() {
        let rig = read(TWO.as_bytes()).unwrap();
        assert_eq!(rig.frame_rate, Some(50.0));
        assert_eq!(rig.cameras[0].distortion, [0.0; 5]);
        for camera in &rig.cameras {
            for point in [DVec3::new(0.3, 0.2, 1.1), DVec3::new(-0.9, 0.8, 0.1)] {
                let ray = camera.ray(pixel(camera, point));
                assert!(ray.distance(camera.project(point).unwrap()) < 1e-9);
            }
        }
    }

    #[test]
    fn what_is_no_calibration_is_refused() {
        for (from, to) in [
            ("size = [1000.0", "size = [-1.0"),
            ("[[1000.0", "[[nan"),
            ("[[1000.0", "[[0.0"),
            ("translation = [0.0", "translation = [1e9"),
            ("rotation = [1.57", "rotation = [inf, 1.57"),
            ("-0.1, 0.02", "1e300, 0.02"),
            ("0.001, -0.001", "1.0, 1.0, 1.0, 1.0"),
            ("frame_rate = 50", "frame_rate = 0"),
            ("[b]", "[b"),
            ("matrix = [[1000.0, 0.0, 500.0], [0.0, 1000.0, 500.0], [0.0, 0.0, 1.0]]\ndist", "dist"),
        ] {
            assert!(TWO.contains(from) && read(TWO.replacen(from, to, 1).as_bytes()).is_err(), "{to}");
        }
        assert!(read(b"").is_err() && read(b"\xff").is_err());
    }
}
