//! Live cameras: depth, and colour and joints where a camera gives them, frame by frame as they come.
//!
//! Runs on the camera thread, the only thread that may wait for the camera: at most 2 ms a 640x480 frame beside the camera's
//! library. After the first frame it allocates nothing.
//!
//! | camera | library | seen from here by |
//! |---|---|---|
//! | `kinect` | libfreenect | raw 11-bit readings, as recordings of `fakenect-record` hold them |
//! | `openni` | libOpenNI2 | millimetres; an `.oni` file plays as a device |
//! | `k4a` | libk4a, libk4arecord | millimetres and the lens of the calibration; an `.mkv` plays |
//! | `realsense` | librealsense2 | units of the device; a recorded `.bag` or `.db3` plays |
//! | `orbbec` | libOrbbecSDK | units of the device; a recorded `.bag` plays |
//! | `webcam` | none (the kernel's Video for Linux) | colour pictures, YUYV or JPEG; through [`LiveColour`] |
//! | `webcam-file` | none | pictures of files in a webcam's place |
//! | `recording` | none | any recording that [`super::open`] reads, played in time, again and again |

mod colour_decode;
mod device_clock;
pub(in crate::source) mod error;
pub mod fault_injection;
mod frame_check;
mod frame_pool;
mod k4a;
mod kinect;
pub(in crate::source) mod library;
mod live_camera;
mod live_colour;
mod live_depth;
mod open;
mod openni;
mod openni_colour;
mod orbbec;
mod realsense;
mod realsense_lens;
mod recorded;
mod recorder;
#[cfg(target_os = "linux")]
mod v4l2;
#[cfg(target_os = "linux")]
mod webcam;
mod webcam_file;
#[cfg(any(test, not(target_os = "linux")))]
mod webcam_unsupported;

#[cfg(not(target_os = "linux"))]
use webcam_unsupported as webcam;

pub use device_clock::DeviceClock;
pub use error::CameraError;
pub use frame_check::{CameraCounts, CameraState, FrameCheck, FrameVerdict};
pub use frame_pool::{FramePool, POOL_FRAMES};
pub use library::{FOLDERS_VARIABLE, LibraryName, OWN_FOLDER, folders};
pub use live_camera::{Arrival, CameraFrame, CameraInfo, CameraOptions, ColourImage, LiveCamera};
pub use live_colour::{ColourUpdate, LiveColour};
pub use live_depth::{CameraOpener, LiveDepth, LiveUpdate, PATIENCE_NS};
pub use open::{CameraKind, CameraName, open};
pub use recorder::CameraRecorder;
pub use webcam::webcams;
