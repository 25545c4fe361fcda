//! The truth of the scene, and the errors of the stages against it.

use glam::{Quat, Vec3};
use serde::Serialize;
use toile_assets::body::BodyError;
use toile_base::body::{Body, Measures, Sex};
use toile_base::frame::{DepthFrame, Intrinsics};
use toile_base::numeric::random::SplitMix64;
use toile_sensors::depth::gaussian::Gaussian;
use toile_sensors::depth::smooth::{EdgePreserving, plain};
use toile_sensors::depth::{Clean, DepthSmoothing, SensorNoise};
use toile_sensors::segment::{Segmenter, Zone};
use toile_sensors::source::synthetic::room::{self, PERSON, RoomView};
use toile_sensors::source::synthetic::{KinectNoise, SyntheticCamera};

/// Deviation of the seed's Gaussian (px).
pub(super) const GAUSSIAN_PX: f32 = 2.0;

/// Where the other one stands, behind and beside the shopper (m).
const OTHER: Vec3 = Vec3::new(0.35, 0.0, -0.55);

/// A disagreement larger than this is another surface, not noise (m).
const OUTLIER: f32 = 0.05;

/// How far the noise shifts outlines (px): there the truth is not known.
const OUTLINE: isize = 4;

/// Two people in front of the camera.
pub(super) struct People([Body; 2]);

/// What a camera sees of them, and what is really there.
pub(super) struct DepthScene {
    view: RoomView,
    pub frame: DepthFrame,
}

/// Errors of the stages: raw, edge-preserving and Gaussian where there are three.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct DepthErrors {
    /// Of the shopper's points along the camera's z, root mean square (mm).
    pub body_rms_mm: [f64; 3],
    /// Of a wall at 2.5 m, root mean square (mm).
    pub wall_rms_mm: [f64; 3],
    /// Pixels over which an edge of 20 cm goes from 10 to 90 %.
    pub edge_px: [f64; 3],
    /// Pixels in which the fast filter and its scalar reference differ.
    pub twin_differs_px: usize,
    /// Pixels of the mask that show anything but the shopper.
    pub leaked_px: usize,
    /// Measured pixels of the shopper that are not in the mask (%).
    pub missed_percent: f64,
}

impl People {
    pub fn new() -> Result<Self, BodyError> {
        let body = |sex| toile_assets::body::build(sex, &Measures::average(sex));
        Ok(Self([body(Sex::Female)?, body(Sex::Male)?]))
    }

