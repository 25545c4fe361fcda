//! Kinect v1 through libfreenect (0.5, Debian): raw 11-bit readings, which become millimetres as those of a recording do.
//!
//! Functions and layouts are declared as in `libfreenect.h`. Nothing of this file's is called but by the thread that reads the
//! camera: the library calls back only from within `freenect_process_events_timeout`.

#![allow(unsafe_code, reason = "a C library is called")]

use std::cell::RefCell;
use std::ffi::{c_char, c_int, c_long, c_void};
use std::ptr;
use std::time::{Duration, Instant};

use glam::{Affine3A, Vec3};

use super::error::CameraError;
use super::library::{Library, LibraryName, functions};
use super::live_camera::{Arrival, CameraFrame, CameraInfo, CameraOptions, ColourPlace, LiveCamera};
use crate::colour_camera::ColourCamera;
use crate::source::camera::DepthCamera;
use crate::source::fakenect::millimetres;
use toile_base::clock::SECOND_NS;
use toile_base::frame::Intrinsics;

pub(super) const LIBRARY: LibraryName = LibraryName {
    camera: NAME,
    library: "libfreenect",
    names: &["libfreenect.so.0.5", "libfreenect.so.0", "libfreenect.so"],
    stems: &["libfreenect"],
    install: "sudo apt install libfreenect0.5",
};

const NAME: &str = "Kinect";

/// Motor and camera, of which the camera alone is wanted.
const SUBDEVICE_CAMERA: c_int = 2;
const RESOLUTION_MEDIUM: c_int = 1;
const VIDEO_RGB: i32 = 0;
const DEPTH_11BIT: i32 = 0;
const LOG_FATAL: c_int = 0;

/// Ticks of the device's clock in a second.
const TICKS_A_SECOND: u64 = 60_000_000;

const WIDTH: usize = 640;
const HEIGHT: usize = 480;

type Context = *mut c_void;
type Device = *mut c_void;
type ImageCallback = unsafe extern "C" fn(Device, *mut c_void, u32);

#[repr(C)]
#[derive(Debug, Clone, Copy)]
struct FrameMode {
    reserved: u32,
    resolution: c_int,
    format: i32,
    bytes: i32,
    width: i16,
    height: i16,
    data_bits: i8,
    padding_bits: i8,
    framerate: i8,
    is_valid: i8,
}

#[repr(C)]
struct TimeValue {
    seconds: c_long,
    microseconds: c_long,
}

functions! {
    /// The called functions of libfreenect.
    Freenect {
        fn freenect_init(*mut Context, *mut c_void) -> c_int;
        fn freenect_shutdown(Context) -> c_int;
        fn freenect_set_log_level(Context, c_int);
        fn freenect_num_devices(Context) -> c_int;
        fn freenect_select_subdevices(Context, c_int);
        fn freenect_open_device(Context, *mut Device, c_int) -> c_int;
        fn freenect_open_device_by_camera_serial(Context, *mut Device, *const c_char) -> c_int;
        fn freenect_close_device(Device) -> c_int;
        fn freenect_set_depth_callback(Device, ImageCallback);
        fn freenect_set_video_callback(Device, ImageCallback);
        fn freenect_find_depth_mode(c_int, c_int) -> FrameMode;
        fn freenect_find_video_mode(c_int, c_int) -> FrameMode;
        fn freenect_set_depth_mode(Device, FrameMode) -> c_int;
        fn freenect_set_video_mode(Device, FrameMode) -> c_int;
        fn freenect_start_depth(Device) -> c_int;
        fn freenect_stop_depth(Device) -> c_int;
        fn freenect_start_video(Device) -> c_int;
        fn freenect_stop_video(Device) -> c_int;
        fn freenect_process_events_timeout(Context, *mut TimeValue) -> c_int;
    }
}

/// The buffers that the library's callbacks fill.
#[derive(Debug, Default)]
struct Inbox {
    depth: Vec<u16>,
    ticks: Option<u32>,
    colour: Vec<u8>,
    has_colour: bool,
}

thread_local! {
    /// The inbox of the camera whose events this thread is just now having processed.
    static INBOX: RefCell<Inbox> = RefCell::default();
}

/// A Kinect that is open.
pub(super) struct Kinect {
    api: Freenect,
    context: Context,
    device: Device,
    inbox: Inbox,
    info: CameraInfo,
    colour: bool,
    clock: TickClock,
}

// SAFETY: the library asks that one thread at a time calls it for a context, and `&mut self` lets no other. It keeps nothing of
// the thread that opened the device.
unsafe impl Send for Kinect {}

/// The device's clock, whose 32 bits run over every 72 seconds.
#[derive(Debug, Clone, Copy, Default)]
struct TickClock {
    last: Option<u32>,
    ticks: u64,
}

