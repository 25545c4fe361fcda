//! The noise of a Kinect v1 depth camera (Nguyen, Izadi and Lovell 2012; quantisation and shadows after simkinect).

use std::f32::consts::FRAC_PI_2;

use glam::Vec3;

use toile_base::frame::Intrinsics;
use toile_base::numeric::random::SplitMix64;

/// Disparity times depth (m): 35130 / z in centimetres, steps of 2.85 mm at 1 m, growing with the square of depth.
const DISPARITY: f32 = 351.30;

/// Distance of the infrared projector from the camera (m), on the side of +x.
const BASELINE: f32 = 0.075;

/// A neighbour farther behind or before than this is another surface (m).
const DEPTH_EDGE: f32 = 0.05;

/// Angle from the line of sight at which the first pixels are lost (rad), 70 degrees, and at which none is left, 85.
const GRAZING: [f32; 2] = [70.0 * std::f32::consts::PI / 180.0, 85.0 * std::f32::consts::PI / 180.0];

/// Depths that the sensor measures (m).
const RANGE: [f32; 2] = [0.4, 8.0];

/// Angle at which the sigmas are cut (rad), where their poles come near: 85 degrees.
const STEEPEST: f32 = GRAZING[1];

/// Standard deviation of depth (m) at depth `z` (m) and angle `theta` (rad) between line of sight and surface normal.
///
/// ```text
/// .0012 + .0019 (z - .4)^2 + (.0001 / sqrt z) theta^2 / (pi/2 - theta)^2
/// ```
pub fn axial_sigma(z: f32, theta: f32) -> f32 {
    let theta = theta.clamp(0.0, STEEPEST);
    let slant = theta / (FRAC_PI_2 - theta);
    0.0012 + 0.0019 * (z - 0.4) * (z - 0.4) + 0.0001 / z.sqrt() * slant * slant
}

/// Standard deviation across the image (px): .8 + .035 theta / (pi/2 - theta).
pub fn lateral_sigma(theta: f32) -> f32 {
    let theta = theta.clamp(0.0, STEEPEST);
    0.8 + 0.035 * theta / (FRAC_PI_2 - theta)
}

/// The noise, with its own generator: the same seed and images give the same bits.
///
/// Each pixel, in order: lost in the projector's shadow, at grazing angles and out of range; taken from a place shifted by
/// the lateral sigma; disturbed by the axial sigma less what quantisation adds by itself (a twelfth of the squared step);
/// rounded to integer disparities. The published form of that rounding, `35130 / floor(35130/z + N(0, 1/6) + .5)` after a
/// rounding of its own, adds the half twice and pulls depth half a step nearer (6 mm at 2 m); here it is rounded once.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct KinectNoise {
    rng: SplitMix64,
}

impl KinectNoise {
    /// The noise of one sensor.
    pub const fn new(seed: u64) -> Self {
        Self { rng: SplitMix64::new(seed) }
    }

    /// A measured image (mm, 0 = nothing) of a rendered one (m, infinite = nothing), both `[width * height]`.
    ///
    /// # Panics
    /// If `z` has another length than the image.
    pub fn apply(&mut self, camera: &Intrinsics, z: &[f32]) -> Box<[u16]> {
        assert_eq!(z.len(), camera.pixels(), "a depth image of the camera's size");
        let mut out = vec![0u16; z.len()].into_boxed_slice();
        let width = camera.width as usize;
        let lit = lit(camera, z);
        for v in 0..camera.height as usize {
            for u in 0..width {
                let i = v * width + u;
                if lit[i] {
                    out[i] = self.pixel(camera, z, &lit, [u, v]);
                }
            }
        }
        out
    }

    fn pixel(&mut self, camera: &Intrinsics, z: &[f32], lit: &[bool], [u, v]: [usize; 2]) -> u16 {
        let theta = slant(camera, z, [u, v]);
        let lost = (theta - GRAZING[0]) / (GRAZING[1] - GRAZING[0]);
        if self.rng.uniform() < lost {
            return 0;
        }
        let sigma = lateral_sigma(theta);
        let [du, dv] = [self.rng.gaussian() * sigma, self.rng.gaussian() * sigma];
        let Some(depth) = shifted(camera, z, lit, [u, v], [du, dv]) else { return 0 };
        if !(RANGE[0]..=RANGE[1]).contains(&depth) {
            return 0;
        }
        let step = depth * depth / DISPARITY;
        let axial = axial_sigma(depth, theta);
        let rest = (axial * axial - step * step / 12.0).max(0.0).sqrt();
        let disparity = (DISPARITY / depth + rest / step * self.rng.gaussian()).round();
        let measured = DISPARITY / disparity.max(1.0);
        if measured > RANGE[1] { 0 } else { (measured * 1e3).round() as u16 }
    }
}

