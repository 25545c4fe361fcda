//! Calibrated cameras: what a lens does, where the camera stands, and the files in which that is written.
//!
//! A camera maps a point X of the world (m) to `p = R X + t`, to the normalised image `x = p.x / p.z, y = p.y / p.z`, through
//! Brown's lens (1971) and to the pixel `(fx x' + cx, fy y' + cy)`; the middle of the first pixel is (0, 0), as in OpenCV.

mod camera;
mod opencv;
mod parameters;
mod pose2sim;

pub use camera::{CalibratedCamera, Rig};
pub use parameters::CameraParameters;

use std::path::Path;

use toile_assets::file;

use crate::error::{FilePlace, ReaderFault, SourceError};
use crate::limits::{CAMERA, MAX_CAMERAS};

/// Reads a calibration: a TOML file of Pose2Sim, a YAML file of OpenCV, or a folder of YAML files, one a camera.
///
/// # Errors
/// One sentence with the path, the camera and the cure where a file cannot be read, describes no camera, is left-handed, has
/// columns exchanged, or is in millimetres.
pub fn open(path: &Path) -> Result<Rig, SourceError> {
    let shown = path.display().to_string();
    if path.is_dir() {
        return folder(path).map(|mut cameras| {
            cameras.sort_by(|a, b| a.name.cmp(&b.name));
            Rig { cameras, frame_rate: None }
        });
    }
    let bytes = file::read(path, &CAMERA)?;
    let stem = path.file_stem().map_or_else(|| "camera".to_owned(), |s| s.to_string_lossy().into_owned());
    if is_yaml(path) {
        let cameras = opencv::read(&bytes, &stem).map_err(|fault| fault.at(&shown))?;
        return Ok(Rig { cameras, frame_rate: None });
    }
    read_toml(&bytes).map_err(|fault| fault.at(&shown))
}

/// Reads a calibration of Pose2Sim from memory.
pub(crate) fn read_toml(bytes: &[u8]) -> Result<Rig, ReaderFault> {
    pose2sim::read(bytes)
}

fn is_yaml(path: &Path) -> bool {
    path.extension().is_some_and(|e| e.eq_ignore_ascii_case("yml") || e.eq_ignore_ascii_case("yaml"))
}

fn folder(path: &Path) -> Result<Vec<CalibratedCamera>, SourceError> {
    let shown = path.display().to_string();
    let refused = |error| SourceError::Io { path: shown.clone(), action: "read", error };
    let mut cameras = Vec::new();
    for entry in std::fs::read_dir(path).map_err(refused)? {
        let inner = entry.map_err(refused)?.path();
        if is_yaml(&inner) && cameras.len() <= MAX_CAMERAS {
            cameras.extend(open(&inner)?.cameras);
        }
    }
    if cameras.is_empty() || cameras.len() > MAX_CAMERAS {
        let problem = format!("{} cameras in YAML files where 1 to {MAX_CAMERAS} are read", cameras.len());
        return Err(
            ReaderFault::new(FilePlace::Whole, problem, "give a YAML file of OpenCV for each camera").at(&shown)
        );
    }
    Ok(cameras)
}

#[cfg(test)]
pub(crate) mod tests;