impl TickClock {
    /// Time of a stamp since the first (ns).
    fn ns(&mut self, stamp: u32) -> u64 {
        let last = *self.last.get_or_insert(stamp);
        self.ticks += u64::from(stamp.wrapping_sub(last));
        self.last = Some(stamp);
        (u128::from(self.ticks) * u128::from(SECOND_NS) / u128::from(TICKS_A_SECOND)) as u64
    }
}

/// The colour camera of a Kinect v1 as its makers mount it: 25 mm to the right of the depth camera, with a lens of 63 degrees. Devices
/// differ by some pixels (Herrera C., Kannala and Heikkila 2012, "Joint depth and color camera calibration with distortion correction").
fn colour_camera() -> ColourCamera {
    let intrinsics = Intrinsics { width: 640, height: 480, fx: 525.0, fy: 525.0, cx: 319.5, cy: 239.5 };
    ColourCamera::pinhole(intrinsics, Affine3A::from_translation(Vec3::new(0.025, 0.0, 0.0)))
}

impl Kinect {
    pub fn open(which: Option<&str>, options: &CameraOptions) -> Result<Self, CameraError> {
        let library = Library::load(&LIBRARY, &options.libraries)?;
        let api = Freenect::of(&library)?;
        let mut context = ptr::null_mut();
        // SAFETY: a place for one pointer; no USB context of our own is handed over.
        if unsafe { (api.freenect_init)(&mut context, ptr::null_mut()) } < 0 {
            return Err(refused("libfreenect cannot be started"));
        }
        let intrinsics = Intrinsics::KINECT_V1;
        let camera = DepthCamera { quarter_turns: options.quarter_turns, ..DepthCamera::pinhole(intrinsics) };
        let device = which.map_or_else(|| "Kinect v1".to_owned(), |which| format!("Kinect v1 {which}"));
        let mut kinect = Self {
            api,
            context,
            device: ptr::null_mut(),
            inbox: Inbox::default(),
            info: CameraInfo {
                device,
                camera,
                rate_hz: 30.0,
                placed: None,
                colour: ColourPlace::Beside(colour_camera()),
            },
            colour: options.colour,
            clock: TickClock::default(),
        };
        kinect.start(which)?;
        Ok(kinect)
    }

    fn start(&mut self, which: Option<&str>) -> Result<(), CameraError> {
        let (api, context) = (self.api, self.context);
        // SAFETY: the context was made above and is valid.
        let devices = unsafe {
            (api.freenect_set_log_level)(context, LOG_FATAL);
            (api.freenect_select_subdevices)(context, SUBDEVICE_CAMERA);
            (api.freenect_num_devices)(context)
        };
        if devices < 1 {
            let cure = "plug in its power and its USB cable, and see that `lsusb` lists a Xbox NUI Camera";
            return Err(CameraError::NotConnected { camera: NAME, cure });
        }
        let opened = match which {
            None => {
                // SAFETY: the context is valid, and the device is a place for one pointer.
                unsafe { (api.freenect_open_device)(context, &mut self.device, 0) }
            }
            Some(serial) => {
                let serial =
                    std::ffi::CString::new(serial).map_err(|_| refused("its serial number has a zero in it"))?;
                // SAFETY: the context is valid, and the device is a place for one pointer. The serial number ends with a zero and
                // outlives the call.
                unsafe { (api.freenect_open_device_by_camera_serial)(context, &mut self.device, serial.as_ptr()) }
            }
        };
        if opened < 0 || self.device.is_null() {
            return Err(refused("it cannot be opened; perhaps another program has it"));
        }
        self.stream()
    }

    /// Starts depth, and colour where it is wanted.
    fn stream(&mut self) -> Result<(), CameraError> {
        let (api, device) = (self.api, self.device);
        // SAFETY: the device is open, and the callbacks are functions, which live for ever.
        let depth = unsafe {
            (api.freenect_set_depth_callback)(device, take_depth);
            let mode = (api.freenect_find_depth_mode)(RESOLUTION_MEDIUM, DEPTH_11BIT);
            if is_image(&mode, 2) && (api.freenect_set_depth_mode)(device, mode) >= 0 {
                (api.freenect_start_depth)(device)
            } else {
                -1
            }
        };
        if depth < 0 {
            return Err(refused("its depth cannot be started"));
        }
        if self.colour {
            // SAFETY: the device is open, and the callback is a function, which lives for ever.
            let video = unsafe {
                (api.freenect_set_video_callback)(device, take_colour);
                let mode = (api.freenect_find_video_mode)(RESOLUTION_MEDIUM, VIDEO_RGB);
                if is_image(&mode, 3) && (api.freenect_set_video_mode)(device, mode) >= 0 {
                    (api.freenect_start_video)(device)
                } else {
                    -1
                }
            };
            if video < 0 {
                return Err(refused("its colour cannot be started"));
            }
        }
        Ok(())
    }
}