/// Depth at a place beside pixel (u, v). On the same surface the pixel's own depth is kept: the shift blurs outlines, and
/// what it would do to a slope is in the axial sigma already. `None` where the place is empty or dark.
fn shifted(camera: &Intrinsics, z: &[f32], lit: &[bool], [u, v]: [usize; 2], [du, dv]: [f32; 2]) -> Option<f32> {
    let (su, sv) = (u as f32 + du, v as f32 + dv);
    let inside = su > -0.5 && sv > -0.5 && su < camera.width as f32 - 0.5 && sv < camera.height as f32 - 0.5;
    let width = camera.width as usize;
    let here = z[v * width + u];
    if !inside {
        return Some(here);
    }
    let i = sv.round() as usize * width + su.round() as usize;
    if !lit[i] {
        return None;
    }
    Some(if (z[i] - here).abs() < DEPTH_EDGE { here } else { z[i] })
}

/// Which pixels the projector reaches. Along a row, what the projector sees keeps its order; a pixel that a nearer surface
/// towards the projector overtakes is in its shadow.
fn lit(camera: &Intrinsics, z: &[f32]) -> Vec<bool> {
    let mut lit = vec![false; z.len()];
    let width = camera.width as usize;
    for (row, lit) in z.chunks_exact(width).zip(lit.chunks_exact_mut(width)) {
        let mut nearest = f32::INFINITY;
        for u in (0..width).rev().filter(|u| row[*u].is_finite()) {
            let projected = u as f32 - camera.fx * BASELINE / row[u];
            lit[u] = projected < nearest;
            nearest = nearest.min(projected);
        }
    }
    lit
}

