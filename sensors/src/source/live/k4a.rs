//! Azure Kinect through libk4a (1.4), and Orbbec's Femto Bolt and Mega through Orbbec's library of the same interface and name.
//! An `.mkv` of the recorder is played in time through libk4arecord.
//!
//! Functions and layouts are declared as in `k4a.h`, `k4atypes.h` and `playback.h`. The lens comes from the calibration that the
//! camera itself holds, read as that of a recording is, so that both give the same images.

#![allow(unsafe_code, reason = "a C library is called")]

use std::ffi::{CString, c_char, c_int, c_void};
use std::path::Path;
use std::ptr;
use std::thread;
use std::time::{Duration, Instant};

use super::error::CameraError;
use super::library::{Library, LibraryName, functions};
use super::live_camera::{Arrival, CameraFrame, CameraInfo, CameraOptions, ColourPlace, LiveCamera, is_of_moment};
use crate::source::azure_calibration;
use crate::source::camera::DepthCamera;

const NAME: &str = "Azure Kinect";

const INSTALL: &str = "pip install --no-deps --target /usr/local/lib/toile/cameras pyk4a-bundle";

pub(super) const LIBRARIES: [LibraryName; 2] = [
    LibraryName {
        camera: NAME,
        library: "libk4a",
        names: &["libk4a.so.1.4", "libk4a.so"],
        stems: &["libk4a"],
        install: INSTALL,
    },
    LibraryName {
        camera: "recording of an Azure Kinect",
        library: "libk4arecord",
        names: &["libk4arecord.so.1.4", "libk4arecord.so"],
        stems: &["libk4arecord"],
        install: INSTALL,
    },
];

const OK: c_int = 0;
const TIMEOUT: c_int = 2;
const END: c_int = 2;
const TOO_SMALL: c_int = 2;
const FORMAT_BGRA32: c_int = 3;
const COLOUR_OFF: c_int = 0;
const COLOUR_720P: c_int = 1;
const DEPTH_NARROW: c_int = 2;
const RATE_30: c_int = 2;

/// Largest calibration that is read (bytes).
const MOST_CALIBRATION: usize = 1 << 20;

/// Images of the narrow mode (px), which is the one for a person before a mirror.
const NARROW: [u32; 2] = [640, 576];

type K4aHandle = *mut c_void;

#[repr(C)]
struct DeviceConfiguration {
    colour_format: c_int,
    colour_resolution: c_int,
    depth_mode: c_int,
    rate: c_int,
    synchronised_images_only: bool,
    depth_delay_us: i32,
    wired_sync_mode: c_int,
    subordinate_delay_us: u32,
    disable_streaming_indicator: bool,
}

functions! {
    /// The called functions of libk4a.
    K4aApi {
        fn k4a_device_get_installed_count() -> u32;
        fn k4a_device_open(u32, *mut K4aHandle) -> c_int;
        fn k4a_device_close(K4aHandle);
        fn k4a_device_start_cameras(K4aHandle, *const DeviceConfiguration) -> c_int;
        fn k4a_device_stop_cameras(K4aHandle);
        fn k4a_device_get_capture(K4aHandle, *mut K4aHandle, i32) -> c_int;
        fn k4a_device_get_serialnum(K4aHandle, *mut c_char, *mut usize) -> c_int;
        fn k4a_device_get_raw_calibration(K4aHandle, *mut u8, *mut usize) -> c_int;
        fn k4a_capture_release(K4aHandle);
        fn k4a_capture_get_depth_image(K4aHandle) -> K4aHandle;
        fn k4a_capture_get_color_image(K4aHandle) -> K4aHandle;
        fn k4a_image_get_buffer(K4aHandle) -> *mut u8;
        fn k4a_image_get_size(K4aHandle) -> usize;
        fn k4a_image_get_format(K4aHandle) -> c_int;
        fn k4a_image_get_width_pixels(K4aHandle) -> c_int;
        fn k4a_image_get_height_pixels(K4aHandle) -> c_int;
        fn k4a_image_get_stride_bytes(K4aHandle) -> c_int;
        fn k4a_image_get_device_timestamp_usec(K4aHandle) -> u64;
        fn k4a_image_release(K4aHandle);
    }
}

