//! OpenNI 2 through its C interface (2.2, Debian's libopenni2), for recordings and for cameras.
//!
//! Functions and layouts are declared as in `OniCAPI.h`, `OniCTypes.h` and `OniCProperties.h`.

#![allow(unsafe_code, reason = "a C library is called")]

use std::ffi::{CStr, CString, c_char, c_int, c_void};
use std::path::PathBuf;
use std::ptr;
use std::sync::{Arc, Condvar, Mutex, PoisonError};

use super::live::library::{Library, LibraryName, functions};
use crate::error::{FilePlace, ReaderFault};
use toile_base::frame::Intrinsics;

pub(super) const LIBRARY: LibraryName = LibraryName {
    camera: "camera of OpenNI 2",
    library: "libOpenNI2",
    names: &["libOpenNI2.so.0", "libOpenNI2.so"],
    stems: &["libOpenNI2"],
    install: "sudo apt install libopenni2-0",
};

/// Interface version 2.2, as the library wants it.
const API_VERSION: c_int = 2002;
const OK: c_int = 0;
const SENSOR_COLOUR: c_int = 2;
const SENSOR_DEPTH: c_int = 3;
const FORMAT_MILLIMETRES: c_int = 100;
const FORMAT_TENTHS: c_int = 101;
const FORMAT_RGB888: c_int = 200;
const PLAYBACK_SPEED: c_int = 100;
const PLAYBACK_REPEAT: c_int = 101;
const HORIZONTAL_FOV: c_int = 1;
const VERTICAL_FOV: c_int = 2;
const VIDEO_MODE: c_int = 3;
const MIRRORING: c_int = 7;
const NUMBER_OF_FRAMES: c_int = 8;

const CURE: &str = "record it again with an OpenNI 2 program such as NiViewer";

#[repr(C)]
#[derive(Debug, Clone, Copy)]
struct VideoMode {
    pixel_format: c_int,
    width: c_int,
    height: c_int,
    fps: c_int,
}

#[repr(C)]
struct OniFrame {
    data_size: c_int,
    data: *const c_void,
    sensor_type: c_int,
    timestamp_us: u64,
    index: c_int,
    width: c_int,
    height: c_int,
    mode: VideoMode,
    cropping: c_int,
    crop_x: c_int,
    crop_y: c_int,
    stride: c_int,
}

type OniHandle = *mut c_void;

functions! {
    /// The called functions of OpenNI.
    OniApi {
        fn oniInitialize(c_int) -> c_int;
        fn oniShutdown();
        fn oniGetExtendedError() -> *const c_char;
        fn oniDeviceOpen(*const c_char, *mut OniHandle) -> c_int;
        fn oniDeviceClose(OniHandle) -> c_int;
        fn oniDeviceSetProperty(OniHandle, c_int, *const c_void, c_int) -> c_int;
        fn oniDeviceCreateStream(OniHandle, c_int, *mut OniHandle) -> c_int;
        fn oniStreamDestroy(OniHandle);
        fn oniStreamStart(OniHandle) -> c_int;
        fn oniStreamStop(OniHandle);
        fn oniStreamGetProperty(OniHandle, c_int, *mut c_void, *mut c_int) -> c_int;
        fn oniStreamSetProperty(OniHandle, c_int, *const c_void, c_int) -> c_int;
        fn oniWaitForAnyStream(*mut OniHandle, c_int, *mut c_int, c_int) -> c_int;
        fn oniStreamReadFrame(OniHandle, *mut *mut OniFrame) -> c_int;
        fn oniFrameRelease(*mut OniFrame);
        fn oniDeviceEnableDepthColorSync(OniHandle) -> c_int;
        fn oniCoordinateConverterDepthToColor(OniHandle, OniHandle, c_int, c_int, u16, *mut c_int, *mut c_int) -> c_int;
    }
}

/// The library is not made for two users at once: whether it is in use, and the threads that wait for it.
static IN_USE: (Mutex<bool>, Condvar) = (Mutex::new(false), Condvar::new());

/// The library, initialised; shut down when the last owner drops it.
pub(super) struct OpenNiLibrary {
    api: OniApi,
}

/// A device that is open, closed when dropped with its streams. It stays on the thread that opened it.
pub(super) struct OpenNiDevice {
    handle: OniHandle,
    library: Arc<OpenNiLibrary>,
}

/// A stream of a device, stopped and destroyed when dropped.
pub(super) struct OpenNiStream {
    handle: OniHandle,
    device: Arc<OpenNiDevice>,
}

/// A frame of a stream, given back when dropped.
pub(super) struct OpenNiFrame<'a>(*mut OniFrame, &'a OpenNiStream);