    /// Both before a camera, the shopper 2.5 m from it.
    pub fn before(&self, intrinsics: Intrinsics) -> DepthScene {
        let camera = SyntheticCamera::looking_at(intrinsics, Vec3::new(0.0, 1.2, 2.5), Vec3::new(0.0, 0.9, 0.0));
        let [shopper, other] = &self.0;
        let turned = Quat::from_rotation_y(0.3);
        let moved: Vec<Vec3> = other.mesh.positions.iter().map(|p| turned * *p + OTHER).collect();
        let people: [room::RoomSurface<'_>; 2] =
            [(&shopper.mesh.positions, &shopper.mesh.triangles), (&moved, &other.mesh.triangles)];
        let view = room::view(&camera, -0.9, &people);
        let depth = KinectNoise::new(11).apply(&intrinsics, &view.z);
        DepthScene { view, frame: camera.frame(0, depth) }
    }
}

pub(super) fn errors(scene: &DepthScene) -> DepthErrors {
    let (leaked_px, missed_percent) = mask_errors(scene);
    let k = scene.frame.intrinsics;
    let noise = SensorNoise::KINECT_V1;
    let [wall, edge] = [wall(&k), edge(&k)];
    let flat = |z: &[f32]| rms(z.iter().map(|z| f64::from(z - 2500.0)));
    let blur = |z: &[f32]| edge_px(&k, z);
    let mut fast = Vec::new();
    let raw = &scene.frame.depth_mm;
    EdgePreserving::default().run(k.width as usize, raw, &noise, &mut fast);
    let reference = plain(k.width as usize, raw, &noise);
    DepthErrors {
        body_rms_mm: [
            DepthSmoothing::None,
            DepthSmoothing::EdgePreserving(noise),
            DepthSmoothing::Gaussian(GAUSSIAN_PX),
        ]
        .map(|smoothing| body_rms_mm(scene, smoothing)),
        wall_rms_mm: three(&k, &wall).each_ref().map(|z| flat(z)),
        edge_px: three(&k, &edge).each_ref().map(|z| blur(z)),
        twin_differs_px: fast.iter().zip(&reference).filter(|(a, b)| a.to_bits() != b.to_bits()).count(),
        leaked_px,
        missed_percent,
    }
}

fn rms(errors: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = errors.fold((0.0, 0.0), |(sum, count), e| (sum + e * e, count + 1.0));
    (sum / f64::max(count, 1.0)).sqrt()
}

/// An image raw, smoothed along surfaces, and by the Gaussian (mm).
fn three(k: &Intrinsics, image: &[u16]) -> [Vec<f32>; 3] {
    let width = k.width as usize;
    let raw = image.iter().map(|d| f32::from(*d)).collect();
    let (mut kept, mut blurred) = (Vec::new(), Vec::new());
    EdgePreserving::default().run(width, image, &SensorNoise::KINECT_V1, &mut kept);
    Gaussian::default().run(width, image, GAUSSIAN_PX, &mut blurred);
    [raw, kept, blurred]
}

fn wall(k: &Intrinsics) -> Vec<u16> {
    KinectNoise::new(5).apply(k, &vec![2.5; k.pixels()]).into_vec()
}

/// Two walls, 2.3 and 2.5 m away, that meet in the middle of the image, with the sensor's noise along its axis alone, so
/// that the edge is where it is.
fn edge(k: &Intrinsics) -> Vec<u16> {
    let mut rng = SplitMix64::new(8);
    let mut pixel = |i: usize| {
        let z: f32 = if i % (k.width as usize) < k.width as usize / 2 { 2300.0 } else { 2500.0 };
        (z + rng.gaussian() * SensorNoise::KINECT_V1.sigma_mm(z)).round() as u16
    };
    (0..k.pixels()).map(&mut pixel).collect()
}

/// Pixels of a row, on the mean, whose depth lies between 10 and 90 % of the edge.
fn edge_px(k: &Intrinsics, z: &[f32]) -> f64 {
    let between = z.iter().filter(|z| (0.1..0.9).contains(&((**z - 2300.0) / 200.0))).count();
    between as f64 / f64::from(k.height)
}

fn body_rms_mm(scene: &DepthScene, smoothing: DepthSmoothing) -> f64 {
    let mut clean = Clean::new(Zone::default(), smoothing);
    let (_, cloud) = clean.push(&scene.frame);
    let inverse = scene.frame.camera_to_world.inverse();
    let seen = cloud.known().filter(|(i, ..)| scene.view.label[*i] == PERSON);
    let errors = seen.map(|(i, p, _)| inverse.transform_point3(p).z - scene.view.z[i]);
    rms(errors.filter(|e| e.abs() < OUTLIER).map(|e| f64::from(e) * 1e3))
}

fn mask_errors(scene: &DepthScene) -> (usize, f64) {
    let mut segmenter = Segmenter::default();
    let mask = segmenter.push(&scene.frame).mask;
    let k = scene.frame.intrinsics;
    let (width, height) = (k.width as isize, k.height as isize);
    let is_shopper = |i: usize| scene.view.label[i] == PERSON;
    let near = |i: usize| {
        let (u, v) = (i as isize % width, i as isize / width);
        let beside = |du: isize, dv: isize| {
            let (x, y) = (u + du, v + dv);
            (0..width).contains(&x) && (0..height).contains(&y) && is_shopper((y * width + x) as usize)
        };
        (-OUTLINE..=OUTLINE).any(|dv| (-OUTLINE..=OUTLINE).any(|du| beside(du, dv)))
    };
    let leaked = (0..mask.len()).filter(|i| mask[*i] == 1 && !near(*i)).count();
    let shown = (0..mask.len()).filter(|i| is_shopper(*i) && scene.frame.depth_mm[*i] != 0);
    let (missed, all) = shown.fold((0, 0), |(missed, all), i| (missed + u32::from(mask[i] == 0), all + 1u32));
    (leaked, 100.0 * f64::from(missed) / f64::from(all.max(1)))
}