/// Whether a mode has images of 640 x 480 pixels with so many bytes each.
fn is_image(mode: &FrameMode, bytes: usize) -> bool {
    let size = (mode.width as usize, mode.height as usize, mode.bytes as usize);
    mode.is_valid != 0 && size == (WIDTH, HEIGHT, WIDTH * HEIGHT * bytes)
}

fn refused(what: &str) -> CameraError {
    let cure = "unplug it, plug it in again, and see that your user may use it (the rules of libfreenect0.5 for udev)";
    CameraError::Refused { camera: NAME, what: what.to_owned(), said_by_library: String::new(), cure }
}

/// Takes an image that the library hands out; called from within `freenect_process_events_timeout`.
unsafe extern "C" fn take_depth(_: Device, image: *mut c_void, ticks: u32) {
    if image.is_null() {
        return;
    }
    // SAFETY: the mode that was set promises so many 16-bit words, which stay until this returns.
    let image = unsafe { std::slice::from_raw_parts(image.cast::<u16>(), WIDTH * HEIGHT) };
    // No other owner has it: the library is called without holding it. Were it so, a frame would be lost.
    INBOX.with(|inbox| {
        let Ok(mut inbox) = inbox.try_borrow_mut() else { return };
        inbox.depth.clear();
        inbox.depth.extend(image.iter().map(|raw| millimetres(*raw)));
        inbox.ticks = Some(ticks);
    });
}

/// The same of colour.
unsafe extern "C" fn take_colour(_: Device, image: *mut c_void, _ticks: u32) {
    if image.is_null() {
        return;
    }
    // SAFETY: the mode that was set promises so many bytes, which stay until this returns.
    let image = unsafe { std::slice::from_raw_parts(image.cast::<u8>(), WIDTH * HEIGHT * 3) };
    INBOX.with(|inbox| {
        let Ok(mut inbox) = inbox.try_borrow_mut() else { return };
        inbox.colour.clear();
        inbox.colour.extend_from_slice(image);
        inbox.has_colour = true;
    });
}

impl Kinect {
    /// Has the library process what has come, for about so long. What its callbacks take lies in `inbox` then.
    fn process(&mut self, patience: Duration) -> c_int {
        let mut timeout = TimeValue {
            seconds: patience.as_secs() as c_long,
            microseconds: c_long::from(patience.subsec_micros() as i32),
        };
        INBOX.with(|inbox| inbox.swap(&RefCell::new(std::mem::take(&mut self.inbox))));
        // SAFETY: the context is valid, and the timeout outlives the call.
        let status = unsafe { (self.api.freenect_process_events_timeout)(self.context, &mut timeout) };
        self.inbox = INBOX.with(RefCell::take);
        status
    }
}

impl LiveCamera for Kinect {
    fn info(&self) -> &CameraInfo {
        &self.info
    }

    fn read(&mut self, frame: &mut CameraFrame, patience: Duration) -> Result<Arrival, CameraError> {
        frame.clear();
        let until = Instant::now() + patience;
        loop {
            let left = until.saturating_duration_since(Instant::now());
            if self.process(left) < 0 {
                return Err(refused("it is gone"));
            }
            if let Some(ticks) = self.inbox.ticks.take() {
                frame.device_ns = self.clock.ns(ticks);
                frame.depth.extend_from_slice(&self.inbox.depth);
                if std::mem::take(&mut self.inbox.has_colour) {
                    (frame.colour.width, frame.colour.height) = (WIDTH as u32, HEIGHT as u32);
                    frame.colour.rgb.extend_from_slice(&self.inbox.colour);
                }
                return Ok(Arrival::Frame);
            }
            if left.is_zero() {
                return Ok(Arrival::Nothing);
            }
        }
    }
}

impl Drop for Kinect {
    fn drop(&mut self) {
        // SAFETY: the device, if there is one, is open and the context is valid; neither is used after this.
        unsafe {
            if !self.device.is_null() {
                (self.api.freenect_stop_depth)(self.device);
                if self.colour {
                    (self.api.freenect_stop_video)(self.device);
                }
                (self.api.freenect_close_device)(self.device);
            }
            (self.api.freenect_shutdown)(self.context);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_layouts_are_those_of_the_header() {
        assert_eq!((size_of::<FrameMode>(), std::mem::offset_of!(FrameMode, width)), (24, 16));
        assert_eq!(size_of::<TimeValue>(), 2 * size_of::<c_long>());
    }

    #[test]
    fn a_clock_of_32_bits_runs_on() {
        let mut clock = TickClock::default();
        let stamps = [u32::MAX - 59, 0, 60_000_000].map(|stamp| clock.ns(stamp));
        assert_eq!(stamps, [0, 1_000, 1_000_001_000]);
    }
}
