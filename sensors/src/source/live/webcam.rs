//! Any webcam, through Video for Linux: colour pictures, as YUYV or as JPEGs.

use std::path::{Path, PathBuf};
use std::time::Duration;

use super::colour_decode as decode;
use super::error::CameraError;
use super::live_camera::{Arrival, CameraFrame, CameraInfo, CameraOptions, LiveCamera};
use super::v4l2::{FourCc, MJPG, VideoStream, YUYV};

const NAME: &str = "webcam";

/// The first camera of a machine.
const FIRST: &str = "/dev/video0";

/// Modes that are tried, the best first. A body of 480 rows is more than the network's 256; YUYV needs no decoding, and what is larger
/// does not go through USB 2 at 30 Hz.
const MODES: [(FourCc, u32, u32); 4] = [(YUYV, 640, 480), (MJPG, 640, 480), (MJPG, 1280, 720), (YUYV, 1280, 720)];

/// Frames a second that are asked for (Hz).
const RATE_HZ: u32 = 30;

/// A webcam that is open.
pub(super) struct Webcam {
    stream: VideoStream,
    info: CameraInfo,
    scratch: Vec<u8>,
}

/// Files of cameras that this machine has.
pub fn webcams() -> Vec<PathBuf> {
    let entries = std::fs::read_dir("/dev").into_iter().flatten().flatten().map(|entry| entry.path());
    let is_video = |path: &Path| {
        let name = path.file_name().and_then(|name| name.to_str()).and_then(|name| name.strip_prefix("video"));
        name.is_some_and(|number| !number.is_empty() && number.bytes().all(|b| b.is_ascii_digit()))
    };
    let mut found: Vec<PathBuf> = entries.filter(|path| is_video(path)).collect();
    found.sort();
    found
}

impl Webcam {
    pub fn open(which: Option<&str>, options: &CameraOptions) -> Result<Self, CameraError> {
        let path = which.unwrap_or(FIRST);
        options.check_webcam()?;
        let refused = |e: std::io::Error| match e.kind() {
            std::io::ErrorKind::NotFound => {
                let cure = "plug it in, and name it by webcam:/dev/videoN";
                CameraError::NotConnected { camera: NAME, cure }
            }
            kind => CameraError::Refused {
                camera: NAME,
                what: format!("{path} cannot be opened"),
                said_by_library: e.to_string(),
                cure: match kind {
                    std::io::ErrorKind::PermissionDenied => "add your user to the group video, and log in again",
                    std::io::ErrorKind::ResourceBusy => "end the program that has it",
                    _ => "name another one, webcam:/dev/videoN",
                },
            },
        };
        let stream = VideoStream::open(Path::new(path), &MODES, RATE_HZ).map_err(refused)?;
        let mode = stream.mode;
        let device = format!("{} ({path})", stream.card);
        let info = CameraInfo::webcam(device, [mode.width, mode.height], mode.rate_hz as f32);
        Ok(Self { stream, info, scratch: Vec::new() })
    }
}

impl LiveCamera for Webcam {
    fn info(&self) -> &CameraInfo {
        &self.info
    }

    fn read(&mut self, frame: &mut CameraFrame, patience: Duration) -> Result<Arrival, CameraError> {
        frame.clear();
        let mode = self.stream.mode;
        let gone = |e: std::io::Error| CameraError::Refused {
            camera: NAME,
            what: "it gives no pictures any more".to_owned(),
            said_by_library: e.to_string(),
            cure: "plug it in again",
        };
        let Some(picture) = self.stream.next(patience).map_err(gone)? else { return Ok(Arrival::Nothing) };
        frame.device_ns = picture.stamp_ns;
        let size = [mode.width, mode.height, mode.stride].map(|n| n as usize);
        // A picture that is broken stays empty, and counts as half a frame.
        let _ = match mode.four_cc {
            YUYV => decode::yuyv(picture.bytes, size, &mut frame.colour),
            _ => decode::decode(picture.bytes, &mut self.scratch, &mut frame.colour),
        };
        Ok(Arrival::Frame)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_webcam_that_is_not_there_is_named_with_what_to_do() {
        let of = |path: &str| Webcam::open(Some(path), &CameraOptions::default()).err().unwrap().to_string();
        assert_eq!(of("/dev/no-such-video"), "no webcam is connected; plug it in, and name it by webcam:/dev/videoN");
        let null = of("/dev/null");
        assert!(
            null.starts_with("webcam: /dev/null cannot be opened (") && null.ends_with("webcam:/dev/videoN"),
            "{null}"
        );
        let turned = CameraOptions { quarter_turns: 1, ..CameraOptions::default() };
        assert!(Webcam::open(None, &turned).is_err_and(|e| e.is_input()));
    }
}
