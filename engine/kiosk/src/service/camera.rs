//! The live camera of a kiosk, with the threads that see through it.

use glam::Vec2;
use toile_base::body::Sex;
use toile_engine::clock::RealClock;
use toile_fitting::live::camera_start::{self, CameraSetup, CameraStartError};
use toile_fitting::live::depth_camera::{self, CameraHandle};
use toile_fitting::live::own_picture::{PictureReceiver, PictureSwitch};
use toile_fitting::live::source::Feed;
use toile_fitting::live::webcam::WebcamOptions;
use toile_pose::scale::WebcamMount;
use toile_pose::tracker::PoseModel;
use toile_sensors::segment::Zone;
use toile_sensors::source::live::{self, CameraName, CameraOptions};

use super::config::Config;
use super::picture_config::OwnPictureUse;
use crate::error::KioskError;

/// A camera that is open, and all that comes from it.
pub struct CameraFeeds {
    /// What the sensor thread reads.
    pub feed: Feed,
    /// What others ask.
    pub handle: CameraHandle,
    /// Its pictures, for the renderer, and whether they are handed on.
    pub pictures: Option<PictureReceiver>,
    /// Whether they are.
    pub switch: Option<PictureSwitch>,
    /// Its pictures for faces, where those may be taken, and whether they are handed on.
    pub portraits: Option<(PictureReceiver, PictureSwitch)>,
}

/// Opens a camera of any kind.
///
/// # Errors
/// A library or a network that is missing, a camera that is not connected.
pub fn feed(config: &Config, name: CameraName, clock: RealClock) -> Result<CameraFeeds, KioskError> {
    let (sensor, facts) = (&config.sensor, config.shopper.facts().ok());
    let sex = facts.as_ref().and_then(|facts| facts.sex).unwrap_or(Sex::Female);
    let mount = WebcamMount {
        height_m: sensor.camera_height_mm.map(|mm| mm as f32 * 1e-3),
        down: (sensor.camera_tilt_degrees as f32).to_radians(),
        ..WebcamMount::default()
    };
    let stature_m = facts.and_then(|facts| facts.tape.stature());
    let own_picture = config.display.own_picture != OwnPictureUse::Never;
    let quarter_turns = (sensor.turned_degrees / 90) as u8;
    let setup = CameraSetup {
        name,
        options: CameraOptions { colour: false, quarter_turns, libraries: live::folders() },
        kept: depth_camera::GATHERED,
        zone: Zone { mark: config.display.mark_m.map(Vec2::from), ..Zone::default() },
        webcam: WebcamOptions { sex, model: PoseModel::Lite, mount, stature_m, own_picture },
        portraits: config.display.face,
    };
    let started = camera_start::start(setup, clock).map_err(|why| match why {
        // What was given, or the device.
        CameraStartError::Camera(why) if why.is_input() => KioskError::input(why),
        CameraStartError::Thread(_) => KioskError::internal(why),
        CameraStartError::Camera(_) | CameraStartError::Network(_) => KioskError::Device(why.to_string()),
    })?;
    let (pictures, switch) = started.pictures.unzip();
    Ok(CameraFeeds {
        feed: Feed::Camera(started.feed),
        handle: started.handle,
        pictures,
        switch,
        portraits: started.portraits,
    })
}