// SAFETY: a stream is a handle of the library, which keeps nothing of the thread that made it and locks its own tables; `IN_USE` keeps
// other users away. Reading a frame takes `&mut self`. Of its device a stream has a counted reference alone: it asks the device for the
// functions of the library, and the last owner closes it.
unsafe impl Send for OpenNiStream {}

impl OpenNiLibrary {
    /// Loads it, and waits until no other owner uses it.
    pub fn start(folders: &[PathBuf]) -> Result<Arc<Self>, ReaderFault> {
        let whole = |e: &dyn std::fmt::Display| ReaderFault::new(FilePlace::Whole, e.to_string(), "then try again");
        let library = Library::load(&LIBRARY, folders).map_err(|e| whole(&e))?;
        let api = OniApi::of(&library).map_err(|e| whole(&e))?;
        let (in_use, free) = &IN_USE;
        let guard = in_use.lock().unwrap_or_else(PoisonError::into_inner);
        let mut guard = free.wait_while(guard, |in_use| *in_use).unwrap_or_else(PoisonError::into_inner);
        // SAFETY: takes a number; every success is paired with a shutdown when `OpenNiLibrary` is dropped.
        checked(&api, unsafe { (api.oniInitialize)(API_VERSION) }, "OpenNI cannot be started")?;
        *guard = true;
        Ok(Arc::new(Self { api }))
    }

    /// Opens a device by its address, a recording by its path; none is the first camera that is found.
    #[expect(clippy::arc_with_non_send_sync, reason = "its streams count it from whichever thread has them")]
    pub fn open(self: &Arc<Self>, uri: Option<&[u8]>) -> Result<Arc<OpenNiDevice>, ReaderFault> {
        let uri = uri.map(CString::new).transpose();
        let uri = uri.map_err(|_| ReaderFault::new(FilePlace::Whole, "a path with a zero in it", CURE))?;
        let (mut handle, address) = (ptr::null_mut(), uri.as_ref().map_or(ptr::null(), |uri| uri.as_ptr()));
        // SAFETY: `uri`, if there is one, ends with a zero and `handle` is a place for one pointer; both outlive the call.
        checked(&self.api, unsafe { (self.api.oniDeviceOpen)(address, &mut handle) }, "OpenNI cannot open it")?;
        Ok(Arc::new(OpenNiDevice { handle, library: self.clone() }))
    }
}

impl Drop for OpenNiLibrary {
    fn drop(&mut self) {
        // SAFETY: the library was initialised, and all that was opened holds this and is gone.
        unsafe { (self.api.oniShutdown)() };
        *IN_USE.0.lock().unwrap_or_else(PoisonError::into_inner) = false;
        IN_USE.1.notify_one();
    }
}

impl OpenNiDevice {
    fn set(&self, id: c_int, value: [u8; 4]) {
        // SAFETY: the device is open, and the library copies four bytes. A driver that does not know the property refuses.
        let _ = unsafe { (self.library.api.oniDeviceSetProperty)(self.handle, id, value.as_ptr().cast(), 4) };
    }

    /// A recording is played once and as fast as frames are asked for, in place of in time and again and again.
    pub fn play_at_once(&self) {
        self.set(PLAYBACK_SPEED, (-1.0f32).to_ne_bytes());
        self.set(PLAYBACK_REPEAT, c_int::from(false).to_ne_bytes());
    }

    /// Depth and colour are taken at one time; a driver that cannot refuses.
    pub fn synchronise(&self) {
        // SAFETY: the device is open.
        let _ = unsafe { (self.library.api.oniDeviceEnableDepthColorSync)(self.handle) };
    }

    /// Its depth stream, started.
    pub fn depth(self: &Arc<Self>) -> Result<OpenNiStream, ReaderFault> {
        self.stream(SENSOR_DEPTH, "it holds no depth stream", "its depth stream cannot be played")
    }

    /// Its colour stream, started.
    pub fn colour(self: &Arc<Self>) -> Result<OpenNiStream, ReaderFault> {
        self.stream(SENSOR_COLOUR, "it holds no colour stream", "its colour stream cannot be played")
    }

    fn stream(self: &Arc<Self>, sensor: c_int, none: &str, refused: &str) -> Result<OpenNiStream, ReaderFault> {
        let (api, mut handle) = (&self.library.api, ptr::null_mut());
        // SAFETY: the device is open and `handle` is a place for one pointer.
        checked(api, unsafe { (api.oniDeviceCreateStream)(self.handle, sensor, &mut handle) }, none)?;
        let stream = OpenNiStream { handle, device: self.clone() };
        // Left and right as the camera sees them, which some drivers mirror; one that cannot say so does not.
        let mirrored = c_int::from(false).to_ne_bytes();
        // SAFETY: the stream was just made, and the library copies four bytes.
        unsafe { (api.oniStreamSetProperty)(stream.handle, MIRRORING, mirrored.as_ptr().cast(), 4) };
        // SAFETY: the stream was just made.
        checked(api, unsafe { (api.oniStreamStart)(stream.handle) }, refused)?;
        Ok(stream)
    }
}

