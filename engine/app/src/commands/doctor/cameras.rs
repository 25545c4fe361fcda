//! Libraries of live cameras: the installed ones, and the exact command for each missing one.

use toile_pose::files::{self, NetworkPackage};
use toile_sensors::source::live::{self, CameraError, CameraKind};

use super::check::Check;

/// Name of the check of a kind, and what it is for.
const fn words(kind: CameraKind) -> (&'static str, &'static str) {
    match kind {
        CameraKind::Kinect => ("camera kinect", "a live Kinect v1"),
        CameraKind::OpenNi => {
            ("camera openni", "live cameras of OpenNI 2 (Xtion, Astra, Structure) and .oni recordings")
        }
        CameraKind::K4a => ("camera k4a", "a live Azure Kinect, Femto Bolt or Femto Mega"),
        CameraKind::RealSense => ("camera realsense", "a live RealSense"),
        CameraKind::Orbbec => ("camera orbbec", "a live Gemini, Astra 2 or Femto"),
        CameraKind::Webcam | CameraKind::WebcamFile => ("camera webcam", "joints by any webcam"),
        CameraKind::Recording => ("camera recording", "a recording that plays as a camera"),
    }
}

/// The network that finds joints in a webcam's pictures, and the one command that fetches it.
pub fn pose_network() -> Check {
    network(NetworkPackage::Pose, "joints by any webcam")
}

/// The network that finds the points of a face, and the one command that fetches it.
pub fn face_network() -> Check {
    network(NetworkPackage::Face, "a face from a photograph, and a shopper's own")
}

fn network(package: NetworkPackage, needed_for: &'static str) -> Check {
    let folder = files::folder();
    match package.check(&folder) {
        Ok(()) => Check::ok(package.name(), needed_for, folder.display().to_string()),
        Err(error) => Check::missing(package.name(), needed_for, error.what(), format!("`{}`", package.fetch())),
    }
}

/// Webcams that the kernel knows.
pub fn webcams() -> Check {
    let (name, needed_for) = words(CameraKind::Webcam);
    if !cfg!(target_os = "linux") {
        let cure = "connect a depth camera".to_owned();
        return Check::missing(name, needed_for, "webcams are supported on Linux only", cure);
    }
    let found: Vec<String> = live::webcams().iter().map(|path| path.display().to_string()).collect();
    if found.is_empty() {
        return Check::missing(name, needed_for, "no /dev/video is there", "plug a webcam in".to_owned());
    }
    Check::ok(name, needed_for, found.join(", "))
}

/// One check for each kind that needs a library.
pub fn cameras() -> Vec<Check> {
    let folders = live::folders();
    let needing = CameraKind::ALL.into_iter().filter(|kind| !kind.libraries().is_empty());
    needing
        .map(|kind| {
            let (name, needed_for) = words(kind);
            let install = kind.libraries()[0].install;
            match kind.installed(&folders) {
                Ok(path) => Check::ok(name, needed_for, path.map_or_else(String::new, |p| p.display().to_string())),
                Err(CameraError::LibraryMissing { library, .. }) => {
                    Check::missing(name, needed_for, format!("{library} is not installed"), format!("`{install}`"))
                }
                Err(other) => Check::missing(name, needed_for, other.to_string(), format!("`{install}`")),
            }
        })
        .collect()
}
