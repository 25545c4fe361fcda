//! A live camera as the command line names it.

use clap::builder::PossibleValuesParser;
use toile_sensors::source::live::{self, CameraError, CameraName, CameraOptions, LiveDepth};

use crate::exit::AppError;

/// Degrees by which a camera's images may be turned.
const TURNS: [&str; 4] = ["0", "90", "180", "270"];

/// How a camera is mounted.
#[derive(Debug, Clone, PartialEq, clap::Args)]
pub struct MountArgs {
    /// Turn its images clockwise by so many degrees, for a camera that lies on its side: 0, 90, 180 or 270
    #[arg(long, value_name = "DEG", value_parser = PossibleValuesParser::new(TURNS), default_value = "0")]
    pub turned: String,
}

impl MountArgs {
    /// How the camera is opened.
    pub fn options(&self, colour: bool) -> CameraOptions {
        let quarter_turns = TURNS.iter().position(|t| *t == self.turned).unwrap_or(0) as u8;
        CameraOptions { colour, quarter_turns, libraries: live::folders() }
    }
}

/// Reads a camera's name such as `kinect` or `k4a:visit.mkv`.
pub fn name(given: &str) -> Result<CameraName, String> {
    given.parse().map_err(|e: CameraError| e.to_string())
}

/// Opens a camera and whatever sees through it; so many of its images are kept at once.
///
/// # Errors
/// A library that is missing, a camera that is not connected, a recording that cannot be played.
pub fn open(name: &CameraName, options: CameraOptions, kept: usize) -> Result<LiveDepth, AppError> {
    let name = name.clone();
    LiveDepth::open(Box::new(move || live::open(&name, &options)), kept, 0).map_err(|e| error(&e))
}

/// Why a camera cannot be used: what was given, or the device.
pub fn error(error: &CameraError) -> AppError {
    if error.is_input() { AppError::input(error) } else { AppError::Device(error.to_string()) }
}
