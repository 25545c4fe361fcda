//! The interface of a live camera, the same for every library.

use std::path::PathBuf;
use std::time::Duration;

use glam::Affine3A;

use super::error::CameraError;
use crate::colour_camera::ColourCamera;
use crate::limits::MAX_VIEW_PEOPLE;
use crate::source::camera::DepthCamera;
use toile_base::frame::{Intrinsics, Joints};

/// Stamps of one moment differ by so much, for clocks count in milliseconds (ns).
const SLACK_NS: f32 = 1e6;

/// Focal length over the longer side of a webcam that sees 60 degrees.
const WEBCAM_FOCAL: f32 = 0.87;

/// How a camera is opened.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct CameraOptions {
    /// Whether colour is wanted too.
    pub colour: bool,
    /// Quarters by which its images are turned clockwise to be upright, for a camera that is mounted on its side.
    pub quarter_turns: u8,
    /// Folders in which its library is sought first.
    pub libraries: Vec<PathBuf>,
}

impl CameraOptions {
    /// Refuses options that a webcam does not have.
    ///
    /// # Errors
    /// `Unknown` where its pictures are to be turned.
    pub(super) fn check_webcam(&self) -> Result<(), CameraError> {
        if self.quarter_turns == 0 {
            return Ok(());
        }
        Err(CameraError::Unknown("a webcam cannot be turned; mount it upright, and leave --turned out".to_owned()))
    }
}

/// Properties of an open camera.
#[derive(Debug, Clone, PartialEq)]
pub struct CameraInfo {
    /// Its name and number, as the library has them.
    pub device: String,
    /// How it sees.
    pub(in crate::source) camera: DepthCamera,
    /// Frames a second that it promises (Hz).
    pub rate_hz: f32,
    /// Its pose in our world (m), where that is known already: then no floor is looked for.
    pub placed: Option<Affine3A>,
    /// Place of its colour camera.
    pub(in crate::source) colour: ColourPlace,
}

/// Pose of a colour camera, relative to the depth camera of the same device.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(in crate::source) enum ColourPlace {
    /// That is not known, or there is none.
    #[default]
    Unknown,
    /// Colour is seen by the depth camera itself.
    AsDepth,
    /// It has its own lens, and a place in the depth camera's axes.
    Beside(ColourCamera),
}

impl CameraInfo {
    /// A camera of colour alone, with the lens of an average webcam.
    pub(super) fn webcam(device: String, [width, height]: [u32; 2], rate_hz: f32) -> Self {
        let focal = WEBCAM_FOCAL * width.max(height) as f32;
        let (cx, cy) = (0.5 * (width as f32 - 1.0), 0.5 * (height as f32 - 1.0));
        let camera = DepthCamera::pinhole(Intrinsics { width, height, fx: focal, fy: focal, cx, cy });
        Self { device, camera, rate_hz, placed: None, colour: ColourPlace::Unknown }
    }

    /// The images as the camera gives them, before its lens is straightened.
    pub fn sensor(&self) -> Intrinsics {
        self.camera.intrinsics
    }

    /// Its colour camera, where the depth camera stands there in our world (m); none where it is not known how it sees.
    pub fn colour_camera(&self, depth_to_world: Affine3A) -> Option<ColourCamera> {
        // Turned images would need a turned camera, which is untried.
        if self.camera.quarter_turns != 0 {
            return None;
        }
        match self.colour {
            ColourPlace::Unknown => None,
            ColourPlace::AsDepth => Some(ColourCamera::pinhole(self.sensor(), depth_to_world)),
            ColourPlace::Beside(camera) => {
                Some(ColourCamera { camera_to_world: depth_to_world * camera.camera_to_world, ..camera })
            }
        }
    }
}

/// Whether a colour image was taken in the moment of a depth image, both by the device's clock (ns): at most half a frame apart. A person
/// who walks at 1 m/s is 17 mm away by then.
pub(super) fn is_of_moment(depth_ns: u64, colour_ns: u64, rate_hz: f32) -> bool {
    depth_ns.abs_diff(colour_ns) as f32 <= 0.5e9 / rate_hz.max(1.0) + SLACK_NS
}

/// A colour image; of no size where there is none.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct ColourImage {
    /// Width (px).
    pub width: u32,
    /// Height (px).
    pub height: u32,
    /// Red, green and blue, row by row `[width * height * 3]`.
    pub rgb: Vec<u8>,
}

/// One frame as a camera gave it. It is filled again and again, and then allocates nothing.
#[derive(Debug, Clone, PartialEq)]
pub struct CameraFrame {
    /// When it was taken, by the device's own clock (ns).
    pub device_ns: u64,
    /// Depth in the camera's units, row by row, 0 = nothing measured. A half frame is shorter than the camera's image.
    pub depth: Vec<u16>,
    /// The colour image of about that time, where it is wanted and new.
    pub colour: ColourImage,
    /// Joints of all persons that the camera itself tracks; empty if it tracks none.
    pub people: Vec<Joints>,
}

impl Default for CameraFrame {
    fn default() -> Self {
        let people = Vec::with_capacity(MAX_VIEW_PEOPLE);
        Self { device_ns: 0, depth: Vec::new(), colour: ColourImage::default(), people }
    }
}

impl CameraFrame {
    /// Empties it for the next frame, and keeps its storage.
    pub(super) fn clear(&mut self) {
        self.device_ns = 0;
        self.depth.clear();
        (self.colour.width, self.colour.height) = (0, 0);
        self.colour.rgb.clear();
        self.people.clear();
    }
}

/// Result of waiting for a frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Arrival {
    /// A frame.
    Frame,
    /// None in that time.
    Nothing,
    /// None any more: a recording that is played has ended.
    Ended,
}

/// A camera that is open. It is closed when dropped.
pub trait LiveCamera: Send {
    /// Its properties.
    fn info(&self) -> &CameraInfo;

    /// Waits for its next frame for about so long, and fills it in.
    ///
    /// # Errors
    /// If the camera is gone and has to be opened again.
    fn read(&mut self, frame: &mut CameraFrame, patience: Duration) -> Result<Arrival, CameraError>;
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colour_of_another_moment_is_none_of_the_depth() {
        const MS: u64 = 1_000_000;
        for (colour, is) in [(100, true), (116, true), (84, true), (119, false), (66, false), (0, false)] {
            assert_eq!(is_of_moment(100 * MS, colour * MS, 30.0), is, "{colour}");
        }
    }
}
