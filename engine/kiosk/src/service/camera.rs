//! The live camera of a kiosk, with the threads that see through it.

use glam::Vec2;
use toile_assets::body::Sex;
use toile_engine::clock::{Clock, RealClock};
use toile_fitting::live::depth_camera::{self, CameraHandle, TrackerOptions};
use toile_fitting::live::source::Feed;
use toile_fitting::live::webcam::{self, WebcamJoints, WebcamOptions};
use toile_pose::files;
use toile_pose::scale::WebcamMount;
use toile_pose::tracker::PoseModel;
use toile_sensors::segment::Zone;
use toile_sensors::source::live::{self, CameraError, CameraName, CameraOptions, LiveColour, LiveDepth};

use super::config::Config;
use crate::error::KioskError;

/// Opens a camera of any kind.
///
/// # Errors
/// A library or a network that is missing, a camera that is not connected.
pub fn feed(config: &Config, name: CameraName, clock: RealClock) -> Result<(Feed, CameraHandle), KioskError> {
    let facts = config.shopper.facts().ok();
    let sex = facts.as_ref().and_then(|facts| facts.sex).unwrap_or(Sex::Female);
    let quarter_turns = (config.sensor.turned_degrees / 90) as u8;
    let how = CameraOptions { colour: name.kind.is_colour(), quarter_turns, libraries: live::folders() };
    if name.kind.is_colour() {
        let mount = WebcamMount {
            height_m: config.sensor.camera_height_mm.map(|mm| mm as f32 * 1e-3),
            down: (config.sensor.camera_tilt_degrees as f32).to_radians(),
            ..WebcamMount::default()
        };
        let stature_m = facts.and_then(|facts| facts.tape.stature());
        let options = WebcamOptions { sex, model: PoseModel::Lite, mount, stature_m };
        // Without the network no camera is switched on.
        let joints = WebcamJoints::load(&files::folder(), options).map_err(|e| KioskError::Device(e.to_string()))?;
        let opener = Box::new(move || live::open(&name, &how));
        let colour = LiveColour::open(opener, clock.now_ns()).map_err(error)?;
        let (feed, handle) = webcam::start(colour, joints, clock).map_err(KioskError::internal)?;
        return Ok((Feed::Camera(feed), handle));
    }
    let mark = config.display.mark_m.map(Vec2::from);
    let options = TrackerOptions { zone: Zone { mark, ..Zone::default() }, sex };
    let opener = Box::new(move || live::open(&name, &how));
    let depth = LiveDepth::open(opener, depth_camera::GATHERED, clock.now_ns()).map_err(error)?;
    let (feed, handle) = depth_camera::start(depth, clock, options).map_err(KioskError::internal)?;
    Ok((Feed::Camera(feed), handle))
}

/// Why a camera cannot be used: what was given, or the device.
fn error(error: CameraError) -> KioskError {
    if error.is_input() { KioskError::input(error) } else { KioskError::Device(error.to_string()) }
}
