//! The colour lens of an Azure Kinect's recording against what the camera's own library computes with the same calibration.

#![allow(unsafe_code, reason = "a C library is called")]

use std::ffi::{c_char, c_int};
use std::path::Path;

use glam::{Affine3A, Vec2, Vec3};
use libloading::{Library, Symbol};
use toile_sensors::source::live::{self, CameraKind, CameraOptions};

/// Numbers of the library's: the narrow depth mode, and the two cameras.
const DEPTH_NARROW: c_int = 2;
const DEPTH: c_int = 0;
const COLOUR: c_int = 1;

/// Widths of pictures by the numbers of the colour modes, from 1 on; 1536 rows are the fourth.
const WIDTHS: [u32; 6] = [1_280, 1_920, 2_560, 2_048, 3_840, 4_096];

/// More than the library's calibration takes (bytes): two cameras, 16 places, and modes are 1,032.
const CALIBRATION: usize = 4_096;

#[repr(C, align(16))]
struct Calibration([u8; CALIBRATION]);

type FromRaw = unsafe extern "C" fn(*const c_char, usize, c_int, c_int, *mut Calibration) -> c_int;
type Project =
    unsafe extern "C" fn(*const Calibration, *const [f32; 3], c_int, c_int, *mut [f32; 2], *mut c_int) -> c_int;

/// Points of the depth camera's axes are shown where the library shows them.
pub fn assert_like_the_library(options: &CameraOptions, recording: &Path, calibration: &Path) {
    let name = format!("k4a:{}", recording.display());
    let camera = live::open(&name.parse().unwrap(), options).unwrap_or_else(|e| panic!("{e}"));
    let Some(colour) = camera.info().colour_camera(Affine3A::IDENTITY) else {
        return println!("{name} has no colour");
    };
    let mode = WIDTHS.iter().position(|width| *width == colour.intrinsics.width).unwrap() as c_int + 1;
    let path = CameraKind::K4a.installed(&options.libraries).unwrap().unwrap();
    let mut raw = std::fs::read(calibration).unwrap();
    raw.push(0);
    let mut theirs = Box::new(Calibration([0; CALIBRATION]));
    let (mut worst, mut seen) = (0.0_f32, 0);
    // SAFETY: the functions have the signatures that the library's header gives them, the text ends with a zero, and there is room
    // for the calibration, a point and a pixel.
    unsafe {
        let library = Library::new(&path).unwrap();
        let read: Symbol<'_, FromRaw> = library.get(b"k4a_calibration_get_from_raw").unwrap();
        let project: Symbol<'_, Project> = library.get(b"k4a_calibration_3d_to_2d").unwrap();
        assert_eq!(read(raw.as_ptr().cast(), raw.len(), DEPTH_NARROW, mode, &mut *theirs), 0);
        for (x, y, z) in (0..17 * 13 * 3).map(|i| (i % 17, i / 17 % 13, i / (17 * 13))) {
            let z = 0.8 + z as f32;
            let p = Vec3::new((x as f32 - 8.0) * 0.09 * z, (y as f32 - 6.0) * 0.07 * z, z);
            let (mut pixel, mut valid) = ([0.0; 2], 0);
            let millimetres = (p * 1e3).to_array();
            assert_eq!(project(&*theirs, &millimetres, DEPTH, COLOUR, &mut pixel, &mut valid), 0);
            let inside = pixel.iter().zip([colour.intrinsics.width, colour.intrinsics.height]);
            if valid != 1 || !inside.into_iter().all(|(at, side)| (0.0..side as f32).contains(at)) {
                continue;
            }
            let own =
                colour.project(colour.camera_to_world.inverse().transform_point3(p)).expect("it is in the picture");
            worst = worst.max(own.distance(Vec2::from_array(pixel)));
            seen += 1;
        }
    }
    println!("{seen} points are shown within {worst} px of where libk4a shows them");
    assert!(seen > 300 && worst < 0.05, "{seen} points, {worst} px");
}