/// Angle between the line of sight and the surface normal (rad), from the neighbours on the same surface. A right angle,
/// which is lost, where a row or column has none: the sensor matches a window of pixels, and sees no single ones.
fn slant(camera: &Intrinsics, z: &[f32], [u, v]: [usize; 2]) -> f32 {
    let (width, height) = (camera.width as usize, camera.height as usize);
    let here = z[v * width + u];
    let point = |u: usize, v: usize| camera.unproject(u as f32, v as f32, z[v * width + u]);
    let same = |u: usize, v: usize| (z[v * width + u] - here).abs() < DEPTH_EDGE;
    let along = |[u0, v0]: [usize; 2], [u1, v1]: [usize; 2]| {
        let a = if same(u0, v0) { [u0, v0] } else { [u, v] };
        let b = if same(u1, v1) { [u1, v1] } else { [u, v] };
        (a != b).then(|| point(b[0], b[1]) - point(a[0], a[1]))
    };
    let across = along([u.saturating_sub(1), v], [(u + 1).min(width - 1), v]);
    let down = along([u, v.saturating_sub(1)], [u, (v + 1).min(height - 1)]);
    let (Some(across), Some(down)) = (across, down) else { return FRAC_PI_2 };
    let sight = point(u, v);
    let normal: Vec3 = across.cross(down);
    let cosine = normal.dot(sight).abs() / (normal.length() * sight.length());
    if cosine.is_finite() { cosine.clamp(0.0, 1.0).acos() } else { FRAC_PI_2 }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Small camera of the Kinect's focal length.
    const CAMERA: Intrinsics = Intrinsics { width: 160, height: 120, fx: 575.8, fy: 575.8, cx: 79.5, cy: 59.5 };

    /// Mean error and deviation (mm) of flat walls around a depth, so that every phase of the quantisation is met.
    fn wall(depth: f32) -> (f32, f32) {
        let mut noise = KinectNoise::new(3);
        let (mut sum, mut squares, mut count) = (0.0f64, 0.0f64, 0.0f64);
        for k in 0..16 {
            let z = depth + k as f32 * 0.003;
            for measured in noise.apply(&CAMERA, &vec![z; CAMERA.pixels()]).iter().filter(|d| **d != 0) {
                let error = f64::from(*measured) - f64::from(z) * 1e3;
                sum += error;
                squares += error * error;
                count += 1.0;
            }
        }
        let mean = sum / count;
        (mean as f32, (squares / count - mean * mean).sqrt() as f32)
    }

    #[test]
    fn a_wall_has_the_reference_sigma_and_no_bias() {
        for (depth, reference) in [(2.0, 6.0), (3.0, 14.0), (4.0, 26.0)] {
            let (bias, sigma) = wall(depth);
            println!("{depth} m: bias {bias:.2} mm, sigma {sigma:.2} mm (reference {reference})");
            let expected = axial_sigma(depth + 0.0225, 0.0) * 1e3;
            assert!((sigma / expected - 1.0).abs() < 0.03, "{depth} m: {sigma} against {expected} mm");
            assert!((expected - reference).abs() < 1.0, "{expected}");
            assert!(bias.abs() < 1.0, "{depth} m: {bias} mm");
        }
    }

    #[test]
    fn depths_are_integer_disparities() {
        let mut depths: Vec<u16> = KinectNoise::new(1).apply(&CAMERA, &vec![3.0; CAMERA.pixels()]).to_vec();
        depths.sort_unstable();
        depths.dedup();
        let steps: Vec<u16> = depths.windows(2).map(|w| w[1] - w[0]).filter(|s| *s < 60).collect();
        assert!(steps.iter().all(|s| (18..36).contains(s)), "{steps:?}");
    }

    #[test]
    fn a_slanted_wall_is_noisier_and_a_grazing_one_is_lost() {
        let plane = |degrees: f32| -> Vec<f32> {
            let slope = degrees.to_radians().tan();
            // z = 2 + slope x, with x = z (u - cx) / fx.
            (0..CAMERA.pixels()).map(|i| 2.0 / (1.0 - slope * ((i % 160) as f32 - 79.5) / 575.8)).collect()
        };
        let error = |degrees: f32| -> (f32, usize) {
            let z = plane(degrees);
            let measured = KinectNoise::new(5).apply(&CAMERA, &z);
            let seen: Vec<f32> =
                z.iter().zip(&measured).filter(|(_, d)| **d != 0).map(|(z, d)| f32::from(*d) / z / 1e3 - 1.0).collect();
            ((seen.iter().map(|e| e * e).sum::<f32>() / seen.len().max(1) as f32).sqrt(), seen.len())
        };
        let (flat, all) = error(0.0);
        let (steep, most) = error(65.0);
        assert_eq!(all, CAMERA.pixels());
        assert!(steep > 1.02 * flat && most > all / 2, "{flat} {steep} {most}");
        // The middle columns, for towards the image's edge the line of sight itself turns.
        let grazing = KinectNoise::new(5).apply(&CAMERA, &plane(88.0));
        let seen = grazing.iter().enumerate().filter(|(i, d)| (75..85).contains(&(i % 160)) && **d != 0).count();
        assert!(seen < 60, "{seen} of 1200");
    }

    #[test]
    fn a_near_object_casts_a_shadow_away_from_the_projector() {
        let mut z = vec![2.0; CAMERA.pixels()];
        for v in 0..120 {
            z[v * 160 + 60..v * 160 + 100].fill(1.0);
        }
        let measured = KinectNoise::new(9).apply(&CAMERA, &z);
        let lost = |range: std::ops::Range<usize>| range.filter(|u| measured[60 * 160 + u] == 0).count();
        // The shadow is f b (1/1 - 1/2) = 21.6 px wide, on the left.
        assert!(lost(42..57) == 15, "{}", lost(42..57));
        assert!(lost(110..150) == 0 && lost(0..30) == 0);
    }

    #[test]
    fn the_same_seed_gives_the_same_image() {
        let z = vec![2.5; CAMERA.pixels()];
        assert_eq!(KinectNoise::new(4).apply(&CAMERA, &z), KinectNoise::new(4).apply(&CAMERA, &z));
        assert_ne!(KinectNoise::new(4).apply(&CAMERA, &z), KinectNoise::new(5).apply(&CAMERA, &z));
    }
}
