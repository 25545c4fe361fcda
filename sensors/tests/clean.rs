//! Smoothing and filling: what they do to noise, to edges and to holes, on surfaces that are known.

use glam::Affine3A;
use toile_base::frame::{DepthFrame, Intrinsics};
use toile_base::numeric::random::SplitMix64;
use toile_sensors::depth::fill::Fill;
use toile_sensors::depth::gaussian::Gaussian;
use toile_sensors::depth::smooth::{EdgePreserving, plain};
use toile_sensors::depth::{SensorNoise, Validity};
use toile_sensors::source::synthetic::KinectNoise;

const K: Intrinsics = Intrinsics { width: 160, height: 120, fx: 575.8, fy: 575.8, cx: 79.5, cy: 59.5 };
const NOISE: SensorNoise = SensorNoise::KINECT_V1;

fn smoothed(width: usize, depth: &[u16]) -> Vec<f32> {
    let mut out = Vec::new();
    EdgePreserving::default().run(width, depth, &NOISE, &mut out);
    out
}

/// Root mean square error of valid pixels within 20 px of the border (mm).
fn rms(truth: &[f32], got: impl Fn(usize) -> f32) -> f64 {
    let inner = |i: &usize| (20..140).contains(&(i % 160)) && (20..100).contains(&(i / 160));
    let errors: Vec<f64> =
        (0..truth.len()).filter(inner).filter(|i| got(*i) > 0.0).map(|i| f64::from(got(i) - truth[i] * 1e3)).collect();
    (errors.iter().map(|e| e * e).sum::<f64>() / errors.len() as f64).sqrt()
}

#[test]
fn the_fast_filter_gives_the_bits_of_the_plain_one() {
    let mut rng = SplitMix64::new(5);
    for (width, height) in [(1, 1), (3, 2), (9, 40), (37, 23), (160, 120)] {
        let image: Vec<u16> = (0..width * height)
            .map(|i| match rng.next_u64() % 10 {
                0 => 0,
                1 => rng.next_u64() as u16,
                _ => (2000 + 300 * usize::from(i % width > width / 2)) as u16 + (rng.next_u64() % 30) as u16,
            })
            .collect();
        let bits = |all: Vec<f32>| all.into_iter().map(f32::to_bits).collect::<Vec<_>>();
        assert_eq!(bits(smoothed(width, &image)), bits(plain(width, &image, &NOISE)), "{width} x {height}");
    }
}

#[test]
fn noise_falls_to_a_third_and_a_slope_does_not_move() {
    for (depth, slope) in [(1.5f32, 0.0f32), (2.5, 0.0), (3.5, 0.0), (2.5, 1.0)] {
        // z = depth + slope x.
        let z: Vec<f32> = (0..K.pixels()).map(|i| depth / (1.0 - slope * ((i % 160) as f32 - K.cx) / K.fx)).collect();
        let measured = KinectNoise::new(3).apply(&K, &z);
        let out = smoothed(160, &measured);
        let (before, after) = (rms(&z, |i| f32::from(measured[i])), rms(&z, |i| out[i]));
        let bias = out.iter().zip(&z).map(|(o, z)| f64::from(o - z * 1e3)).sum::<f64>() / z.len() as f64;
        println!("{depth} m, slope {slope}: {before:.2} -> {after:.2} mm, bias {bias:.2}");
        assert!(after < 0.34 * before, "{depth} m: {before} -> {after}");
        assert!(bias.abs() < 1.0, "{depth}: {bias}");
    }
}

/// Pixels over which an edge between two depths (mm) goes from 10 to 90 %, mean of the rows.
fn blur(out: &[f32], [near, far]: [f32; 2]) -> f32 {
    let between = |row: &[f32]| row.iter().filter(|z| (0.1..0.9).contains(&((**z - near) / (far - near)))).count();
    out.chunks_exact(160).map(|row| between(row) as f32).sum::<f32>() / 120.0
}

#[test]
fn an_edge_stays_an_edge_where_the_gaussian_blurs_it() {
    let z: Vec<f32> = (0..K.pixels()).map(|i| if i % 160 < 80 { 2.3 } else { 2.5 }).collect();
    let mut rng = SplitMix64::new(8);
    let image: Vec<u16> =
        z.iter().map(|z| (z * 1e3 + rng.gaussian() * NOISE.sigma_mm(z * 1e3)).round() as u16).collect();
    let raw: Vec<f32> = image.iter().map(|d| f32::from(*d)).collect();
    let mut gaussian = Vec::new();
    Gaussian::default().run(160, &image, 2.0, &mut gaussian);
    let [before, kept, blurred] = [&raw, &smoothed(160, &image), &gaussian].map(|out| blur(out, [2300.0, 2500.0]));
    println!("edge of 200 mm at 2.4 m: {before:.2} px before, {kept:.2} px after, {blurred:.2} px by the Gaussian");
    assert!(kept < 0.1 + before && blurred > 3.0, "{before} {kept} {blurred}");
}

fn frame(depth: Vec<u16>) -> DepthFrame {
    DepthFrame { time_ns: 0, intrinsics: K, camera_to_world: Affine3A::IDENTITY, depth_mm: depth.into() }
}

#[test]
fn holes_are_filled_and_gaps_are_not() {
    let at = |u: usize, v: usize| v * 160 + u;
    // A slope of 1 mm a pixel, with a hole of 6 x 4 pixels, a slit of 20 x 60, a gap that shows a wall, a ragged outline.
    let mut depth: Vec<u16> = (0..K.pixels()).map(|i| 1500 + (i % 160) as u16).collect();
    let cut = |us: std::ops::Range<usize>, vs: std::ops::Range<usize>, to: u16, depth: &mut Vec<u16>| {
        vs.for_each(|v| us.clone().for_each(|u| depth[at(u, v)] = to));
    };
    cut(40..46, 30..34, 0, &mut depth);
    cut(80..100, 20..80, 0, &mut depth);
    cut(120..124, 50..54, 3000, &mut depth);
    cut(0..10, 0..120, 0, &mut depth);
    let mask: Vec<u8> = depth.iter().map(|d| u8::from((1000..2000).contains(d))).collect();
    let mut fill = Fill::default();
    fill.run(&frame(depth), &mask);
    for v in 30..34 {
        for u in 40..46 {
            assert_eq!(fill.validity()[at(u, v)], Validity::Filled);
            assert!(fill.depth_mm()[at(u, v)].abs_diff(1500 + u as u16) <= 1);
        }
    }
    let known = |u, v| fill.validity()[at(u, v)] != Validity::Nothing;
    assert!(!known(90, 50) && !known(122, 52) && !known(5, 60) && known(60, 60));
    let filled = fill.validity().iter().filter(|v| **v == Validity::Filled).count();
    assert_eq!(filled, 24);
}

#[test]
fn the_seeds_gaussian_fills_with_the_mean_and_keeps_a_plane() {
    let image: Vec<u16> = (0..K.pixels()).map(|i| if i % 160 < 80 { 2000 } else { 0 }).collect();
    let mut out = Vec::new();
    Gaussian::default().run(160, &image, 2.0, &mut out);
    assert!(out.iter().zip(&image).all(|(o, d)| if *d == 0 { *o == 0.0 } else { (o - 2000.0).abs() < 0.01 }));
}
