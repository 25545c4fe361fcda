//! Joints from a plain depth camera: the shopper is segmented from the scene, and the body model tracks them.

use toile_base::body::Sex;
use toile_base::frame::{DepthFrame, Joints};
use toile_sensors::segment::{Segmenter, Zone};

use super::body_fit::{BodyFit, FittedFrame};
use super::options::FitOptions;

/// Tracks a shopper through the frames of a depth camera, whatever else these show.
pub struct BodyTracker {
    segmenter: Segmenter,
    fit: BodyFit,
    /// The last frame with nothing in it but the shopper.
    alone: Option<DepthFrame>,
    company: Company,
}

/// Who else is there beside the shopper.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Company {
    /// People whom the camera sees besides.
    pub others: u8,
    /// Whether one of them stands nearer to the camera than the shopper does.
    pub nearer: bool,
}

/// Others who stand so much behind the shopper (m) are not in their company: they pass by.
const BEHIND: f32 = 0.6;

impl BodyTracker {
    /// A tracker that has seen no person yet; the body model is that of a sex, and the shopper is the person who enters the zone.
    pub fn new(sex: Sex, zone: Zone, options: FitOptions) -> Self {
        Self {
            segmenter: Segmenter::new(zone),
            fit: BodyFit::new(sex, options),
            alone: None,
            company: Company::default(),
        }
    }

    /// Tracks the shopper in the next frame. Another person in their place in the zone starts a new fit.
    pub fn push(&mut self, frame: &DepthFrame) -> FittedFrame {
        let seen = self.segmenter.push(frame);
        let mask = seen.mask;
        let distance = seen.shopper.map(|p| p.place.length());
        let with = seen.nearest_other.filter(|other| distance.is_none_or(|own| *other < own + BEHIND));
        self.company = Company {
            others: if with.is_some() { seen.others.min(usize::from(u8::MAX)) as u8 } else { 0 },
            nearer: with.zip(distance).is_some_and(|(other, own)| other < own),
        };
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

impl BodyTracker {
    /// Who else was there in the last frame.
    pub fn company(&self) -> Company {
        self.company
    }

    /// The body model becomes that of a sex: what was fitted is forgotten, who is the shopper is not.
    pub fn set_sex(&mut self, sex: Sex, options: FitOptions) {
        self.fit = BodyFit::new(sex, options);
    }

    /// The last frame with nothing in it but the shopper.
    pub fn alone(&self) -> Option<&DepthFrame> {
        self.alone.as_ref()
    }
}

/// The joints of a whole recording, one a frame; absent in frames in which no person is tracked.
pub fn track(frames: &[DepthFrame], sex: Sex, options: FitOptions) -> Vec<Joints> {
    let mut tracker = BodyTracker::new(sex, Zone::default(), options);
    frames.iter().map(|frame| tracker.push(frame).joints).collect()
}