impl Drop for OpenNiDevice {
    fn drop(&mut self) {
        // SAFETY: the device is open, and its streams hold it and are gone.
        unsafe { (self.library.api.oniDeviceClose)(self.handle) };
    }
}

impl OpenNiStream {
    fn property<const N: usize>(&self, id: c_int) -> Option<[u8; N]> {
        let (mut value, mut size) = ([0; N], N as c_int);
        let api = &self.device.library.api;
        // SAFETY: the stream is valid, and the library writes at most `size` bytes, which are there.
        let status = unsafe { (api.oniStreamGetProperty)(self.handle, id, value.as_mut_ptr().cast(), &mut size) };
        (status == OK && size == N as c_int).then_some(value)
    }

    /// Frames of a recording; none where it does not say, as a camera.
    pub fn number_of_frames(&self) -> Option<usize> {
        self.property::<4>(NUMBER_OF_FRAMES).and_then(|n| usize::try_from(c_int::from_ne_bytes(n)).ok())
    }

    /// Width and height (px), frames a second (Hz) and millimetres in a unit, as the stream promises them.
    pub fn mode(&self) -> Option<(u32, u32, f32, f32)> {
        let [format, .., rate] = self.video_mode()?;
        let [width, height] = self.size()?;
        Some((width, height, rate.max(1) as f32, unit_of(format)?))
    }

    /// Width and height (px) of whatever it streams.
    pub fn size(&self) -> Option<[u32; 2]> {
        let [_, width, height, _] = self.video_mode()?;
        let side = |px: i32| u32::try_from(px).ok().filter(|px| *px > 0);
        Some([side(width)?, side(height)?])
    }

    /// Pixel format, width, height, rate.
    fn video_mode(&self) -> Option<[c_int; 4]> {
        let mode = self.property::<16>(VIDEO_MODE)?;
        Some(std::array::from_fn(|i| c_int::from_ne_bytes([0, 1, 2, 3].map(|b| mode[4 * i + b]))))
    }

    /// The camera by its fields of view.
    pub fn intrinsics(&self, width: u32, height: u32) -> Result<Intrinsics, ReaderFault> {
        let field = |id| self.property::<4>(id).map(f32::from_ne_bytes);
        let (Some(across), Some(down)) = (field(HORIZONTAL_FOV), field(VERTICAL_FOV)) else {
            let cure = "give the depth camera as a camera JSON";
            return Err(ReaderFault::new(
                FilePlace::Whole,
                "the recording does not say the camera's field of view",
                cure,
            ));
        };
        let focal = |size: u32, angle: f32| size as f32 * 0.5 / (angle * 0.5).tan();
        let middle = |size: u32| (size as f32 - 1.0) * 0.5;
        let k = Intrinsics {
            width,
            height,
            fx: focal(width, across),
            fy: focal(height, down),
            cx: middle(width),
            cy: middle(height),
        };
        k.fault().map_or(Ok(k), |fault| Err(ReaderFault::new(FilePlace::Whole, fault, CURE)))
    }

    /// Where the driver has a colour stream show what this depth stream measured at a pixel (px and depth in its units); none where it
    /// cannot say so, as that of recordings.
    pub fn seen_in_colour(&self, colour: &Self, [x, y]: [u32; 2], depth: u16) -> Option<[i32; 2]> {
        let (mut u, mut v) = (0, 0);
        let convert = self.device.library.api.oniCoordinateConverterDepthToColor;
        // SAFETY: both streams are valid, and two places for a number are handed over.
        let status = unsafe { convert(self.handle, colour.handle, x as c_int, y as c_int, depth, &mut u, &mut v) };
        (status == OK).then_some([u, v])
    }

    /// The next frame; none where none comes in time (ms).
    pub fn next(&mut self, patience_ms: u32) -> Option<OpenNiFrame<'_>> {
        let (mut handle, mut index) = (self.handle, 0);
        let api = &self.device.library.api;
        let patience = c_int::try_from(patience_ms).unwrap_or(c_int::MAX);
        // SAFETY: one stream is handed over, which is valid, and one place for its index.
        let status = unsafe { (api.oniWaitForAnyStream)(&mut handle, 1, &mut index, patience) };
        if status != OK {
            return None;
        }
        let mut frame = ptr::null_mut();
        // SAFETY: the stream is valid and `frame` is a place for one pointer.
        let status = unsafe { (api.oniStreamReadFrame)(self.handle, &mut frame) };
        (status == OK && !frame.is_null()).then_some(OpenNiFrame(frame, self))
    }
}

