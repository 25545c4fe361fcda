//! The calibration of an Azure Kinect, as the camera itself holds it and its recordings carry it: JSON.

use serde::Deserialize;

use super::camera::Camera;
use super::lens::BrownConrady;
use crate::frame::Intrinsics;

/// The modes of the depth camera: image, side of the sensor as binned, corner of the image on it (px).
const MODES: [([u32; 2], f32, [f32; 2]); 4] = [
    ([640, 576], 1024.0, [192.0, 180.0]),
    ([320, 288], 512.0, [96.0, 90.0]),
    ([512, 512], 512.0, [0.0, 0.0]),
    ([1024, 1024], 1024.0, [0.0, 0.0]),
];

/// The depth camera that a calibration describes, for images of this size (px); or what is wrong with it.
pub(super) fn read(json: &[u8], size: [u32; 2]) -> Result<Camera, String> {
    let json = json.strip_suffix(b"\0").unwrap_or(json);
    let calibration: Calibration =
        serde_json::from_slice(json).map_err(|e| format!("the attached calibration is broken: {e}"))?;
    let cameras = calibration.information.cameras;
    let depth = cameras.iter().find(|c| c.location.ends_with("LocationD0"));
    depth.ok_or_else(|| "the attached calibration describes no depth camera".to_owned())?.in_mode(size)
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
    fn in_mode(&self, size: [u32; 2]) -> Result<Camera, String> {
        let model = &self.intrinsics;
        if !model.model_type.ends_with("BrownConrady") {
            return Err(format!(
                "the depth camera's lens is described as {}, not by Brown and Conrady",
                model.model_type
            ));
        }
        let Some(&[cx, cy, fx, fy, k1, k2, k3, k4, k5, k6, centre_x, centre_y, p2, p1]) =
            model.model_parameters.get(..14)
        else {
            return Err(format!("the depth camera's lens has {} numbers, not 14", model.model_parameters.len()));
        };
        let mode = MODES.iter().find(|(image, ..)| *image == size);
        let (_, side, corner) =
            mode.ok_or_else(|| format!("{} x {} pixels are no mode of the depth camera", size[0], size[1]))?;
        let intrinsics = Intrinsics {
            width: size[0],
            height: size[1],
            fx: fx * side,
            fy: fy * side,
            cx: cx * side - corner[0] - 0.5,
            cy: cy * side - corner[1] - 0.5,
        };
        if let Some(fault) = intrinsics.fault() {
            return Err(fault);
        }
        let widest = if self.metric_radius > 0.0 { self.metric_radius } else { f32::INFINITY };
        let lens = BrownConrady { k: [k1, k2, k3, k4, k5, k6], p: [p1, p2], centre: [centre_x, centre_y], widest };
        Ok(Camera { distortion: Some(lens), ..Camera::pinhole(intrinsics) })
    }
}
