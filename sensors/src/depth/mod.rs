//! The shopper's depth made clean: holes filled, noise smoothed without blurring edges, points and normals in our world.
//!
//! Runs on the sensor thread: at most 10 ms for a full 640x480 image, 3 ms of them for smoothing. After the first frame it
//! allocates nothing.

pub mod cloud;
pub mod fill;
pub mod gaussian;
pub mod noise;
pub mod smooth;

use crate::segment::{Person, Segmenter, Zone};
pub use cloud::Cloud;
pub use fill::Validity;
pub use noise::SensorNoise;
use toile_base::frame::DepthFrame;

/// How depth is smoothed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum DepthSmoothing {
    /// Not at all.
    None,
    /// Along surfaces, not across edges ([`smooth`]).
    EdgePreserving(SensorNoise),
    /// The Gaussian of the seed ([`gaussian`]), with its deviation (px): blurs edges.
    Gaussian(f32),
}

/// Cleans the depth of one camera's frames: from [`DepthFrame`] to [`Cloud`], all stages in their order.
#[derive(Debug, Clone)]
pub struct Clean {
    smoothing: DepthSmoothing,
    segmenter: Segmenter,
    fill: fill::Fill,
    edge_preserving: smooth::EdgePreserving,
    gaussian: gaussian::Gaussian,
    depth_mm: Vec<f32>,
    cloud: Cloud,
}

impl Clean {
    /// A cleaner that has seen nothing.
    pub fn new(zone: Zone, smoothing: DepthSmoothing) -> Self {
        Self {
            smoothing,
            segmenter: Segmenter::new(zone),
            fill: fill::Fill::default(),
            edge_preserving: smooth::EdgePreserving::default(),
            gaussian: gaussian::Gaussian::default(),
            depth_mm: Vec::new(),
            cloud: Cloud::default(),
        }
    }

    /// Cleans the next frame: the shopper, if one stands in the zone, and their cloud, which is empty where none does.
    pub fn push(&mut self, frame: &DepthFrame) -> (Option<Person>, &Cloud) {
        let seen = self.segmenter.push(frame);
        let shopper = seen.shopper;
        self.fill.run(frame, seen.mask);
        let width = frame.intrinsics.width as usize;
        match self.smoothing {
            DepthSmoothing::None => {
                self.depth_mm.clear();
                self.depth_mm.extend(self.fill.depth_mm().iter().map(|d| f32::from(*d)));
            }
            DepthSmoothing::EdgePreserving(noise) => {
                self.edge_preserving.run(width, self.fill.depth_mm(), &noise, &mut self.depth_mm);
            }
            DepthSmoothing::Gaussian(sigma) => {
                self.gaussian.run(width, self.fill.depth_mm(), sigma, &mut self.depth_mm);
            }
        }
        self.cloud.update(frame, &self.depth_mm, self.fill.validity());
        (shopper, &self.cloud)
    }

    /// How depth is smoothed.
    pub fn smoothing(&self) -> DepthSmoothing {
        self.smoothing
    }
}

impl Default for Clean {
    fn default() -> Self {
        Self::new(Zone::default(), DepthSmoothing::EdgePreserving(SensorNoise::KINECT_V1))
    }
}
