//! The shopper of one depth frame after the other as world points: the person whom the segmenter finds, and nothing else.

use glam::Vec3;
use toile_base::frame::{DepthFrame, Intrinsics};
use toile_sensors::segment::{Segmenter, Zone};

/// Farther than this the Kinect's steps exceed 46 mm and a body has under 6,000 pixels (m).
pub const FARTHEST: f32 = 4.5;

/// Where a person is measured: wherever a camera sees them well.
const ANYWHERE: Zone = Zone { ahead: [0.4, FARTHEST], half_width: 2.5, mark: None };

/// The lowest share of a person's height, and the share of it along the picture's edge with which the picture cuts them off.
const LOWEST: f32 = 0.04;
const CUT: f32 = 0.2;

/// Pixels from the edge of the picture that lie along it.
const EDGE: usize = 4;

/// One person, as the camera sees them.
#[derive(Debug, Clone, PartialEq)]
pub struct PersonCloud {
    /// Surface points, world (m), row by row from the top left of the picture.
    pub points: Vec<Vec3>,
    /// The picture's edge cuts the person off below.
    pub cut_below: bool,
}

/// What one depth frame shows.
#[derive(Debug, Clone, PartialEq)]
pub struct PeopleInView {
    /// The frame with nothing in it but the shopper, if there is one.
    pub alone: Option<DepthFrame>,
    /// How many people are in view within reach, the shopper included.
    pub people: usize,
    /// Distance of the nearest person who stands too far off to be measured (m).
    pub too_far: Option<f32>,
}

/// Finds the shopper, frame by frame.
pub struct PersonFinder {
    segmenter: Segmenter,
}

impl Default for PersonFinder {
    fn default() -> Self {
        Self { segmenter: Segmenter::new(ANYWHERE) }
    }
}

impl PersonFinder {
    /// Finds the shopper in the next frame.
    pub fn push(&mut self, frame: &DepthFrame) -> PeopleInView {
        let seen = self.segmenter.push(frame);
        let too_far = seen.nearest_other.filter(|d| seen.shopper.is_none() && *d > FARTHEST);
        let alone = seen.shopper.map(|_| {
            let mut alone = frame.clone();
            alone.depth_mm.iter_mut().zip(seen.mask).for_each(|(mm, shopper)| *mm *= u16::from(*shopper));
            alone
        });
        let people = usize::from(alone.is_some()) + if too_far.is_some() { 0 } else { seen.others };
        PeopleInView { alone, people, too_far }
    }
}

impl PersonCloud {
    /// The cloud of a frame that holds nothing but a person; `None` if it is empty.
    pub fn of(alone: &DepthFrame) -> Option<Self> {
        let Intrinsics { width, height, .. } = alone.intrinsics;
        let (width, height) = (width as usize, height as usize);
        let (mut points, mut pixels) = (Vec::new(), Vec::new());
        for (i, &mm) in alone.depth_mm.iter().enumerate().filter(|(_, mm)| **mm != 0) {
            let seen = alone.intrinsics.unproject((i % width) as f32, (i / width) as f32, f32::from(mm) * 1e-3);
            points.push(alone.camera_to_world.transform_point3(seen));
            pixels.push(i);
        }
        if points.is_empty() {
            return None;
        }
        let [bottom, top] = extent(points.iter().map(|p| p.y));
        let low = bottom + LOWEST * (top - bottom);
        let lowest = points.iter().zip(&pixels).filter(|(p, _)| p.y < low).map(|(_, i)| (i % width, i / width));
        let at_edge = |(u, v): (usize, usize)| u < EDGE || v < EDGE || u + EDGE >= width || v + EDGE >= height;
        let (all, cut) = lowest.fold((0, 0), |(all, cut), at| (all + 1, cut + usize::from(at_edge(at))));
        let cut_below = cut as f32 > CUT * all as f32;
        Some(Self { points, cut_below })
    }
}

/// The 1st and 99th percentile; zeros of nothing.
fn extent(values: impl Iterator<Item = f32>) -> [f32; 2] {
    let mut sorted: Vec<f32> = values.collect();
    sorted.sort_unstable_by(f32::total_cmp);
    match sorted.len() {
        0 => [0.0; 2],
        n => [sorted[(n - 1) / 100], sorted[n - 1 - (n - 1) / 100]],
    }
}