/// How a recording was made.
#[repr(C)]
#[derive(Default)]
struct RecordConfiguration {
    colour_format: c_int,
    colour_resolution: c_int,
    depth_mode: c_int,
    rate: c_int,
    /// Whether it holds colour, depth, infrared and motion.
    tracks: [bool; 4],
    depth_delay_us: i32,
    wired_sync_mode: c_int,
    subordinate_delay_us: u32,
    start_offset_us: u32,
}

functions! {
    /// The called functions of libk4arecord.
    PlaybackApi {
        fn k4a_playback_open(*const c_char, *mut K4aHandle) -> c_int;
        fn k4a_playback_get_raw_calibration(K4aHandle, *mut u8, *mut usize) -> c_int;
        fn k4a_playback_get_record_configuration(K4aHandle, *mut RecordConfiguration) -> c_int;
        fn k4a_playback_set_color_conversion(K4aHandle, c_int) -> c_int;
        fn k4a_playback_get_next_capture(K4aHandle, *mut K4aHandle) -> c_int;
        fn k4a_playback_close(K4aHandle);
    }
}

/// Source of captures.
enum CaptureSource {
    Device(K4aHandle),
    /// A recording, and the device's and our time of its first capture.
    Playback {
        api: PlaybackApi,
        handle: K4aHandle,
        begun: Option<(u64, Instant)>,
        ahead: Option<Capture>,
    },
}

/// A camera or a recording that is open.
pub(super) struct K4a {
    api: K4aApi,
    source: CaptureSource,
    info: CameraInfo,
    colour: bool,
}

// SAFETY: the library's handles are looked up in tables that it locks, from whatever thread; `&mut self` lets one at a time.
unsafe impl Send for K4a {}

/// A capture, given back when dropped.
struct Capture(K4aHandle, unsafe extern "C" fn(K4aHandle));

/// An image of a capture, given back when dropped.
struct K4aImage(K4aHandle, K4aApi);

impl K4a {
    pub fn open(which: Option<&str>, options: &CameraOptions) -> Result<Self, CameraError> {
        let library = Library::load(&LIBRARIES[0], &options.libraries)?;
        let api = K4aApi::of(&library)?;
        let recording = which.filter(|which| Path::new(which).exists());
        let (source, size, name) = match recording {
            Some(path) => (
                CaptureSource::Playback {
                    api: playback(options)?,
                    handle: opened_recording(path, options)?,
                    begun: None,
                    ahead: None,
                },
                None,
                path.to_owned(),
            ),
            None => (CaptureSource::Device(opened_device(&api, which)?), Some(NARROW), NAME.to_owned()),
        };
        let camera = DepthCamera::pinhole(toile_base::frame::Intrinsics::KINECT_V1);
        let info = CameraInfo { device: name, camera, rate_hz: 30.0, placed: None, colour: ColourPlace::Unknown };
        let mut k4a = Self { api, source, info, colour: options.colour };
        let size = match size {
            Some(size) => size,
            None => k4a.size_of_first()?,
        };
        let calibration = k4a.calibration()?;
        let camera = azure_calibration::read(&calibration, size).map_err(|problem| refused(&problem))?;
        k4a.info.camera = DepthCamera { quarter_turns: options.quarter_turns, ..camera };
        // One whose colour lens is not described shows the mannequin; its depth is as good as ever.
        let colour = azure_calibration::read_colour(&calibration, k4a.colour_resolution());
        k4a.info.colour = colour.map_or(ColourPlace::Unknown, ColourPlace::Beside);
        k4a.start()?;
        Ok(k4a)
    }

    /// Starts a device; a recording needs no start.
    fn start(&self) -> Result<(), CameraError> {
        let CaptureSource::Device(device) = self.source else { return Ok(()) };
        let configuration = DeviceConfiguration {
            colour_format: if self.colour { FORMAT_BGRA32 } else { 0 },
            colour_resolution: if self.colour { COLOUR_720P } else { COLOUR_OFF },
            depth_mode: DEPTH_NARROW,
            rate: RATE_30,
            synchronised_images_only: false,
            depth_delay_us: 0,
            wired_sync_mode: 0,
            subordinate_delay_us: 0,
            disable_streaming_indicator: false,
        };
        // SAFETY: the device is open, and the configuration outlives the call.
        match unsafe { (self.api.k4a_device_start_cameras)(device, &configuration) } {
            OK => Ok(()),
            _ => Err(refused("its cameras cannot be started; libdepthengine.so.2.0 must lie beside libk4a")),
        }
    }

