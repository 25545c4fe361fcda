//! OpenNI 2 recordings (.oni) through Debian's libopenni2: the depth stream alone, played as fast as it is read.
//!
//! The only file of this crate that calls OpenNI's C interface, whose functions and layouts are declared here as in its
//! headers (version 2.2).

#![allow(unsafe_code, reason = "a C library is called")]

use std::ffi::{CStr, CString, c_char, c_int, c_void};
use std::path::Path;
use std::ptr;
use std::sync::{Mutex, PoisonError};

use toile_assets::file;

use super::camera::{self, Camera};
use super::files::{OpenOptions, shown};
use super::sequence::Sequence;
use crate::error::{Fault, Place, SourceError};
use crate::frame::Intrinsics;
use crate::limits::{CAMERA, MAX_DEPTH_FRAMES};
use crate::session::{Session, too_many};

/// Interface version 2.2, as the library wants it.
const API_VERSION: c_int = 2002;
const OK: c_int = 0;
const SENSOR_DEPTH: c_int = 3;
const FORMAT_MILLIMETRES: c_int = 100;
const FORMAT_TENTHS: c_int = 101;
const PLAYBACK_SPEED: c_int = 100;
const PLAYBACK_REPEAT: c_int = 101;
const HORIZONTAL_FOV: c_int = 1;
const VERTICAL_FOV: c_int = 2;
const NUMBER_OF_FRAMES: c_int = 8;

/// Longest that one frame is waited for (ms): frames are in the file, and come at once.
const PATIENCE_MS: c_int = 2_000;

const CURE: &str = "record it again with an OpenNI 2 program such as NiViewer";

/// The library is not made for two threads.
static IN_USE: Mutex<()> = Mutex::new(());

#[repr(C)]
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

type Handle = *mut c_void;

#[link(name = "OpenNI2")]
unsafe extern "C" {
    fn oniInitialize(version: c_int) -> c_int;
    fn oniShutdown();
    fn oniGetExtendedError() -> *const c_char;
    fn oniDeviceOpen(uri: *const c_char, device: *mut Handle) -> c_int;
    fn oniDeviceClose(device: Handle) -> c_int;
    fn oniDeviceSetProperty(device: Handle, id: c_int, data: *const c_void, size: c_int) -> c_int;
    fn oniDeviceCreateStream(device: Handle, sensor: c_int, stream: *mut Handle) -> c_int;
    fn oniStreamDestroy(stream: Handle);
    fn oniStreamStart(stream: Handle) -> c_int;
    fn oniStreamStop(stream: Handle);
    fn oniStreamGetProperty(stream: Handle, id: c_int, data: *mut c_void, size: *mut c_int) -> c_int;
    fn oniWaitForAnyStream(streams: *mut Handle, count: c_int, index: *mut c_int, timeout_ms: c_int) -> c_int;
    fn oniStreamReadFrame(stream: Handle, frame: *mut *mut OniFrame) -> c_int;
    fn oniFrameRelease(frame: *mut OniFrame);
}

/// Reads a recording.
pub(super) fn read(path: &Path, options: &OpenOptions) -> Result<Session, SourceError> {
    let camera = match &options.camera {
        Some(json) => Some(camera::read(&file::read(json, &CAMERA)?).map_err(|fault| fault.at(&shown(json)))?),
        None => None,
    };
    let _alone = IN_USE.lock().unwrap_or_else(PoisonError::into_inner);
    let mut session = play(path, camera).map_err(|fault| fault.at(&shown(path)))?;
    session.name = path.file_stem().map_or_else(|| "session".to_owned(), |s| s.to_string_lossy().into_owned());
    session.check().map_err(|fault| fault.at(&shown(path)))?;
    Ok(session)
}

fn play(path: &Path, camera: Option<Camera>) -> Result<Session, Fault> {
    let library = Library::new()?;
    let device = library.open(path)?;
    let stream = device.depth()?;
    let frames = stream.number_of_frames()?;
    let mut sequence: Option<Sequence> = None;
    for _ in 0..frames {
        let Some(frame) = stream.next() else { break };
        let (width, height, mm_per_unit) = frame.shape()?;
        if sequence.is_none() {
            let camera = match camera {
                Some(camera) => camera,
                None => Camera { mm_per_unit, ..Camera::pinhole(stream.intrinsics(width, height)?) },
            };
            sequence = Some(Sequence::new(camera, Vec::new())?);
        }
        if let Some(sequence) = &mut sequence {
            let (time, samples) = (frame.time_ns(), frame.samples(width, height)?);
            sequence.push(time, samples.into_iter())?;
        }
    }
    let cut = Fault::new(Place::Whole, "no depth frame can be played", CURE);
    sequence.ok_or(cut)?.finish()
}

