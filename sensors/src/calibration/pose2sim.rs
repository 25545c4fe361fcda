//! TOML, a table a camera, as Pose2Sim and Anipose write it.
//!
//! `size` (px), `matrix` (3 x 3), `distortions` (k1, k2, p1, p2 and perhaps k3: Brown 1971), `rotation` (Rodrigues
//! vector, or a 3 x 3 matrix) and `translation` (m), from world to camera. A table `metadata` may give `frame_rate`.

use glam::{DMat3, DQuat, DVec3};
use serde::Deserialize;

use super::camera::{CalibratedCamera, Rig};
use super::parameters::CameraParameters;
use crate::error::{FilePlace, ReaderFault};
use crate::limits::MAX_CAMERAS;

const CURE: &str = "give the calibration as Pose2Sim writes it";

/// Longest Rodrigues vector (rad).
const LONGEST_TURN: f64 = 100.0;

#[derive(Deserialize)]
struct CameraTable {
    size: [f64; 2],
    matrix: [[f64; 3]; 3],
    #[serde(default)]
    distortions: Vec<f64>,
    rotation: Rotation,
    translation: [f64; 3],
    #[serde(default)]
    fisheye: bool,
}

#[derive(Deserialize)]
#[serde(untagged)]
enum Rotation {
    Rodrigues([f64; 3]),
    Rows([[f64; 3]; 3]),
}

/// Reads a calibration.
pub(super) fn read(bytes: &[u8]) -> Result<Rig, ReaderFault> {
    let fault = |problem: String| ReaderFault::new(FilePlace::Whole, problem, CURE);
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
        cameras.push(camera(name, &table).map_err(|e| fault(format!("the camera '{name}': {e}")))?);
    }
    if let Some(rate) = rate.filter(|r| !(1.0..=1000.0).contains(r)) {
        return Err(fault(format!("a frame rate of {rate} is not that of a camera")));
    }
    Ok(Rig { cameras, frame_rate: rate })
}

fn camera(name: &str, table: &CameraTable) -> Result<CalibratedCamera, String> {
    if table.fisheye {
        return Err("a fisheye lens is not read".to_owned());
    }
    let rotation = match table.rotation {
        Rotation::Rodrigues(turn) => {
            let turn = DVec3::from_array(turn);
            if !turn.is_finite() || turn.abs().max_element() > LONGEST_TURN {
                return Err("its rotation is not that of a camera".to_owned());
            }
            DMat3::from_quat(DQuat::from_scaled_axis(turn))
        }
        Rotation::Rows(rows) => DMat3::from_cols_array_2d(&rows).transpose(),
    };
    let parameters = CameraParameters {
        size: table.size,
        matrix: table.matrix,
        distortion: table.distortions.clone(),
        rotation,
        translation: DVec3::from_array(table.translation),
    };
    CalibratedCamera::new(name, &parameters)
}
