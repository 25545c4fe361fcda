//! Joints from a plain depth camera: the shopper is segmented from the scene, and the body model tracks them.

use toile_assets::body::Sex;
use toile_sensors::frame::{DepthFrame, Joints};
use toile_sensors::segment::{Segmenter, Zone};

use super::body_fit::{BodyFit, FittedFrame};
use super::options::FitOptions;

/// Tracks a shopper through the frames of a depth camera, whatever else these show.
pub struct BodyTracker {
    segmenter: Segmenter,
    fit: BodyFit,
    /// The last frame with nothing in it but the shopper.
    alone: Option<DepthFrame>,
}

impl BodyTracker {
    /// A tracker that has seen nobody; the body model is that of a sex, and the shopper is whoever enters the zone.
    pub fn new(sex: Sex, zone: Zone, options: FitOptions) -> Self {
        Self { segmenter: Segmenter::new(zone), fit: BodyFit::new(sex, options), alone: None }
    }

    /// Tracks the shopper in the next frame. Whoever takes their place in the zone starts a new fit.
    pub fn push(&mut self, frame: &DepthFrame) -> FittedFrame {
        let mask = self.segmenter.push(frame).mask;
        let alone = match &mut self.alone {
            Some(alone) if alone.depth_mm.len() == frame.depth_mm.len() => alone,
            other => other.insert(frame.clone()),
        };
        (alone.time_ns, alone.intrinsics) = (frame.time_ns, frame.intrinsics);
        alone.camera_to_world = frame.camera_to_world;
        for ((kept, &mm), &shopper) in alone.depth_mm.iter_mut().zip(&frame.depth_mm).zip(mask) {
            *kept = mm * u16::from(shopper);
        }
        self.fit.push(alone)
    }
}

/// The joints of a whole recording, one a frame; absent in frames in which nobody is tracked.
pub fn track(frames: &[DepthFrame], sex: Sex, options: FitOptions) -> Vec<Joints> {
    let mut tracker = BodyTracker::new(sex, Zone::default(), options);
    frames.iter().map(|frame| tracker.push(frame).joints).collect()
}
