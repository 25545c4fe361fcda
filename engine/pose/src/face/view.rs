//! One photograph of a head: its camera, its points, the curves along its outline.

use glam::{DMat3, DVec2, DVec3};
use toile_sensors::calibration::{CalibratedCamera, CameraParameters};
use toile_sensors::face_points::FACE_POINTS;

use super::unfit::UnfitFace;

/// Focal length over the longer side of a picture of unknown lens: a portrait's.
const PORTRAIT: f64 = 1.6;

/// One photograph with its camera.
#[derive(Debug, Clone)]
pub struct FaceView {
    /// Its lens, and where it stands in the world of all photographs.
    pub camera: CalibratedCamera,
    /// Where the 68 points are (px).
    pub points: [Option<DVec2>; FACE_POINTS],
    /// Curves along the head's outline, open or closed (px) `[curves][points]`.
    pub outlines: Vec<Vec<DVec2>>,
    /// Standard deviation of a point, and of an outline across its way (px).
    pub sigma_px: f64,
}

/// The camera of a photograph of so many pixels that no calibration knows: at the origin, looking along z.
///
/// # Errors
/// A picture without pixels.
pub fn assumed_camera(size: [u32; 2], focal_px: Option<f64>) -> Result<CalibratedCamera, UnfitFace> {
    let focal = focal_px.unwrap_or(PORTRAIT * f64::from(size[0].max(size[1])));
    let middle = size.map(|s| f64::from(s) / 2.0 - 0.5);
    let given = CameraParameters {
        size: size.map(f64::from),
        matrix: [[focal, 0.0, middle[0]], [0.0, focal, middle[1]], [0.0, 0.0, 1.0]],
        distortion: Vec::new(),
        rotation: DMat3::IDENTITY,
        translation: DVec3::ZERO,
    };
    CalibratedCamera::new("photograph", &given)
        .map_err(|problem| UnfitFace::new("the photograph", problem, "give another"))
}