    /// The mode of its colour camera, 0 where it is off.
    fn colour_resolution(&self) -> usize {
        let CaptureSource::Playback { api, handle, .. } = &self.source else { return COLOUR_720P as usize };
        let mut made = RecordConfiguration::default();
        // SAFETY: the recording is open, and `made` is a place for its configuration.
        let status = unsafe { (api.k4a_playback_get_record_configuration)(*handle, &mut made) };
        let has_colour = status == OK && made.tracks[0];
        if has_colour { usize::try_from(made.colour_resolution).unwrap_or(0) } else { 0 }
    }

    /// The calibration as the camera holds it: JSON.
    fn calibration(&self) -> Result<Vec<u8>, CameraError> {
        let ask = |data: *mut u8, size: &mut usize| match &self.source {
            // SAFETY: the handle is open, and `data` is null or a place for `size` bytes.
            CaptureSource::Device(device) => unsafe { (self.api.k4a_device_get_raw_calibration)(*device, data, size) },
            // SAFETY: the recording is open, and `data` is null or a place for `size` bytes.
            CaptureSource::Playback { api, handle, .. } => unsafe {
                (api.k4a_playback_get_raw_calibration)(*handle, data, size)
            },
        };
        let mut size = 0;
        if ask(ptr::null_mut(), &mut size) != TOO_SMALL || size > MOST_CALIBRATION {
            return Err(refused("its calibration cannot be read"));
        }
        let mut json = vec![0; size];
        if ask(json.as_mut_ptr(), &mut size) != OK {
            return Err(refused("its calibration cannot be read"));
        }
        json.truncate(size);
        Ok(json)
    }

    /// The size of a recording's depth images, by its first capture, which is kept for the first read.
    fn size_of_first(&mut self) -> Result<[u32; 2], CameraError> {
        let api = self.api;
        while let Some(capture) = self.next_recorded()? {
            let size = depth_of(&api, &capture).map(|image| image.size());
            if let (Some(size), CaptureSource::Playback { ahead, .. }) = (size, &mut self.source) {
                *ahead = Some(capture);
                return Ok(size);
            }
        }
        Err(CameraError::Recording(format!("{}: it holds no depth; record the depth camera", self.info.device)))
    }

    /// The next capture of a recording; none at its end.
    fn next_recorded(&mut self) -> Result<Option<Capture>, CameraError> {
        let CaptureSource::Playback { api, handle, ahead, .. } = &mut self.source else { return Ok(None) };
        if let Some(capture) = ahead.take() {
            return Ok(Some(capture));
        }
        let mut capture = ptr::null_mut();
        // SAFETY: the recording is open, and `capture` is a place for one pointer.
        match unsafe { (api.k4a_playback_get_next_capture)(*handle, &mut capture) } {
            OK if !capture.is_null() => Ok(Some(Capture(capture, self.api.k4a_capture_release))),
            END => Ok(None),
            _ => Err(CameraError::Recording(format!("{}: it is cut off or broken; record it again", self.info.device))),
        }
    }

    /// The next capture of a recording in its time.
    fn played(&mut self, patience: Duration) -> Result<(Arrival, Option<Capture>), CameraError> {
        let Some(capture) = self.next_recorded()? else { return Ok((Arrival::Ended, None)) };
        let time = depth_of(&self.api, &capture).map(|image| image.time_us());
        let CaptureSource::Playback { begun, ahead, .. } = &mut self.source else {
            return Ok((Arrival::Nothing, None));
        };
        let Some(time_us) = time else { return Ok((Arrival::Nothing, None)) };
        let (first_us, since) = *begun.get_or_insert_with(|| (time_us, Instant::now()));
        let wait = Duration::from_micros(time_us.saturating_sub(first_us)).saturating_sub(since.elapsed());
        thread::sleep(wait.min(patience));
        if wait > patience {
            *ahead = Some(capture);
            return Ok((Arrival::Nothing, None));
        }
        Ok((Arrival::Frame, Some(capture)))
    }

