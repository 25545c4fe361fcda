//! Noise models that are not the first study's: of structured light after Khoshelham and Elberink (2012), of a time of
//! flight whose pixels mix what they see at an edge.
//!
//! Noise of neighbouring pixels goes together here (a disparity is matched over a window), outlines are ragged in blocks,
//! the projector casts a shadow, depth has a slow ripple: what a fit may not have been tuned on.

use toile_base::frame::Intrinsics;
use toile_base::numeric::random::SplitMix64;

/// Standard deviation of a structured light camera's depth over the square of the depth (1/m): 1.425e-5 in centimetres,
/// Khoshelham and Elberink (2012), equation 10.
const RANDOM: f32 = 1.425e-3;

/// Share of that which is the same in a window of matching.
const SHARED: f32 = 0.6;

/// Side of a window of matching (px).
const WINDOW: usize = 7;

/// Baseline between projector and camera (m).
const BASELINE: f32 = 0.075;

/// Steps of a disparity in a pixel.
const STEPS: f32 = 8.0;

/// How far an outline is displaced, block by block (px).
const RAGGED: f32 = 0.9;

/// Jump of depth that is an edge (m).
const EDGE: f32 = 0.05;

/// Standard deviation of a time of flight at 1 m, what each square metre adds, and what a grazing surface multiplies (m).
const FLIGHT: [f32; 3] = [0.0010, 0.0003, 1.5];

/// Height (m) and length (m) of the ripple of a time of flight over the distance, from higher harmonics of its signal.
const RIPPLE: [f32; 2] = [0.0015, 0.47];

/// Share of a pixel's light that comes from its neighbours.
const SPREAD: f32 = 0.20;

/// A mixed pixel farther from every surface than this is recognised as mixed and left out (m).
const MIXED: f32 = 0.10;

/// A field of numbers that neighbouring pixels share: independent at the corners of windows, blended between them.
struct Field {
    across: usize,
    values: Vec<f32>,
}

impl Field {
    fn new(width: usize, height: usize, rng: &mut SplitMix64) -> Self {
        let (across, down) = (width / WINDOW + 2, height / WINDOW + 2);
        Self { across, values: (0..across * down).map(|_| rng.gaussian()).collect() }
    }

    /// The number at a pixel.
    fn at(&self, u: usize, v: usize) -> f32 {
        let (c, r) = (u / WINDOW, v / WINDOW);
        let (s, t) = ((u % WINDOW) as f32 / WINDOW as f32, (v % WINDOW) as f32 / WINDOW as f32);
        let corner = |dc: usize, dr: usize| self.values[(r + dr) * self.across + c + dc];
        let (top, low) = (corner(0, 0) * (1.0 - s) + corner(1, 0) * s, corner(0, 1) * (1.0 - s) + corner(1, 1) * s);
        // Blending four numbers leaves four ninths of the variance on average.
        (top * (1.0 - t) + low * t) * 1.5
    }
}

/// A structured light image (mm, 0 = nothing) of a rendered one (m, infinite where nothing is).
pub(super) fn structured_light(camera: &Intrinsics, image: &[f32], rng: &mut SplitMix64) -> Box<[u16]> {
    let (width, height) = (camera.width as usize, camera.height as usize);
    let (shared, across, down) =
        (Field::new(width, height, rng), Field::new(width, height, rng), Field::new(width, height, rng));
    let lit = shadow(camera, image);
    let mut out = vec![0u16; image.len()].into_boxed_slice();
    for v in 2..height - 2 {
        for u in 2..width - 2 {
            let from =
                |offset: f32, at: usize| at.saturating_add_signed((RAGGED * offset).round().clamp(-2.0, 2.0) as isize);
            let i = from(down.at(u, v), v) * width + from(across.at(u, v), u);
            let z = image[i];
            if !z.is_finite() || !lit[i] {
                continue;
            }
            let noise = SHARED.sqrt() * shared.at(u, v) + (1.0 - SHARED).sqrt() * rng.gaussian();
            // The noise is one of disparity, and comes out in whole steps of it.
            let disparity = camera.fx * BASELINE / z;
            let measured = disparity + noise * RANDOM * camera.fx * BASELINE;
            let stepped = (measured * STEPS).round() / STEPS;
            out[v * width + u] = (camera.fx * BASELINE / stepped * 1e3).round().clamp(0.0, 65_000.0) as u16;
        }
    }
    out
}

/// Which pixels the projector lights: it stands a baseline beside the camera, and what is nearer hides what is behind.
fn shadow(camera: &Intrinsics, image: &[f32]) -> Vec<bool> {
    let width = camera.width as usize;
    let mut lit = vec![true; image.len()];
    for (row, lit) in image.chunks_exact(width).zip(lit.chunks_exact_mut(width)) {
        // From the projector's side on, the greatest of its columns that something nearer has taken.
        let mut taken = f32::MIN;
        for (u, &z) in row.iter().enumerate() {
            if z.is_finite() {
                let column = u as f32 + camera.fx * BASELINE / z;
                lit[u] = column >= taken - 0.5;
                taken = taken.max(column);
            }
        }
    }
    lit
}

/// An image by the time of flight (mm, 0 = nothing) of a rendered one (m), all of it off by `offset` (m).
pub(super) fn time_of_flight(camera: &Intrinsics, image: &[f32], offset: f32, rng: &mut SplitMix64) -> Box<[u16]> {
    let (width, height) = (camera.width as usize, camera.height as usize);
    let mut out = vec![0u16; image.len()].into_boxed_slice();
    for v in 1..height - 1 {
        for u in 1..width - 1 {
            let i = v * width + u;
            let around = [i, i - 1, i + 1, i - width, i + width];
            if !image[i].is_finite() {
                continue;
            }
            // Light of neighbours adds to a pixel's own, the nearer the stronger.
            let (mut sum, mut whole) = (0.0, 0.0);
            for (k, j) in around.into_iter().enumerate().filter(|(_, j)| image[*j].is_finite()) {
                let share = if k == 0 { 1.0 - SPREAD } else { SPREAD / 4.0 };
                let light = share / (image[j] * image[j]);
                sum += light * image[j];
                whole += light;
            }
            let z = sum / whole;
            if around.iter().all(|j| (image[*j] - z).abs() > MIXED) {
                continue;
            }
            let (dx, dy) = (image[i + 1] - image[i - 1], image[i + width] - image[i - width]);
            let edge = around.iter().any(|j| !image[*j].is_finite() || (image[*j] - image[i]).abs() >= EDGE);
            let pixel = 2.0 * z / camera.fx;
            let slope = if edge { 0.0 } else { (dx * dx + dy * dy).sqrt() / pixel };
            let slant = (1.0 + slope * slope).sqrt();
            if slant > 9.0 {
                continue;
            }
            let sigma = (FLIGHT[0] + FLIGHT[1] * z * z) * (1.0 + FLIGHT[2] * (slant - 1.0) / 8.0);
            let ripple = RIPPLE[0] * (std::f32::consts::TAU * z / RIPPLE[1]).sin();
            out[i] = ((z + offset + ripple + sigma * rng.gaussian()) * 1e3).round().clamp(0.0, 65_000.0) as u16;
        }
    }
    out
}
