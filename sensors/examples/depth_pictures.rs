//! Pictures of a depth recording before and after cleaning: depth in colours, then the shopper alone, shaded.
//!
//! `cargo run --release -p toile-sensors --example depth_pictures -- RECORDING OUT.png [CAMERA.json]`
//!
//! `room` in place of a recording shows two synthetic people in a room.

use std::error::Error;
use std::path::{Path, PathBuf};

use glam::{Vec3, Vec3A};
use toile_base::body::{Measures, Sex};
use toile_base::frame::{DepthFrame, Intrinsics};
use toile_sensors::depth::{Clean, Cloud, DepthSmoothing, Validity};
use toile_sensors::segment::Zone;
use toile_sensors::source::synthetic::room;
use toile_sensors::source::synthetic::{KinectNoise, SyntheticCamera};
use toile_sensors::source::{OpenOptions, open};

/// White between the pictures (px).
const GAP: usize = 8;

fn main() -> Result<(), Box<dyn Error>> {
    let mut args = std::env::args_os().skip(1).map(PathBuf::from);
    let (Some(input), Some(out)) = (args.next(), args.next()) else {
        return Err("give a recording and a PNG to write".into());
    };
    let frame = &if input.as_os_str() == "room" {
        room()?
    } else {
        let session = open(&input, &OpenOptions { camera: args.next() })?;
        session.depth.into_iter().next().ok_or("the recording holds no depth")?
    };
    let clouds = [DepthSmoothing::None, Clean::default().smoothing()].map(|smoothing| {
        let mut clean = Clean::new(Zone::default(), smoothing);
        clean.push(frame).1.clone()
    });
    let [raw, smooth] = clouds;
    let pictures = [coloured(frame), shaded(&raw), shaded(&smooth)];
    let width = frame.intrinsics.width as usize;
    let up = frame.camera_to_world.matrix3.transpose() * Vec3A::Y;
    if up.x.abs() > up.y.abs() {
        let turned = pictures.map(|picture| turned(&picture, width, up.x > 0.0));
        return write(&out, turned[0].len() / width, &turned);
    }
    write(&out, width, &pictures)
}

/// Two people before a Kinect, one of them behind the other.
fn room() -> Result<DepthFrame, Box<dyn Error>> {
    let [shopper, other] = [Sex::Female, Sex::Male].map(|sex| toile_assets::body::build(sex, &Measures::average(sex)));
    let (shopper, other) = (shopper?, other?);
    let moved: Vec<Vec3> = other.mesh.positions.iter().map(|p| *p + Vec3::new(0.35, 0.0, -0.55)).collect();
    let eye = Vec3::new(0.0, 1.2, 2.5);
    let camera = SyntheticCamera::looking_at(Intrinsics::KINECT_V1, eye, Vec3::new(0.0, 0.9, 0.0));
    let people: [room::RoomSurface<'_>; 2] =
        [(&shopper.mesh.positions, &shopper.mesh.triangles), (&moved, &other.mesh.triangles)];
    let view = room::view(&camera, -0.9, &people);
    Ok(camera.frame(0, KinectNoise::new(11).apply(&camera.intrinsics, &view.z)))
}

/// A picture of a camera that lies on its side, upright: its right or its left becomes the top.
fn turned(picture: &[[u8; 3]], width: usize, right_is_up: bool) -> Vec<[u8; 3]> {
    let height = picture.len() / width;
    let pixel = |i: usize| {
        let (u, v) = (i % height, i / height);
        if right_is_up { picture[u * width + width - 1 - v] } else { picture[(height - 1 - u) * width + v] }
    };
    (0..picture.len()).map(pixel).collect()
}

/// Depth from near (warm) to far (cold), black where nothing was measured.
fn coloured(frame: &DepthFrame) -> Vec<[u8; 3]> {
    let mut depths: Vec<u16> = frame.depth_mm.iter().copied().filter(|d| *d != 0).collect();
    depths.sort_unstable();
    let at = |share: usize| depths.get(depths.len() * share / 100).map_or(0.0, |d| f32::from(*d));
    let (near, far) = (at(1), at(98).max(at(1) + 1.0));
    let colour = |d: &u16| {
        if *d == 0 {
            return [0; 3];
        }
        let t = ((f32::from(*d) - near) / (far - near)).clamp(0.0, 1.0);
        // A smooth rainbow whose brightness falls with distance.
        let wave = |phase: f32| 0.5 + 0.5 * (std::f32::consts::TAU * (0.8 * t + phase)).cos();
        [wave(0.0), wave(0.67), wave(0.33)].map(|c| (255.0 * c * (1.0 - 0.4 * t)) as u8)
    };
    frame.depth_mm.iter().map(colour).collect()
}

/// The shopper lit from the camera, bluish where a hole was filled.
fn shaded(cloud: &Cloud) -> Vec<[u8; 3]> {
    let mut out = vec![[0; 3]; cloud.validity.len()];
    let eye = Vec3::from(cloud.camera_to_world.translation);
    for (i, point, normal) in cloud.known() {
        let light = 40.0 + 215.0 * normal.dot((eye - point).normalize_or_zero()).max(0.0).powi(2);
        let tint = if cloud.validity[i] == Validity::Filled { [0.5, 0.7, 1.0] } else { [1.0, 0.95, 0.88] };
        out[i] = tint.map(|t| (t * light) as u8);
    }
    out
}

fn write(path: &Path, width: usize, pictures: &[Vec<[u8; 3]>]) -> Result<(), Box<dyn Error>> {
    let height = pictures[0].len() / width;
    let mut bytes = Vec::new();
    for v in 0..height {
        for (i, picture) in pictures.iter().enumerate() {
            if i > 0 {
                bytes.extend([255; 3 * GAP]);
            }
            bytes.extend(picture[v * width..(v + 1) * width].iter().flatten());
        }
    }
    let total = (width + GAP) * pictures.len() - GAP;
    let mut encoder = png::Encoder::new(std::fs::File::create(path)?, total as u32, height as u32);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_compression(png::Compression::High);
    encoder.write_header()?.write_image_data(&bytes)?;
    Ok(())
}