    /// The next capture of a device.
    fn captured(&self, device: K4aHandle, patience: Duration) -> Result<(Arrival, Option<Capture>), CameraError> {
        let mut capture = ptr::null_mut();
        let patience = patience.as_millis() as i32;
        // SAFETY: the device is open and started, and `capture` is a place for one pointer.
        match unsafe { (self.api.k4a_device_get_capture)(device, &mut capture, patience) } {
            OK if !capture.is_null() => Ok((Arrival::Frame, Some(Capture(capture, self.api.k4a_capture_release)))),
            TIMEOUT => Ok((Arrival::Nothing, None)),
            _ => Err(refused("it is gone")),
        }
    }
}

fn playback(options: &CameraOptions) -> Result<PlaybackApi, CameraError> {
    PlaybackApi::of(&Library::load(&LIBRARIES[1], &options.libraries)?)
}

fn opened_recording(path: &str, options: &CameraOptions) -> Result<K4aHandle, CameraError> {
    let api = playback(options)?;
    let unreadable = || CameraError::Recording(format!("{path}: it is no recording of k4arecorder; record it again"));
    let text = CString::new(path).map_err(|_| unreadable())?;
    let mut handle = ptr::null_mut();
    // SAFETY: the path ends with a zero and `handle` is a place for one pointer; both outlive the call.
    if unsafe { (api.k4a_playback_open)(text.as_ptr(), &mut handle) } != OK {
        return Err(unreadable());
    }
    if options.colour {
        // SAFETY: the recording is open. One without colour refuses, and then gives none.
        unsafe { (api.k4a_playback_set_color_conversion)(handle, FORMAT_BGRA32) };
    }
    Ok(handle)
}

/// Opens the first device, or that of a serial number.
fn opened_device(api: &K4aApi, which: Option<&str>) -> Result<K4aHandle, CameraError> {
    // SAFETY: takes nothing.
    let count = unsafe { (api.k4a_device_get_installed_count)() };
    for index in 0..count {
        let mut device = ptr::null_mut();
        // SAFETY: a place for one pointer.
        if unsafe { (api.k4a_device_open)(index, &mut device) } != OK {
            continue;
        }
        if which.is_none_or(|which| serial(api, device).as_deref() == Some(which)) {
            return Ok(device);
        }
        // SAFETY: it was opened just now, and is used no more.
        unsafe { (api.k4a_device_close)(device) };
    }
    let cure = "plug in its power and a USB 3 cable; that no other program has it, and the udev rules 99-k4a.rules, let a user open it";
    Err(CameraError::NotConnected { camera: NAME, cure })
}

fn serial(api: &K4aApi, device: K4aHandle) -> Option<String> {
    let mut text = [0u8; 64];
    let mut size = text.len();
    // SAFETY: the device is open, and the text is a place for `size` bytes.
    let status = unsafe { (api.k4a_device_get_serialnum)(device, text.as_mut_ptr().cast(), &mut size) };
    let end = text.iter().position(|b| *b == 0)?;
    (status == OK).then(|| String::from_utf8_lossy(&text[..end]).into_owned())
}

fn refused(what: &str) -> CameraError {
    let cure = "unplug it, plug it in again, and see that no other program has it";
    CameraError::Refused { camera: NAME, what: what.to_owned(), said_by_library: String::new(), cure }
}

fn depth_of(api: &K4aApi, capture: &Capture) -> Option<K4aImage> {
    // SAFETY: the capture is valid; what is given is a reference of our own, or nothing.
    let image = unsafe { (api.k4a_capture_get_depth_image)(capture.0) };
    (!image.is_null()).then_some(K4aImage(image, *api))
}

fn colour_of(api: &K4aApi, capture: &Capture) -> Option<K4aImage> {
    // SAFETY: the capture is valid; the library gives a reference of our own, or nothing.
    let image = unsafe { (api.k4a_capture_get_color_image)(capture.0) };
    (!image.is_null()).then_some(K4aImage(image, *api))
}

impl K4aImage {
    fn size(&self) -> [u32; 2] {
        // SAFETY: the image is valid.
        let sides =
            unsafe { [(self.1.k4a_image_get_width_pixels)(self.0), (self.1.k4a_image_get_height_pixels)(self.0)] };
        sides.map(|side| u32::try_from(side).unwrap_or(0))
    }

