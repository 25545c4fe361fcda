//! Joints from a plain depth camera: the shopper parted from all else that is seen, and the body followed.

use toile_assets::body::Sex;
use toile_sensors::frame::{DepthFrame, Joints};
use toile_sensors::segment::{Segmenter, Zone};

use super::{BodyFit, Options, Seen};

/// A shopper followed through the frames of a depth camera, whatever else these show.
pub struct Follower {
    segmenter: Segmenter,
    fit: BodyFit,
    /// The last frame with nothing in it but the shopper.
    alone: Option<DepthFrame>,
}

impl Follower {
    /// Nobody yet; the body is of the family of a sex, and the shopper whoever comes into the zone.
    pub fn new(sex: Sex, zone: Zone, options: Options) -> Self {
        Self { segmenter: Segmenter::new(zone), fit: BodyFit::new(sex, options), alone: None }
    }

    /// Follows the shopper into the next frame. Whoever takes their place in the zone is found anew.
    pub fn push(&mut self, frame: &DepthFrame) -> Seen {
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

    /// The last frame with nothing in it but the shopper.
    pub fn alone(&self) -> Option<&DepthFrame> {
        self.alone.as_ref()
    }

    /// The body that is fitted.
    pub fn fit(&self) -> &BodyFit {
        &self.fit
    }
}

/// The joints of a whole recording, one a frame; those of frames in which nobody is followed are absent.
pub fn follow(frames: &[DepthFrame], sex: Sex, options: Options) -> Vec<Joints> {
    let mut follower = Follower::new(sex, Zone::default(), options);
    frames.iter().map(|frame| follower.push(frame).joints).collect()
}
