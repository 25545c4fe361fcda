//! The time of each stage.

use std::hint::black_box;

use serde::Serialize;
use toile_fitting::timing::median_us;
use toile_sensors::depth::fill::Fill;
use toile_sensors::depth::gaussian::Gaussian;
use toile_sensors::depth::smooth::{EdgePreserving, plain};
use toile_sensors::depth::{Clean, Cloud, SensorNoise};
use toile_sensors::segment::Segmenter;

use super::truth::{DepthScene, GAUSSIAN_PX};

/// What each stage takes for one frame (us, median).
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct StageTimes {
    /// The shopper found: cells, floor, pieces, people, mask.
    pub segment: f64,
    /// Filling holes in the shopper's depth.
    pub fill: f64,
    /// The shopper's depth smoothed along surfaces.
    pub smooth: f64,
    /// The same of the whole image, shopper and room.
    pub smooth_whole: f64,
    /// The same by the scalar reference.
    pub smooth_plain: f64,
    /// The seed's Gaussian in its place.
    pub gaussian: f64,
    /// Points and normals.
    pub cloud: f64,
    /// All stages of [`Clean`] together.
    pub all: f64,
}

/// Times the stages on a scene; gives the shopper's pixels too.
pub(super) fn time(scene: &DepthScene) -> (StageTimes, usize) {
    let frame = &scene.frame;
    let width = frame.intrinsics.width as usize;
    let noise = SensorNoise::KINECT_V1;
    let mut segmenter = Segmenter::default();
    let mask = segmenter.push(frame).mask.to_vec();
    let (mut fill, mut smoother, mut gaussian) = (Fill::default(), EdgePreserving::default(), Gaussian::default());
    fill.run(frame, &mask);
    let depth = fill.depth_mm().to_vec();
    let mut out = Vec::new();
    smoother.run(width, &depth, &noise, &mut out);
    let smoothed = out.clone();
    let (mut cloud, mut clean) = (Cloud::default(), Clean::default());
    let stages = StageTimes {
        segment: median_us(|| {
            black_box(segmenter.push(black_box(frame)));
        }),
        fill: median_us(|| fill.run(black_box(frame), &mask)),
        smooth: median_us(|| smoother.run(width, black_box(&depth), &noise, &mut out)),
        smooth_whole: median_us(|| smoother.run(width, black_box(&frame.depth_mm), &noise, &mut out)),
        smooth_plain: median_us(|| {
            black_box(plain(width, black_box(&frame.depth_mm), &noise));
        }),
        gaussian: median_us(|| gaussian.run(width, black_box(&depth), GAUSSIAN_PX, &mut out)),
        cloud: median_us(|| cloud.update(black_box(frame), &smoothed, fill.validity())),
        all: median_us(|| {
            black_box(clean.push(black_box(frame)));
        }),
    };
    (stages, mask.iter().filter(|m| **m == 1).count())
}
