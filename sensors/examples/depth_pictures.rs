//! Pictures of a depth recording before and after cleaning: depth in colours, then the shopper alone, shaded.
//!
//! `cargo run --release -p toile-sensors --example depth_pictures -- RECORDING OUT.png [CAMERA.json]`

use std::error::Error;
use std::path::{Path, PathBuf};

use toile_sensors::depth::{Clean, Cloud, Smoothing, Validity};
use toile_sensors::frame::DepthFrame;
use toile_sensors::segment::Zone;
use toile_sensors::source::{OpenOptions, open};

/// White between the pictures (px).
const GAP: usize = 8;

fn main() -> Result<(), Box<dyn Error>> {
    let mut args = std::env::args_os().skip(1).map(PathBuf::from);
    let (Some(input), Some(out)) = (args.next(), args.next()) else {
        return Err("give a recording and a PNG to write".into());
    };
    let session = open(&input, &OpenOptions { camera: args.next() })?;
    let frame = session.depth.first().ok_or("the recording holds no depth")?;
    let clouds = [Smoothing::None, Clean::default().smoothing()].map(|smoothing| {
        let mut clean = Clean::new(Zone::default(), smoothing);
        clean.push(frame).1.clone()
    });
    let [raw, smooth] = clouds;
    let pictures = [coloured(frame), shaded(&raw), shaded(&smooth)];
    write(&out, frame.intrinsics.width as usize, &pictures)
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
    let eye = glam::Vec3::from(cloud.camera_to_world.translation);
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
