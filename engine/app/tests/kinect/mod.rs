//! A Kinect's place taken by the library that plays a recording (Debian's freenect), and the recording.

#![allow(dead_code, reason = "each test file uses its part")]

use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use glam::Vec3;
use toile_base::body::{Measures, Sex};
use toile_base::frame::Intrinsics;
use toile_sensors::source::synthetic::{KinectNoise, SyntheticCamera, room};

/// Folders in which Debian's package freenect puts that library.
const FAKENECT: [&str; 2] = ["/usr/lib/x86_64-linux-gnu/fakenect", "/usr/lib/aarch64-linux-gnu/fakenect"];

/// Images of which a recording is made: each has noise of its own.
pub const IMAGES: usize = 36;

/// Writes a recording as `fakenect-record` does, of a person who stands in a room: so many frames, the images again and again.
pub fn write_recording(folder: &Path, frames: usize) {
    fs::create_dir_all(folder).unwrap();
    let body = toile_assets::body::build(Sex::Female, &Measures::average(Sex::Female)).unwrap();
    let at = (Vec3::new(0.0, 1.0, 2.4), Vec3::new(0.0, 0.95, 0.0));
    let camera = SyntheticCamera::looking_at(Intrinsics::KINECT_V1, at.0, at.1);
    let view = room::view(&camera, -1.2, &[(&body.mesh.positions, &body.mesh.triangles)]);
    let mut noise = KinectNoise::new(5);
    let reading = |mm: &u16| match mm {
        0 => 2_047,
        mm => ((3.330_949_5 - 1_000.0 / f32::from(*mm)) / 0.003_071_101_6).round() as u16,
    };
    for i in 0..IMAGES {
        let depth = noise.apply(&camera.intrinsics, &view.z);
        let samples = depth.iter().flat_map(|mm| reading(mm).to_le_bytes());
        let image: Vec<u8> = b"P5 640 480 65535\n".iter().copied().chain(samples).collect();
        fs::write(folder.join(format!("image-{i}.pgm")), image).unwrap();
    }
    let mut index = String::new();
    for i in 0..frames {
        let name = format!("d-{:.6}-{}.pgm", 1_300_399_331.5 + i as f64 / 30.0, i * 2_000_000);
        fs::hard_link(folder.join(format!("image-{}.pgm", i % IMAGES)), folder.join(&name)).unwrap();
        writeln!(index, "{name}").unwrap();
    }
    fs::write(folder.join("INDEX.txt"), index).unwrap();
}

/// The folder of the library, where it is installed; else a word, and in continuous integration a failure.
pub fn player() -> Option<PathBuf> {
    let folder = FAKENECT.map(PathBuf::from).into_iter().find(|folder| folder.is_dir());
    if folder.is_none() {
        assert!(std::env::var("CI").as_deref() != Ok("true"), "install Debian's freenect");
        eprintln!("skipped, did not run: Debian's freenect is not installed");
    }
    folder
}

/// Lets a command find that library, and the recording in it.
pub fn play<'a>(command: &'a mut Command, library: &Path, recording: &Path) -> &'a mut Command {
    command.env("TOILE_CAMERA_LIBRARIES", library).env("FAKENECT_PATH", recording)
}
