//! A recording as librealsense's own recorder writes it, of a software device that is given images.

#![allow(unsafe_code, reason = "a C library is called")]

use std::ffi::{CStr, CString, c_char, c_int, c_void};
use std::path::{Path, PathBuf};
use std::time::Duration;
use std::{fs, ptr, thread};

use libloading::{Library, Symbol};
use toile_sensors::frame::DepthFrame;
use toile_sensors::source::live::CameraKind;

type Handle = *mut c_void;
type Error = *mut c_void;

const DEPTH: c_int = 1;
const Z16: c_int = 1;

#[repr(C)]
#[derive(Clone, Copy)]
struct Intrinsics {
    width: c_int,
    height: c_int,
    ppx: f32,
    ppy: f32,
    fx: f32,
    fy: f32,
    model: c_int,
    coefficients: [f32; 5],
}

#[repr(C)]
#[derive(Clone, Copy)]
struct VideoStream {
    stream: c_int,
    index: c_int,
    uid: c_int,
    width: c_int,
    height: c_int,
    fps: c_int,
    bytes: c_int,
    format: c_int,
    intrinsics: Intrinsics,
}

#[repr(C)]
struct VideoFrame {
    pixels: *mut c_void,
    deleter: Option<unsafe extern "C" fn(*mut c_void)>,
    stride: c_int,
    bytes: c_int,
    timestamp_ms: f64,
    domain: c_int,
    number: c_int,
    profile: Handle,
    depth_units: f32,
}

unsafe extern "C" fn keep(_: *mut c_void) {}

unsafe extern "C" fn ignore(frame: Handle, release: *mut c_void) {
    // SAFETY: the user pointer is `rs2_release_frame`, and the frame is ours to give back.
    unsafe {
        let release: unsafe extern "C" fn(Handle) = std::mem::transmute(release);
        release(frame);
    }
}

/// Records images; says whether the library could.
pub fn record(folders: &[PathBuf], file: &Path, frames: &[DepthFrame]) -> bool {
    // Loads it the way that it is loaded for a camera, with what it needs beside it.
    let path = CameraKind::RealSense.installed(folders).unwrap().unwrap();
    let text = CString::new(file.to_str().unwrap()).unwrap();
    let k = frames[0].intrinsics;
    // SAFETY: the library that the test found installed; each function has the signature that its headers give it, texts end with a
    // zero and outlive the calls, images outlive the device, and all that is made is deleted in turn.
    unsafe {
        let library = Library::new(&path).unwrap();
        let message: Symbol<unsafe extern "C" fn(Error) -> *const c_char> =
            library.get(b"rs2_get_error_message").unwrap();
        macro_rules! call {
            ($name:literal, ($($t:ty),*) -> $r:ty, $($a:expr),*) => {{
                let f: Symbol<unsafe extern "C" fn($($t,)* *mut Error) -> $r> = library.get($name).unwrap();
                let mut error = ptr::null_mut();
                let value = f($($a,)* &mut error);
                assert!(error.is_null(), "{:?}: {:?}", String::from_utf8_lossy($name), CStr::from_ptr(message(error)));
                value
            }};
        }
        let release: Symbol<unsafe extern "C" fn(Handle)> = library.get(b"rs2_release_frame").unwrap();
        let delete: Symbol<unsafe extern "C" fn(Handle)> = library.get(b"rs2_delete_device").unwrap();
        let delete_sensor: Symbol<unsafe extern "C" fn(Handle)> = library.get(b"rs2_delete_sensor").unwrap();
        let delete_list: Symbol<unsafe extern "C" fn(Handle)> = library.get(b"rs2_delete_sensor_list").unwrap();

        let device = call!(b"rs2_create_software_device", () -> Handle,);
        let software =
            call!(b"rs2_software_device_add_sensor", (Handle, *const c_char) -> Handle, device, c"Depth".as_ptr());
        let intrinsics = Intrinsics {
            width: k.width as c_int,
            height: k.height as c_int,
            ppx: k.cx,
            ppy: k.cy,
            fx: k.fx,
            fy: k.fy,
            model: 0,
            coefficients: [0.0; 5],
        };
        let stream = VideoStream {
            stream: DEPTH,
            index: 0,
            uid: 1,
            width: k.width as c_int,
            height: k.height as c_int,
            fps: 30,
            bytes: 2,
            format: Z16,
            intrinsics,
        };
        let profile = call!(b"rs2_software_sensor_add_video_stream", (Handle, VideoStream) -> Handle, software, stream);
        // Its depth units: RS2_OPTION_DEPTH_UNITS is 28.
        call!(b"rs2_software_sensor_add_read_only_option", (Handle, c_int, f32) -> (), software, 28, 0.001);
        let recorder = call!(b"rs2_create_record_device", (Handle, *const c_char) -> Handle, device, text.as_ptr());
        let list = call!(b"rs2_query_sensors", (Handle) -> Handle, recorder);
        let sensor = call!(b"rs2_create_sensor", (Handle, c_int) -> Handle, list, 0);
        call!(b"rs2_open", (Handle, Handle) -> (), sensor, profile);
        type Callback = unsafe extern "C" fn(Handle, *mut c_void);
        call!(b"rs2_start", (Handle, Callback, *mut c_void) -> (), sensor, ignore, *release as *mut c_void);
        for (number, frame) in (0..).zip(frames) {
            let image = VideoFrame {
                pixels: frame.depth_mm.as_ptr() as *mut c_void,
                deleter: Some(keep),
                stride: k.width as c_int * 2,
                bytes: 2,
                timestamp_ms: 1_000.0 + frame.time_ns as f64 * 1e-6,
                domain: 0,
                number,
                profile,
                depth_units: 0.001,
            };
            call!(b"rs2_software_sensor_on_video_frame", (Handle, VideoFrame) -> (), software, image);
            thread::sleep(Duration::from_millis(33));
        }
        call!(b"rs2_stop", (Handle) -> (), sensor);
        call!(b"rs2_close", (Handle) -> (), sensor);
        delete_sensor(sensor);
        delete_list(list);
        delete(recorder);
        delete(device);
        std::mem::forget(library);
    }
    fs::metadata(file).is_ok_and(|m| m.len() > 0)
}