/// The library, shut down when dropped.
struct Library;

/// A recording that is open, closed when dropped.
struct Device<'a>(Handle, &'a Library);

/// Its depth stream, stopped and destroyed when dropped.
struct Stream<'a>(Handle, &'a Device<'a>);

/// A frame of it, given back when dropped.
struct BorrowedFrame<'a>(*mut OniFrame, &'a Stream<'a>);

impl Library {
    fn new() -> Result<Self, Fault> {
        // SAFETY: takes a number; every success is paired with a shutdown when `Library` is dropped.
        checked(unsafe { oniInitialize(API_VERSION) }, "OpenNI cannot be started")?;
        Ok(Self)
    }

    fn open(&self, path: &Path) -> Result<Device<'_>, Fault> {
        let bytes = path.as_os_str().as_encoded_bytes();
        let uri = CString::new(bytes).map_err(|_| Fault::new(Place::Whole, "a path with a zero in it", CURE))?;
        let mut handle = ptr::null_mut();
        // SAFETY: `uri` ends with a zero and `handle` is a place for one pointer; both outlive the call.
        checked(unsafe { oniDeviceOpen(uri.as_ptr(), &mut handle) }, "OpenNI cannot open it")?;
        let device = Device(handle, self);
        // As fast as frames are asked for, and once.
        device.set(PLAYBACK_SPEED, &(-1.0f32).to_ne_bytes());
        device.set(PLAYBACK_REPEAT, &c_int::from(false).to_ne_bytes());
        Ok(device)
    }
}

impl Drop for Library {
    fn drop(&mut self) {
        // SAFETY: the library was initialised, and all that was opened borrows this and is gone.
        unsafe { oniShutdown() };
    }
}

impl Device<'_> {
    fn set(&self, id: c_int, value: &[u8; 4]) {
        // SAFETY: the device is open, and the library copies four bytes. A driver that knows no speed refuses, which
        // only makes reading slower.
        let _ = unsafe { oniDeviceSetProperty(self.0, id, value.as_ptr().cast(), 4) };
    }

    fn depth(&self) -> Result<Stream<'_>, Fault> {
        let mut handle = ptr::null_mut();
        // SAFETY: the device is open and `handle` is a place for one pointer.
        checked(unsafe { oniDeviceCreateStream(self.0, SENSOR_DEPTH, &mut handle) }, "it holds no depth stream")?;
        let stream = Stream(handle, self);
        // SAFETY: the stream was just made.
        checked(unsafe { oniStreamStart(stream.0) }, "its depth stream cannot be played")?;
        Ok(stream)
    }
}

impl Drop for Device<'_> {
    fn drop(&mut self) {
        let _ = self.1;
        // SAFETY: the device is open, and its streams borrow it and are gone.
        unsafe { oniDeviceClose(self.0) };
    }
}

impl Stream<'_> {
    fn property<const N: usize>(&self, id: c_int) -> Option<[u8; N]> {
        let mut value = [0; N];
        let mut size = N as c_int;
        // SAFETY: the stream lives, and the library writes at most `size` bytes, which are there.
        let status = unsafe { oniStreamGetProperty(self.0, id, value.as_mut_ptr().cast(), &mut size) };
        (status == OK && size == N as c_int).then_some(value)
    }

    fn number_of_frames(&self) -> Result<usize, Fault> {
        let frames = self.property::<4>(NUMBER_OF_FRAMES).map_or(MAX_DEPTH_FRAMES as c_int, c_int::from_ne_bytes);
        let frames = usize::try_from(frames).unwrap_or(0);
        if frames > MAX_DEPTH_FRAMES { Err(too_many(frames)) } else { Ok(frames) }
    }

    /// The camera by its fields of view.
    fn intrinsics(&self, width: u32, height: u32) -> Result<Intrinsics, Fault> {
        let field = |id| self.property::<4>(id).map(f32::from_ne_bytes);
        let (Some(across), Some(down)) = (field(HORIZONTAL_FOV), field(VERTICAL_FOV)) else {
            let cure = "give the depth camera as a camera JSON";
            return Err(Fault::new(Place::Whole, "the recording does not say the camera's field of view", cure));
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
        k.fault().map_or(Ok(k), |fault| Err(Fault::new(Place::Whole, fault, CURE)))
    }

    /// The next frame; none at the end, or where none comes in time.
    fn next(&self) -> Option<BorrowedFrame<'_>> {
        let (mut handle, mut index) = (self.0, 0);
        // SAFETY: one stream is handed over, which lives, and one place for its index.
        let status = unsafe { oniWaitForAnyStream(&mut handle, 1, &mut index, PATIENCE_MS) };
        if status != OK {
            return None;
        }
        let mut frame = ptr::null_mut();
        // SAFETY: the stream lives and `frame` is a place for one pointer.
        let status = unsafe { oniStreamReadFrame(self.0, &mut frame) };
        (status == OK && !frame.is_null()).then_some(BorrowedFrame(frame, self))
    }
}

