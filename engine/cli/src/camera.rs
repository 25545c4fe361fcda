//! A live camera as the command line names it.

use clap::builder::{PossibleValuesParser, RangedU64ValueParser};
use clap::value_parser;
use toile_base::body::Sex;
use toile_engine::clock::RealClock;
use toile_fitting::live::camera_start::{self, CameraSetup, CameraStartError, StartedCamera};
use toile_fitting::live::webcam::WebcamOptions;
use toile_pose::scale::WebcamMount;
use toile_pose::tracker::PoseModel;
use toile_sensors::segment::Zone;
use toile_sensors::source::live::{self, CameraError, CameraName, CameraOptions};

use crate::arguments::one_of;
use crate::exit::AppError;

/// Degrees by which a camera's images may be turned.
const TURNS: [&str; 4] = ["0", "90", "180", "270"];

/// How a camera is mounted.
#[derive(Debug, Clone, PartialEq, clap::Args)]
pub struct MountArgs {
    /// Turn its images clockwise by so many degrees, for a camera that lies on its side: 0, 90, 180 or 270
    #[arg(long, value_name = "DEG", value_parser = PossibleValuesParser::new(TURNS), default_value = "0")]
    pub turned: String,
    /// Height of a webcam above the floor (mm), if it is to say how tall a person is
    #[arg(long, value_name = "MM", value_parser = RangedU64ValueParser::<u32>::new().range(200..=4_000))]
    pub camera_height: Option<u32>,
    /// By how much a webcam looks down (degrees)
    #[arg(long, value_name = "DEG", value_parser = value_parser!(i8).range(-45..=60), default_value = "0", allow_hyphen_values = true)]
    pub camera_tilt: i8,
    /// What a webcam sees along the longer side of its picture (degrees)
    #[arg(long, value_name = "DEG", value_parser = value_parser!(u8).range(30..=140), default_value = "60")]
    pub camera_view: u8,
    /// Stature of the person before a webcam, which cannot see it (mm)
    #[arg(long, value_name = "MM", value_parser = RangedU64ValueParser::<u32>::new().range(900..=2_300))]
    pub stature: Option<u32>,
    /// Network that finds joints in a webcam's pictures
    #[arg(long, value_name = "N", value_parser = one_of(PoseModel::ALL, PoseModel::name), default_value = "lite")]
    pub pose: PoseModel,
}

impl MountArgs {
    /// How the camera is opened.
    pub fn options(&self, colour: bool) -> CameraOptions {
        let quarter_turns = TURNS.iter().position(|t| *t == self.turned).unwrap_or(0) as u8;
        CameraOptions { colour, quarter_turns, libraries: live::folders() }
    }

    fn webcam(&self, sex: Sex, own_picture: bool) -> WebcamOptions {
        let metres = |mm: u32| mm as f32 * 1e-3;
        let mount = WebcamMount {
            focal: 0.5 / (0.5 * f32::from(self.camera_view)).to_radians().tan(),
            height_m: self.camera_height.map(metres),
            down: f32::from(self.camera_tilt).to_radians(),
        };
        WebcamOptions { sex, model: self.pose, mount, stature_m: self.stature.map(metres), own_picture }
    }
}

/// What is wanted of a camera beside joints.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct CameraUse {
    /// Its colour images, where they are looked at.
    pub colour: bool,
    /// Its pictures with all that was seen in them, for the shopper's own picture.
    pub own_picture: bool,
}

/// Opens a camera of any kind, and starts what sees through it.
///
/// # Errors
/// A library or a network that is missing, a camera that is not connected, a recording that cannot be played.
pub fn watch(
    name: &CameraName,
    mount: &MountArgs,
    wanted: CameraUse,
    sex: Sex,
    clock: RealClock,
) -> Result<StartedCamera, AppError> {
    let (name, options, webcam) = (name.clone(), mount.options(wanted.colour), mount.webcam(sex, wanted.own_picture));
    let setup = CameraSetup { name, options, kept: 0, zone: Zone::default(), webcam, portraits: false };
    camera_start::start(setup, clock).map_err(|why| match why {
        CameraStartError::Camera(why) => error(&why),
        CameraStartError::Network(why) => AppError::Device(why.to_string()),
        CameraStartError::Thread(_) => AppError::internal(why),
    })
}

/// Reads a camera's name such as `kinect` or `k4a:visit.mkv`.
pub fn name(given: &str) -> Result<CameraName, String> {
    given.parse().map_err(|e: CameraError| e.to_string())
}

/// Why a camera cannot be used: what was given, or the device.
pub fn error(error: &CameraError) -> AppError {
    if error.is_input() { AppError::input(error) } else { AppError::Device(error.to_string()) }
}
