//! A recording as librealsense's own recorder writes it, of a software device that is given images.

#![allow(unsafe_code, reason = "a C library is called")]

use std::ffi::{CStr, CString, c_char, c_int, c_void};
use std::path::{Path, PathBuf};
use std::time::Duration;
use std::{fs, ptr, thread};

use glam::{Mat3, Quat, Vec3};
use libloading::{Library, Symbol};
use toile_base::frame;
use toile_base::frame::DepthFrame;
use toile_sensors::colour_camera::ColourCamera;
use toile_sensors::lens::BrownConrady;
use toile_sensors::source::live::{CameraKind, ColourImage};

type Handle = *mut c_void;
type Error = *mut c_void;

const DEPTH: c_int = 1;
const COLOUR: c_int = 2;
const Z16: c_int = 1;
const RGB8: c_int = 5;
const INVERSE_BROWN_CONRADY: c_int = 2;

/// Stamp of the first frame (ms), and time between two (ms).
const FIRST_MS: f64 = 1_000.0;
const STEP_MS: f64 = 1_000.0 / 30.0;

/// Size of the colour pictures (px).
const WIDTH: usize = 320;
const HEIGHT: usize = 180;

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

/// From depth to colour: a matrix column by column, and m.
#[repr(C)]
#[derive(Clone, Copy)]
struct Extrinsics {
    rotation: [f32; 9],
    translation: [f32; 3],
}

/// Pose of the colour camera, relative to the depth camera.
fn place() -> (Mat3, Vec3) {
    (Mat3::from_quat(Quat::from_rotation_y(0.01) * Quat::from_rotation_x(-0.006)), Vec3::new(0.0148, 0.0002, -0.0003))
}

/// Its lens.
fn lens() -> Intrinsics {
    Intrinsics {
        width: WIDTH as c_int,
        height: HEIGHT as c_int,
        ppx: 160.6,
        ppy: 91.2,
        fx: 228.0,
        fy: 227.4,
        model: INVERSE_BROWN_CONRADY,
        coefficients: [-0.055, 0.066, -0.0008, 0.0006, -0.02],
    }
}

/// The colour camera that is recorded, in the depth camera's axes.
pub fn colour_camera() -> ColourCamera {
    let (k, (rotation, translation)) = (lens(), place());
    let [k1, k2, p1, p2, k3] = k.coefficients;
    let lens = BrownConrady { k: [k1, k2, k3, 0.0, 0.0, 0.0], p: [p1, p2], centre: [0.0; 2], widest: f32::INFINITY };
    let (width, height) = (WIDTH as u32, HEIGHT as u32);
    let intrinsics = frame::Intrinsics { width, height, fx: k.fx, fy: k.fy, cx: k.ppx, cy: k.ppy };
    ColourCamera::beside(intrinsics, Some(lens), rotation, translation)
}

/// Which frame a colour picture is of, by its brightness; and which was taken at a time (ns).
pub fn number_of(picture: &ColourImage) -> u64 {
    assert_eq!((picture.width, picture.height), (WIDTH as u32, HEIGHT as u32));
    u64::from(picture.rgb[0] / 10)
}

/// The frame of a stamp of the device (ns).
pub fn number_at(device_ns: u64) -> u64 {
    ((device_ns as f64 * 1e-6 - FIRST_MS) / STEP_MS).round() as u64
}

#[repr(C)]
#[derive(Clone, Copy)]
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
        let colour =
            call!(b"rs2_software_device_add_sensor", (Handle, *const c_char) -> Handle, device, c"RGB Camera".as_ptr());
        let (width, height) = (WIDTH as c_int, HEIGHT as c_int);
        let stream =
            VideoStream { stream: COLOUR, uid: 2, width, height, bytes: 3, format: RGB8, intrinsics: lens(), ..stream };
        let colours = call!(b"rs2_software_sensor_add_video_stream", (Handle, VideoStream) -> Handle, colour, stream);
        let (rotation, translation) = place();
        let extrinsics = Extrinsics { rotation: rotation.to_cols_array(), translation: translation.to_array() };
        call!(b"rs2_register_extrinsics", (Handle, Handle, Extrinsics) -> (), profile, colours, extrinsics);
        let recorder = call!(b"rs2_create_record_device", (Handle, *const c_char) -> Handle, device, text.as_ptr());
        let list = call!(b"rs2_query_sensors", (Handle) -> Handle, recorder);
        type Callback = unsafe extern "C" fn(Handle, *mut c_void);
        let sensors = [(0, profile), (1, colours)].map(|(number, profile)| {
            let sensor = call!(b"rs2_create_sensor", (Handle, c_int) -> Handle, list, number);
            call!(b"rs2_open", (Handle, Handle) -> (), sensor, profile);
            call!(b"rs2_start", (Handle, Callback, *mut c_void) -> (), sensor, ignore, *release as *mut c_void);
            sensor
        });
        for (number, frame) in (0..).zip(frames) {
            let image = VideoFrame {
                pixels: frame.depth_mm.as_ptr() as *mut c_void,
                deleter: Some(keep),
                stride: k.width as c_int * 2,
                bytes: 2,
                timestamp_ms: FIRST_MS + f64::from(number) * STEP_MS,
                domain: 0,
                number,
                profile,
                depth_units: 0.001,
            };
            // Brighter from picture to picture.
            let mut rgb = vec![number as u8 * 10; WIDTH * HEIGHT * 3];
            let picture = VideoFrame {
                pixels: rgb.as_mut_ptr().cast(),
                deleter: Some(keep),
                stride: width * 3,
                bytes: 3,
                profile: colours,
                depth_units: 0.0,
                ..image
            };
            // It is written on another thread: it stays.
            std::mem::forget(rgb);
            call!(b"rs2_software_sensor_on_video_frame", (Handle, VideoFrame) -> (), software, image);
            call!(b"rs2_software_sensor_on_video_frame", (Handle, VideoFrame) -> (), colour, picture);
            thread::sleep(Duration::from_millis(33));
        }
        for sensor in sensors {
            call!(b"rs2_stop", (Handle) -> (), sensor);
            call!(b"rs2_close", (Handle) -> (), sensor);
            delete_sensor(sensor);
        }
        delete_list(list);
        delete(recorder);
        delete(device);
        std::mem::forget(library);
    }
    fs::metadata(file).is_ok_and(|m| m.len() > 0)
}