impl Drop for Stream<'_> {
    fn drop(&mut self) {
        let _ = self.1;
        // SAFETY: the stream lives, and its frames borrow it and are gone.
        unsafe {
            oniStreamStop(self.0);
            oniStreamDestroy(self.0);
        }
    }
}

impl BorrowedFrame<'_> {
    fn frame(&self) -> &OniFrame {
        // SAFETY: the library gave a frame of this layout, which it keeps until the release at drop.
        unsafe { &*self.0 }
    }

    fn time_ns(&self) -> u64 {
        self.frame().timestamp_us.saturating_mul(1000)
    }

    /// Width, height and unit, where they are those of a depth image.
    fn shape(&self) -> Result<(u32, u32, f32), Fault> {
        let f = self.frame();
        let mm_per_unit = match f.mode.pixel_format {
            FORMAT_MILLIMETRES => 1.0,
            FORMAT_TENTHS => 0.1,
            other => {
                let problem = format!("depth in OpenNI's format {other}, not in millimetres");
                return Err(Fault::new(Place::Whole, problem, "record it again in millimetres"));
            }
        };
        let side = |px: c_int| u32::try_from(px).ok().filter(|px| *px > 0);
        let size = side(f.width).zip(side(f.height)).filter(|_| f.cropping == 0);
        let (w, h) = size.ok_or_else(|| Fault::new(Place::Whole, "a cropped or empty depth image", CURE))?;
        Ok((w, h, mm_per_unit))
    }

    /// The samples, row by row without what the library puts behind each row.
    fn samples(&self, width: u32, height: u32) -> Result<Vec<u16>, Fault> {
        let f = self.frame();
        let (width, height) = (width as usize, height as usize);
        let (stride, size) = (usize::try_from(f.stride).unwrap_or(0), usize::try_from(f.data_size).unwrap_or(0));
        let whole = stride >= width * 2 && stride.checked_mul(height).is_some_and(|all| all <= size);
        if f.data.is_null() || !whole {
            return Err(Fault::new(Place::Whole, "a depth image shorter than its size", CURE));
        }
        // SAFETY: the library says that `size` bytes lie there, and keeps them until the frame is released.
        let bytes = unsafe { std::slice::from_raw_parts(f.data.cast::<u8>(), size) };
        let rows = bytes.chunks_exact(stride).take(height);
        Ok(rows.flat_map(|row| row[..width * 2].chunks_exact(2)).map(|b| u16::from_ne_bytes([b[0], b[1]])).collect())
    }
}

impl Drop for BorrowedFrame<'_> {
    fn drop(&mut self) {
        let _ = self.1;
        // SAFETY: the frame came from the library and is given back once.
        unsafe { oniFrameRelease(self.0) };
    }
}

/// A fault with the library's own words where a call failed.
fn checked(status: c_int, what: &str) -> Result<(), Fault> {
    if status == OK {
        return Ok(());
    }
    // SAFETY: the library gives a text that ends with a zero and lives as long as itself, or nothing.
    let message = unsafe {
        let text = oniGetExtendedError();
        if text.is_null() { String::new() } else { CStr::from_ptr(text).to_string_lossy().into_owned() }
    };
    let message = message.split_whitespace().collect::<Vec<_>>().join(" ");
    Err(Fault::new(
        Place::Whole,
        format!("{what} (OpenNI says {status}: {})", &message[..message.len().min(200)]),
        CURE,
    ))
}
