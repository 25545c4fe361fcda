//! Start of a live camera of any kind: the camera is opened, and the threads that see through it begin. The program and the kiosk start
//! theirs here.

use std::io;

use thiserror::Error;
use toile_engine::clock::Clock;
use toile_pose::files::{self, PoseError};
use toile_sensors::segment::Zone;
use toile_sensors::source::live::{self, CameraError, CameraName, CameraOptions, LiveColour, LiveDepth};

use super::depth_camera::{self, CameraFeed, CameraHandle, TrackerOptions};
use super::own_picture::{PictureReceiver, PictureSender, PictureSwitch};
use super::webcam::{self, WebcamJoints, WebcamOptions};

/// Which camera is opened, and how a person is seen through it.
#[derive(Debug, Clone)]
pub struct CameraSetup {
    /// The camera.
    pub name: CameraName,
    /// How it is opened; colour is asked of a webcam in any case.
    pub options: CameraOptions,
    /// Depth images that others hold at once, beside the loop's.
    pub kept: usize,
    /// Where a shopper stands before a depth camera.
    pub zone: Zone,
    /// How a webcam sees, and whose body is fitted first, to depth as well; whether the shopper may see their own picture.
    pub webcam: WebcamOptions,
    /// Whether a shopper's face may be taken from pictures.
    pub portraits: bool,
}

/// Why a camera cannot be started.
#[derive(Debug, Error)]
pub enum CameraStartError {
    /// What was given is no camera, or the camera cannot be used.
    #[error(transparent)]
    Camera(#[from] CameraError),
    /// The network that a webcam needs is missing, or another one.
    #[error(transparent)]
    Network(#[from] PoseError),
    /// The system gives no thread.
    #[error("no thread for the camera ({0}); end other programs")]
    Thread(#[from] io::Error),
}

/// A camera that is looked through.
#[derive(Debug)]
pub struct StartedCamera {
    /// Its own name.
    pub device: String,
    /// Width and height of its images, those of depth straightened (px).
    pub size: [u32; 2],
    /// What the sensor thread reads.
    pub feed: CameraFeed,
    /// What others ask.
    pub handle: CameraHandle,
    /// Its pictures, and whether they are handed on; none where own pictures are not shown.
    pub pictures: Option<(PictureReceiver, PictureSwitch)>,
    /// The same for taking faces; none where none are taken.
    pub portraits: Option<(PictureReceiver, PictureSwitch)>,
}

/// Depth images that own pictures hold: those on their way, and the one that is drawn.
const SHOWN: usize = 4;

/// Opens a camera and starts its threads. Called at load: it allocates.
///
/// # Errors
/// A library or a network that is missing, a camera that is not connected, a recording that cannot be played; no thread.
pub fn start<C>(setup: CameraSetup, clock: C) -> Result<StartedCamera, CameraStartError>
where
    C: Clock + Clone + Send + 'static,
{
    let CameraSetup { name, mut options, kept, zone, mut webcam, portraits } = setup;
    let is_webcam = name.kind.is_colour();
    let shown = webcam.own_picture;
    // Where a face is sought is known by where in the picture a person is.
    webcam.own_picture |= portraits;
    options.colour |= is_webcam || webcam.own_picture;
    let mut sender = webcam.own_picture.then(PictureSender::default);
    let pictures = sender.as_mut().filter(|_| shown).map(PictureSender::also);
    let portraits = sender.as_mut().filter(|_| portraits).map(PictureSender::also);
    // Without the network no webcam is switched on.
    let joints = if is_webcam { Some(WebcamJoints::load(&files::folder(), webcam)?) } else { None };
    let opener = Box::new(move || live::open(&name, &options));
    let Some(joints) = joints else {
        let depth = LiveDepth::open(opener, kept + SHOWN, clock.now_ns())?;
        let (device, k) = (depth.info().device.clone(), depth.intrinsics());
        let (feed, handle) = depth_camera::start(depth, clock, TrackerOptions { zone, sex: webcam.sex }, sender)?;
        return Ok(StartedCamera { device, size: [k.width, k.height], feed, handle, pictures, portraits });
    };
    let colour = LiveColour::open(opener, clock.now_ns())?;
    let (device, k) = (colour.info().device.clone(), colour.info().sensor());
    let (feed, handle) = webcam::start(colour, joints, clock, sender)?;
    Ok(StartedCamera { device, size: [k.width, k.height], feed, handle, pictures, portraits })
}
