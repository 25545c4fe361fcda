//! Webcams on systems without Video for Linux: none is listed, and none can be opened.

use std::convert::Infallible;
use std::path::PathBuf;
use std::time::Duration;

use super::error::CameraError;
use super::live_camera::{Arrival, CameraFrame, CameraInfo, CameraOptions, LiveCamera};

/// A webcam that is open; on this system there is never one.
pub(super) struct Webcam(Infallible);

/// Files of cameras that this machine has: none.
pub fn webcams() -> Vec<PathBuf> {
    Vec::new()
}

impl Webcam {
    /// Refuses, since this system is not supported.
    pub fn open(_which: Option<&str>, _options: &CameraOptions) -> Result<Self, CameraError> {
        Err(CameraError::Refused {
            camera: "webcam",
            what: "webcams are supported on Linux only".to_owned(),
            said_by_library: String::new(),
            cure: "connect a depth camera, or play pictures by webcam-file:DIR",
        })
    }
}

impl LiveCamera for Webcam {
    fn info(&self) -> &CameraInfo {
        match self.0 {}
    }

    fn read(&mut self, _frame: &mut CameraFrame, _patience: Duration) -> Result<Arrival, CameraError> {
        match self.0 {}
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn other_systems_refuse_webcams_in_one_sentence() {
        let error = Webcam::open(None, &CameraOptions::default()).err().unwrap();
        assert!(!error.is_input() && webcams().is_empty());
        assert!(error.to_string().starts_with("webcam: webcams are supported on Linux only; "), "{error}");
    }
}