impl Drop for OpenNiStream {
    fn drop(&mut self) {
        let api = &self.device.library.api;
        // SAFETY: the stream is valid, and its frames borrow it and are gone.
        unsafe {
            (api.oniStreamStop)(self.handle);
            (api.oniStreamDestroy)(self.handle);
        }
    }
}

/// Millimetres in a unit of a format of depth.
fn unit_of(format: c_int) -> Option<f32> {
    match format {
        FORMAT_MILLIMETRES => Some(1.0),
        FORMAT_TENTHS => Some(0.1),
        _ => None,
    }
}

impl OpenNiFrame<'_> {
    fn frame(&self) -> &OniFrame {
        // SAFETY: the library gave a frame of this layout, which it keeps until the release at drop.
        unsafe { &*self.0 }
    }

    /// The device's time (ns).
    pub fn time_ns(&self) -> u64 {
        self.frame().timestamp_us.saturating_mul(1000)
    }

    /// Width, height and unit, where they are those of a depth image.
    pub fn shape(&self) -> Result<(u32, u32, f32), ReaderFault> {
        let format = self.frame().mode.pixel_format;
        let mm_per_unit = unit_of(format).ok_or_else(|| {
            let problem = format!("depth in OpenNI's format {format}, not in millimetres");
            ReaderFault::new(FilePlace::Whole, problem, "record it again in millimetres")
        })?;
        let size = self.size().filter(|_| self.frame().cropping == 0);
        let (w, h) = size.ok_or_else(|| ReaderFault::new(FilePlace::Whole, "a cropped or empty depth image", CURE))?;
        Ok((w, h, mm_per_unit))
    }

    fn size(&self) -> Option<(u32, u32)> {
        let side = |px: c_int| u32::try_from(px).ok().filter(|px| *px > 0);
        side(self.frame().width).zip(side(self.frame().height))
    }

    /// The rows of so many bytes, without what the library puts behind each; none where the image is shorter than its size.
    fn rows(&self, row_bytes: usize, rows: usize) -> Option<impl Iterator<Item = &[u8]>> {
        let f = self.frame();
        let (stride, size) = (usize::try_from(f.stride).ok()?, usize::try_from(f.data_size).ok()?);
        let whole = stride >= row_bytes && stride.checked_mul(rows).is_some_and(|all| all <= size);
        if f.data.is_null() || !whole || stride == 0 {
            return None;
        }
        // SAFETY: the library says that `size` bytes lie there, and keeps them until the frame is released.
        let bytes = unsafe { std::slice::from_raw_parts(f.data.cast::<u8>(), size) };
        Some(bytes.chunks_exact(stride).take(rows).map(move |row| &row[..row_bytes]))
    }

    /// Appends the samples of a depth image; says whether it was whole.
    pub fn depth(&self, width: u32, height: u32, to: &mut Vec<u16>) -> bool {
        let Some(rows) = self.rows(width as usize * 2, height as usize) else { return false };
        to.extend(rows.flat_map(|row| row.chunks_exact(2)).map(|b| u16::from_ne_bytes([b[0], b[1]])));
        true
    }

    /// Appends red, green and blue of a colour image; gives its size, or none where it is of another format or not whole.
    pub fn colour(&self, to: &mut Vec<u8>) -> Option<(u32, u32)> {
        let (w, h) = self.size().filter(|_| self.frame().mode.pixel_format == FORMAT_RGB888)?;
        to.extend(self.rows(w as usize * 3, h as usize)?.flatten());
        Some((w, h))
    }
}

impl Drop for OpenNiFrame<'_> {
    fn drop(&mut self) {
        // SAFETY: the frame came from the library and is given back once.
        unsafe { (self.1.device.library.api.oniFrameRelease)(self.0) };
    }
}

/// A fault with the library's own words where a call failed.
fn checked(api: &OniApi, status: c_int, what: &str) -> Result<(), ReaderFault> {
    if status == OK {
        return Ok(());
    }
    // SAFETY: the library gives a text that ends with a zero and is valid as long as itself, or nothing.
    let message = unsafe {
        let text = (api.oniGetExtendedError)();
        if text.is_null() { String::new() } else { CStr::from_ptr(text).to_string_lossy().into_owned() }
    };
    let message = message.split_whitespace().collect::<Vec<_>>().join(" ");
    let message: String = message.chars().take(200).collect();
    Err(ReaderFault::new(FilePlace::Whole, format!("{what} (OpenNI says {status}: {message})"), CURE))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_layouts_are_those_of_the_headers() {
        assert_eq!((size_of::<VideoMode>(), size_of::<OniFrame>()), (16, 80));
        assert_eq!(std::mem::offset_of!(OniFrame, timestamp_us), 24);
    }
}
