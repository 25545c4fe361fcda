//! A picture as a camera takes it: several samples a pixel, blurred by the lens, with noise, in eight bits.

use std::f32::consts::TAU;

use glam::{DMat3, DVec2, DVec3};
use image::RgbImage;
use toile_base::numeric::random::SplitMix64;
use toile_sensors::calibration::CalibratedCamera;

use super::scene::{Bar, Lighting, PrintedSurface};
use toile_pose::depth_buffer::DepthBuffer;

/// Colour of the room behind, 0 to 1, and how much it varies.
const ROOM: [f32; 3] = [0.36, 0.37, 0.40];
const ROOM_VARIES: f32 = 0.06;

/// Colour of the bar.
const BAR: [f32; 3] = [0.74, 0.56, 0.46];

/// What a camera adds to what is before it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sensor {
    /// Samples along each side of a pixel.
    pub samples: usize,
    /// Standard deviation of the lens' blur (px).
    pub blur: f32,
    /// Standard deviation of the noise, of 255.
    pub noise: f32,
    /// Brightness of all of its pictures: 1 as they are.
    pub exposure: f32,
    /// Of the noise.
    pub seed: u64,
}

impl Default for Sensor {
    fn default() -> Self {
        Self { samples: 2, blur: 0.7, noise: 2.0, exposure: 1.0, seed: 1 }
    }
}

/// The picture of a moment.
pub fn take(
    surface: &PrintedSurface,
    light: &Lighting,
    bars: &[Bar],
    camera: &CalibratedCamera,
    sensor: &Sensor,
) -> RgbImage {
    let mut buffer = DepthBuffer::new(camera.size, sensor.samples as f64);
    buffer.draw(&camera.straightened(), surface.positions, surface.triangles);
    let [w, h] = camera.size.map(|s| s as usize);
    let mut linear = vec![[0.0f32; 3]; w * h];
    let share = 255.0 * sensor.exposure / (sensor.samples * sensor.samples) as f32;
    for y in 0..h {
        for x in 0..w {
            let mut sum = [0.0; 3];
            for k in 0..sensor.samples * sensor.samples {
                let within = |k: usize| (k as f64 + 0.5) / sensor.samples as f64 - 0.5;
                let at = DVec2::new(x as f64 + within(k % sensor.samples), y as f64 + within(k / sensor.samples));
                let colour = sample(surface, light, bars, camera, &buffer, at);
                sum.iter_mut().zip(colour).for_each(|(s, c)| *s += c);
            }
            linear[y * w + x] = sum.map(|s| s * share);
        }
    }
    let blurred = blur(&linear, w, h, sensor.blur);
    let mut random = SplitMix64::new(sensor.seed);
    RgbImage::from_fn(w as u32, h as u32, |x, y| {
        let pixel = blurred[y as usize * w + x as usize];
        image::Rgb(pixel.map(|c| (c + sensor.noise * normal(&mut random)).round().clamp(0.0, 255.0) as u8))
    })
}

/// A normal deviate (Box and Muller 1958).
fn normal(random: &mut SplitMix64) -> f32 {
    let (a, b) = (1.0 - random.uniform(), random.uniform());
    (-2.0 * a.ln()).sqrt() * (TAU * b).cos()
}

fn sample(
    surface: &PrintedSurface,
    light: &Lighting,
    bars: &[Bar],
    camera: &CalibratedCamera,
    buffer: &DepthBuffer,
    at: DVec2,
) -> [f32; 3] {
    let ray = if camera.is_bent() { camera.ray(at) } else { (at - camera.centre()) / camera.focal() };
    let along = camera.rotation().transpose() * ray.extend(1.0);
    let (from, unit) = (camera.position(), along.normalize());
    let straight = (ray * camera.focal() + camera.centre() + 0.5) * buffer.scale - 0.5;
    let (x, y) = (straight.x.round(), straight.y.round());
    let inside = x >= 0.0 && y >= 0.0 && x < buffer.width as f64 && y < buffer.height as f64;
    let triangle = if inside { buffer.triangle[y as usize * buffer.width + x as usize] } else { u32::MAX };
    let cloth = surface.triangles.get(triangle as usize).map(|t| shade(surface, light, *t, from, unit));
    let bar = bars.iter().filter_map(|b| b.hit(from, unit)).min_by(|a, b| a.0.total_cmp(&b.0));
    match (cloth, bar) {
        (Some((depth, colour)), None) if depth > 0.0 => colour,
        (Some(_), None) => ROOM,
        (Some((depth, colour)), Some((t, _))) if depth < t => colour,
        (_, Some((t, n))) => BAR.map(|c| c * light.on(from + unit * t, n)),
        (None, None) => {
            let vary = (at.x * 0.013).sin() + (at.y * 0.017).cos();
            ROOM.map(|c| c + ROOM_VARIES * vary as f32)
        }
    }
}

/// Depth along a ray and colour of a triangle, taken where the ray meets its plane.
fn shade(surface: &PrintedSurface, light: &Lighting, corners: [u32; 3], from: DVec3, along: DVec3) -> (f64, [f32; 3]) {
    let [a, b, c] = corners.map(|v| surface.positions[v as usize]);
    // from + t along = a + u (b - a) + v (c - a).
    let solved = DMat3::from_cols(-along, b - a, c - a).inverse() * (from - a);
    let (t, wb, wc) = (solved.x, solved.y.clamp(0.0, 1.0) as f32, solved.z.clamp(0.0, 1.0) as f32);
    let [ua, ub, uc] = corners.map(|v| surface.uvs[v as usize]);
    let uv = ua + (ub - ua) * wb + (uc - ua) * wc;
    let bright = light.on(from + along * t, (b - a).cross(c - a).normalize_or_zero());
    (t, surface.print.at(uv.x, uv.y).map(|k| k * bright))
}

/// Gaussian blur of a standard deviation (px).
fn blur(pixels: &[[f32; 3]], w: usize, h: usize, sigma: f32) -> Vec<[f32; 3]> {
    if sigma <= 0.0 {
        return pixels.to_vec();
    }
    let reach = (3.0 * sigma).ceil() as isize;
    let kernel: Vec<f32> = (-reach..=reach).map(|d| (-0.5 * (d as f32 / sigma).powi(2)).exp()).collect();
    let whole: f32 = kernel.iter().sum();
    let pass = |from: &[[f32; 3]], rows: bool| {
        let mut to = vec![[0.0; 3]; from.len()];
        for (i, out) in to.iter_mut().enumerate() {
            let (x, y) = (i % w, i / w);
            for (k, d) in kernel.iter().zip(-reach..) {
                let (x, y) = if rows {
                    (x.saturating_add_signed(d).min(w - 1), y)
                } else {
                    (x, y.saturating_add_signed(d).min(h - 1))
                };
                out.iter_mut().zip(from[y * w + x]).for_each(|(o, c)| *o += c * k / whole);
            }
        }
        to
    };
    pass(&pass(pixels, true), false)
}
