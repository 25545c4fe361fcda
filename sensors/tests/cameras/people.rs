//! A person in a room, as a camera sees them, and the recordings that a Kinect would make of it.

use std::fmt::Write;
use std::fs;
use std::path::Path;

use glam::Vec3;
use toile_base::body::{Measures, Sex};
use toile_base::clock::SECOND_NS;
use toile_base::frame::{DepthFrame, Intrinsics};
use toile_sensors::source::synthetic::{KinectNoise, SyntheticCamera, room};

/// Ticks of a Kinect's clock in a frame of 30 Hz.
const TICKS: u64 = 2_000_000;

/// When the recording begins (s since 1970).
const BEGIN_S: f64 = 1_300_399_331.5;

/// So many images of a person who stands in a room, each with noise of its own.
pub fn frames(count: u64) -> Vec<DepthFrame> {
    let body = toile_assets::body::build(Sex::Female, &Measures::average(Sex::Female)).unwrap();
    let camera =
        SyntheticCamera::looking_at(Intrinsics::KINECT_V1, Vec3::new(0.0, 1.0, 2.4), Vec3::new(0.0, 0.95, 0.0));
    let view = room::view(&camera, -1.2, &[(&body.mesh.positions, &body.mesh.triangles)]);
    let mut noise = KinectNoise::new(5);
    (0..count).map(|i| camera.frame(i * SECOND_NS / 30, noise.apply(&camera.intrinsics, &view.z))).collect()
}

/// The same as a reader places them who is not told where the camera stands: by a folder of raw images.
pub fn placed(frames: &[DepthFrame]) -> Vec<DepthFrame> {
    let folder = super::folder("placed");
    for (i, frame) in frames.iter().enumerate() {
        let bytes: Vec<u8> = frame.depth_mm.iter().flat_map(|d| d.to_le_bytes()).collect();
        fs::write(folder.join(format!("{i}.u16le")), bytes).unwrap();
    }
    let session = super::open(&folder, &super::OpenOptions::default()).unwrap_or_else(|e| panic!("{e}"));
    fs::remove_dir_all(&folder).unwrap();
    session.depth
}

/// Reading of a Kinect v1 for a depth (mm): the inverse of the formula by which readings become millimetres.
fn reading(mm: u16) -> u16 {
    if mm == 0 { 2_047 } else { ((3.330_949_5 - 1_000.0 / f32::from(mm)) / 0.003_071_101_6).round() as u16 }
}

/// Writes a recording as `fakenect-record` does: depth and colour in turn, and INDEX.txt.
pub fn write_fakenect(folder: &Path, count: u64) {
    let mut index = String::new();
    for (i, frame) in (0u64..).zip(frames(count)) {
        let seconds = BEGIN_S + i as f64 / 30.0;
        let depth = format!("d-{seconds:.6}-{}.pgm", i * TICKS);
        let colour = format!("r-{:.6}-{}.ppm", seconds + 0.005, i * TICKS + 300_000);
        let samples = frame.depth_mm.iter().flat_map(|mm| reading(*mm).to_le_bytes());
        let image = |header: &str, bytes: Vec<u8>| [header.as_bytes(), &bytes].concat();
        fs::write(folder.join(&depth), image("P5 640 480 65535\n", samples.collect())).unwrap();
        fs::write(folder.join(&colour), image("P6 640 480 255\n", vec![i as u8; 640 * 480 * 3])).unwrap();
        writeln!(index, "{depth}\n{colour}").unwrap();
    }
    fs::write(folder.join("INDEX.txt"), index).unwrap();
}
