//! Cameras of OpenNI 2: Xtion, Astra, Structure and others that have a driver; a recording is played in time as a device.

use std::path::Path;
use std::time::Duration;

use super::error::CameraError;
use super::live_camera::{Arrival, CameraFrame, CameraInfo, CameraOptions, ColourPlace, LiveCamera};
use super::openni_colour::OpenNiColour;
use crate::error::ReaderFault;
use crate::source::camera::DepthCamera;
use crate::source::openni_library::{LIBRARY, OpenNiLibrary, OpenNiStream};

/// A camera that is open.
pub(super) struct OpenNi {
    info: CameraInfo,
    depth: OpenNiStream,
    colour: Option<OpenNiColour>,
}

impl OpenNi {
    pub fn open(which: Option<&str>, options: &CameraOptions) -> Result<Self, CameraError> {
        // Whether it is there at all is said in the words of all cameras.
        super::library::Library::load(&LIBRARY, &options.libraries)?;
        let refused = |fault: ReaderFault| refused(which, &fault);
        let library = OpenNiLibrary::start(&options.libraries).map_err(refused)?;
        let device = match (library.open(which.map(str::as_bytes)), which) {
            (Err(_), None) => {
                let cure = "plug it in, and see that its driver for OpenNI 2 is installed and your user may use it";
                return Err(CameraError::NotConnected { camera: LIBRARY.camera, cure });
            }
            (device, _) => device.map_err(refused)?,
        };
        let depth = device.depth().map_err(refused)?;
        let (width, height, rate_hz, mm_per_unit) = depth.mode().ok_or_else(|| CameraError::Refused {
            camera: LIBRARY.camera,
            what: "its depth is not in millimetres".into(),
            said_by_library: String::new(),
            cure: "set it to millimetres, or use another camera",
        })?;
        let pinhole = DepthCamera::pinhole(depth.intrinsics(width, height).map_err(refused)?);
        let camera = DepthCamera { mm_per_unit, quarter_turns: options.quarter_turns, ..pinhole };
        let colour = if options.colour { device.colour().ok().map(OpenNiColour::new) } else { None };
        if colour.is_some() {
            device.synchronise();
        }
        let beside = colour.as_ref().and_then(|colour| colour.camera(&depth, &camera.intrinsics, mm_per_unit));
        let place = beside.map_or(ColourPlace::Unknown, ColourPlace::Beside);
        let device = which.map_or_else(|| "OpenNI 2".to_owned(), |which| format!("OpenNI 2 {which}"));
        Ok(Self { info: CameraInfo { device, camera, rate_hz, placed: None, colour: place }, depth, colour })
    }
}

fn refused(which: Option<&str>, fault: &ReaderFault) -> CameraError {
    let is_file = which.is_some_and(|which| Path::new(which).exists());
    let what = match which {
        Some(which) if is_file => return CameraError::Recording(format!("{which}: {}; {}", fault.problem, fault.cure)),
        Some(which) => format!("{which}: {}", fault.problem),
        None => fault.problem.clone(),
    };
    let cure = "plug it in again, and see that no other program has it";
    CameraError::Refused { camera: LIBRARY.camera, what, said_by_library: String::new(), cure }
}

impl LiveCamera for OpenNi {
    fn info(&self) -> &CameraInfo {
        &self.info
    }

    fn read(&mut self, frame: &mut CameraFrame, patience: Duration) -> Result<Arrival, CameraError> {
        frame.clear();
        let sensor = self.info.sensor();
        let Some(image) = self.depth.next(patience.as_millis() as u32) else { return Ok(Arrival::Nothing) };
        frame.device_ns = image.time_ns();
        // One that is not whole stays empty, and is counted as half.
        let _ = image.depth(sensor.width, sensor.height, &mut frame.depth);
        drop(image);
        if let Some(colour) = &mut self.colour {
            colour.take(frame.device_ns, self.info.rate_hz, &mut frame.colour);
        }
        Ok(Arrival::Frame)
    }
}