    fn time_us(&self) -> u64 {
        // SAFETY: the image is valid.
        unsafe { (self.1.k4a_image_get_device_timestamp_usec)(self.0) }
    }

    /// The rows of so many bytes each; none where the image is shorter.
    fn rows(&self, row_bytes: usize) -> Option<impl Iterator<Item = &[u8]>> {
        // SAFETY: the image is valid.
        let (data, size, stride) = unsafe {
            let stride = (self.1.k4a_image_get_stride_bytes)(self.0);
            ((self.1.k4a_image_get_buffer)(self.0), (self.1.k4a_image_get_size)(self.0), stride)
        };
        let stride = usize::try_from(stride).ok().filter(|s| *s >= row_bytes && *s > 0)?;
        let rows = self.size()[1] as usize;
        if data.is_null() || stride.checked_mul(rows)? > size {
            return None;
        }
        // SAFETY: the library says that `size` bytes lie there, and keeps them until the image is released.
        let bytes = unsafe { std::slice::from_raw_parts(data, size) };
        Some(bytes.chunks_exact(stride).take(rows).map(move |row| &row[..row_bytes]))
    }
}

impl Drop for K4aImage {
    fn drop(&mut self) {
        // SAFETY: the image is our own reference, given back once.
        unsafe { (self.1.k4a_image_release)(self.0) };
    }
}

impl Drop for Capture {
    fn drop(&mut self) {
        // SAFETY: the capture is our own reference, given back once.
        unsafe { (self.1)(self.0) };
    }
}

impl LiveCamera for K4a {
    fn info(&self) -> &CameraInfo {
        &self.info
    }

    fn read(&mut self, frame: &mut CameraFrame, patience: Duration) -> Result<Arrival, CameraError> {
        frame.clear();
        let (arrival, capture) = match self.source {
            CaptureSource::Device(device) => self.captured(device, patience)?,
            CaptureSource::Playback { .. } => self.played(patience)?,
        };
        let Some(capture) = capture else { return Ok(arrival) };
        let Some(image) = depth_of(&self.api, &capture) else { return Ok(Arrival::Nothing) };
        frame.device_ns = image.time_us().saturating_mul(1_000);
        if let Some(rows) = image.rows(image.size()[0] as usize * 2) {
            let samples = rows.flat_map(|row| row.chunks_exact(2)).map(|b| u16::from_le_bytes([b[0], b[1]]));
            frame.depth.extend(samples);
        }
        let rate_hz = self.info.rate_hz;
        let of_moment =
            |image: &K4aImage| is_of_moment(frame.device_ns, image.time_us().saturating_mul(1_000), rate_hz);
        if let Some(image) = colour_of(&self.api, &capture).filter(|_| self.colour).filter(of_moment) {
            // SAFETY: the image is valid.
            let format = unsafe { (self.api.k4a_image_get_format)(image.0) };
            let [w, h] = image.size();
            if let Some(rows) = image.rows(w as usize * 4).filter(|_| format == FORMAT_BGRA32) {
                frame.colour.rgb.extend(rows.flat_map(|row| row.chunks_exact(4)).flat_map(|p| [p[2], p[1], p[0]]));
                (frame.colour.width, frame.colour.height) = (w, h);
            }
        }
        Ok(Arrival::Frame)
    }
}

impl Drop for K4a {
    fn drop(&mut self) {
        match &mut self.source {
            // SAFETY: the device is open, and not used after this.
            CaptureSource::Device(device) => unsafe {
                (self.api.k4a_device_stop_cameras)(*device);
                (self.api.k4a_device_close)(*device);
            },
            CaptureSource::Playback { api, handle, ahead, .. } => {
                drop(ahead.take());
                // SAFETY: the recording is open, and not used after this.
                unsafe { (api.k4a_playback_close)(*handle) };
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_configuration_is_laid_out_as_in_the_header() {
        assert_eq!(size_of::<DeviceConfiguration>(), 36);
        assert_eq!(std::mem::offset_of!(DeviceConfiguration, depth_delay_us), 20);
        assert_eq!(size_of::<RecordConfiguration>(), 36);
    }
}
