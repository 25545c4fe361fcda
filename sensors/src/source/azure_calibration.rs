//! The calibration of an Azure Kinect, as the camera itself holds it and its recordings carry it: JSON.

use glam::{Mat3, Vec3};
use serde::Deserialize;

use super::camera::DepthCamera;
use crate::colour_camera::ColourCamera;
use crate::lens::BrownConrady;
use toile_base::frame::Intrinsics;

/// A mode of a camera: its images, the sensor as binned, the image's corner on that (px).
type Mode = ([u32; 2], [f32; 2], [f32; 2]);

/// The modes of the depth camera.
const DEPTH_MODES: [Mode; 4] = [
    ([640, 576], [1024.0; 2], [192.0, 180.0]),
    ([320, 288], [512.0; 2], [96.0, 90.0]),
    ([512, 512], [512.0; 2], [0.0; 2]),
    ([1024, 1024], [1024.0; 2], [0.0; 2]),
];

/// The modes of the colour camera, by their numbers in the library (`k4a_color_resolution_t`) from 1 on.
const COLOUR_MODES: [Mode; 6] = [
    ([1280, 720], [1280.0, 960.0], [0.0, 120.0]),
    ([1920, 1080], [1920.0, 1440.0], [0.0, 180.0]),
    ([2560, 1440], [2560.0, 1920.0], [0.0, 240.0]),
    ([2048, 1536], [2048.0, 1536.0], [0.0; 2]),
    ([3840, 2160], [3840.0, 2880.0], [0.0, 360.0]),
    ([4096, 3072], [4096.0, 3072.0], [0.0; 2]),
];

/// The depth camera that a calibration describes, for images of this size (px); or what is wrong with it.
pub(super) fn read(json: &[u8], size: [u32; 2]) -> Result<DepthCamera, String> {
    let (intrinsics, lens) = found(json, "depth", "LocationD0")?.in_mode("depth", &DEPTH_MODES, size)?;
    Ok(DepthCamera { distortion: Some(lens), ..DepthCamera::pinhole(intrinsics) })
}

/// The colour camera that it describes, in the depth camera's axes, for pictures of the mode of this number; or what is wrong with it.
pub(super) fn read_colour(json: &[u8], resolution: usize) -> Result<ColourCamera, String> {
    let mode = resolution.checked_sub(1).and_then(|at| COLOUR_MODES.get(at));
    let (size, ..) = mode.ok_or_else(|| format!("{resolution} is no mode of the colour camera"))?;
    let camera = found(json, "colour", "LocationPV0")?;
    let (intrinsics, lens) = camera.in_mode("colour", &COLOUR_MODES, *size)?;
    let rows = &camera.place.rotation;
    let rotation = Mat3::from_cols_array(rows).transpose();
    let colour = ColourCamera::beside(intrinsics, Some(lens), rotation, Vec3::from_array(camera.place.translation));
    colour.fault().map_or(Ok(colour), Err)
}

/// The camera at a place of the device.
fn found(json: &[u8], what: &str, location: &str) -> Result<AzureCamera, String> {
    let json = json.strip_suffix(b"\0").unwrap_or(json);
    let calibration: Calibration =
        serde_json::from_slice(json).map_err(|e| format!("the attached calibration is broken: {e}"))?;
    let camera = calibration.information.cameras.into_iter().find(|c| c.location.ends_with(location));
    camera.ok_or_else(|| format!("the attached calibration describes no {what} camera"))
}

#[derive(Deserialize)]
struct Calibration {
    #[serde(rename = "CalibrationInformation")]
    information: Information,
}

#[derive(Deserialize)]
struct Information {
    #[serde(rename = "Cameras")]
    cameras: Vec<AzureCamera>,
}

#[derive(Deserialize)]
#[serde(rename_all = "PascalCase")]
struct AzureCamera {
    location: String,
    #[serde(default)]
    metric_radius: f32,
    intrinsics: AzureIntrinsics,
    #[serde(default, rename = "Rt")]
    place: AzurePlace,
}

/// From the depth camera's axes to those of a camera: row by row, and m.
#[derive(Deserialize)]
#[serde(rename_all = "PascalCase")]
struct AzurePlace {
    rotation: [f32; 9],
    translation: [f32; 3],
}

impl Default for AzurePlace {
    fn default() -> Self {
        Self { rotation: Mat3::IDENTITY.to_cols_array(), translation: [0.0; 3] }
    }
}

#[derive(Deserialize)]
#[serde(rename_all = "PascalCase")]
struct AzureIntrinsics {
    model_type: String,
    /// cx, cy, fx, fy over the sensor's side; k1 .. k6; the centre of distortion; p2, p1.
    model_parameters: Vec<f32>,
}

impl AzureCamera {
    /// The camera of one mode, which crops and bins the sensor. Pixels are numbered from their centres.
    fn in_mode(&self, what: &str, modes: &[Mode], size: [u32; 2]) -> Result<(Intrinsics, BrownConrady), String> {
        let model = &self.intrinsics;
        if !model.model_type.ends_with("BrownConrady") {
            return Err(format!(
                "the {what} camera's lens is described as {}, not by Brown and Conrady",
                model.model_type
            ));
        }
        let Some(&[cx, cy, fx, fy, k1, k2, k3, k4, k5, k6, centre_x, centre_y, p2, p1]) =
            model.model_parameters.get(..14)
        else {
            return Err(format!("the {what} camera's lens has {} numbers, not 14", model.model_parameters.len()));
        };
        let mode = modes.iter().find(|(image, ..)| *image == size);
        let (_, [wide, high], corner) =
            mode.ok_or_else(|| format!("{} x {} pixels are no mode of the {what} camera", size[0], size[1]))?;
        let intrinsics = Intrinsics {
            width: size[0],
            height: size[1],
            fx: fx * wide,
            fy: fy * high,
            cx: cx * wide - corner[0] - 0.5,
            cy: cy * high - corner[1] - 0.5,
        };
        if let Some(fault) = intrinsics.fault() {
            return Err(fault);
        }
        let widest = if self.metric_radius > 0.0 { self.metric_radius } else { f32::INFINITY };
        let lens = BrownConrady { k: [k1, k2, k3, k4, k5, k6], p: [p1, p2], centre: [centre_x, centre_y], widest };
        Ok((intrinsics, lens))
    }
}
