//! Draws a film for `--camera webcam-file:FILM`: a woman moves for 9.4 s before a wall, 640 x 480 pixels, 30 Hz, YUYV.
//!
//! `cargo run --release -p toile-perf --example webcam_film -- film_640x480.yuyv`. The camera hangs 1.4 m above the floor and looks down by
//! 11 degrees.

use std::error::Error;
use std::fs::File;
use std::io::{BufWriter, Write};
use std::process::ExitCode;

use glam::{Affine3A, Vec3};
use toile_assets::people::sizes;
use toile_assets::scene::shopper;
use toile_base::numeric::random::SplitMix64;
use toile_base::skeleton::BONES;
use toile_engine::body::palette;
use toile_engine::skin::SkinningJob;
use toile_engine::world::BLEND;
use toile_view::image::Size;
use toile_view::scene::{Colours, MANNEQUIN, Material, OrbitCamera, PictureScene, PictureSurface};
use toile_view::trace::{TraceQuality, TracedScene};

/// Width and height (px), and the focal length of a webcam that sees 60 degrees (px).
const SIZE: [u32; 2] = [640, 480];
const FOCAL: f32 = 0.87 * 640.0;

/// Place of the camera, and the point at which it looks (m).
const PLACE: Vec3 = Vec3::new(0.0, 1.4, 2.8);
const TARGET: Vec3 = Vec3::new(0.0, 0.86, 0.0);

/// Standard deviation of the camera's noise (of 255).
const NOISE: f32 = 2.0;

/// Number of pictures, and their rate (Hz).
const PICTURES: u32 = 282;
const RATE_HZ: f32 = 30.0;

fn film(path: &str) -> Result<(), Box<dyn Error>> {
    let mut out = BufWriter::new(File::create(path)?);
    let body = sizes()[1].body()?;
    let mut random = SplitMix64::new(0);
    let job = SkinningJob::new(&body.mesh.positions, &body.normals, &body.weights)?;
    let (mut skin, mut normals, mut posed) = (body.mesh.positions.clone(), body.normals.clone(), job.posed());
    let mut bones = [Affine3A::IDENTITY; BONES];
    let away = TARGET - PLACE;
    let view = OrbitCamera {
        target: TARGET,
        yaw: 0.0,
        height: -away.y,
        distance: -away.z,
        fov_y: 2.0 * (0.5 * SIZE[1] as f32 / FOCAL).atan(),
    };
    for number in 0..PICTURES {
        palette(&body.skeleton, &shopper(&body.skeleton, number as f32 / RATE_HZ), &mut bones);
        job.run(BLEND, &bones, &mut posed);
        posed.read(&mut skin, &mut normals);
        let surface = PictureSurface {
            positions: &skin,
            normals: &normals,
            triangles: &body.mesh.triangles,
            colours: Colours::One(MANNEQUIN),
            material: Material::Skin,
            look: None,
        };
        let surfaces = [surface];
        let scene = TracedScene::build(PictureScene { surfaces: &surfaces, floor: true });
        let image = scene.render(&view, Size::new(SIZE[0], SIZE[1]), TraceQuality::Motion);
        let mut noisy = |v: u8| (f32::from(v) + NOISE * random.gaussian()).round().clamp(0.0, 255.0);
        let rgb: Vec<f32> = image.bytes().iter().map(|v| noisy(*v)).collect();
        out.write_all(&yuyv(&rgb))?;
    }
    Ok(out.flush()?)
}

/// The picture as a webcam sends it, by BT.601 with a brightness of 16 to 235.
fn yuyv(rgb: &[f32]) -> Vec<u8> {
    let two_pixels = |&[r0, g0, b0, r1, g1, b1]: &[f32; 6]| {
        let light = |r: f32, g: f32, b: f32| 16.0 + 0.257 * r + 0.504 * g + 0.098 * b;
        let [r, g, b] = [0.5 * (r0 + r1), 0.5 * (g0 + g1), 0.5 * (b0 + b1)];
        let (u, v) = (128.0 - 0.148 * r - 0.291 * g + 0.439 * b, 128.0 + 0.439 * r - 0.368 * g - 0.071 * b);
        [light(r0, g0, b0), u, light(r1, g1, b1), v].map(|x| x.round().clamp(0.0, 255.0) as u8)
    };
    rgb.as_chunks::<6>().0.iter().flat_map(two_pixels).collect()
}

fn main() -> ExitCode {
    let path = std::env::args().nth(1).filter(|path| path.ends_with("_640x480.yuyv"));
    let Some(path) = path else {
        eprintln!("give one file; its name has to end in _640x480.yuyv");
        return ExitCode::from(2);
    };
    match film(&path) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{path}: {error}");
            ExitCode::from(4)
        }
    }
}
