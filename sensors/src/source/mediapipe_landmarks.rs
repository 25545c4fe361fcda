//! MediaPipe's landmarks: a point, a person in the image, a person in one frame.

use glam::{Vec2, Vec3};
use serde::Deserialize;

use super::joint_map::Format;
use toile_base::frame::TrackedJoint;

/// Landmarks of a pose.
pub(super) const POINTS: usize = Format::MediaPipe33.points();

/// Focal length over the image's longer side: that of a webcam that sees 60 degrees.
pub(super) const FOCAL: f32 = 0.87;

const HIPS: [usize; 2] = [23, 24];
const SHOULDERS: [usize; 2] = [11, 12];

/// One landmark: in metres from the hips, or in shares of the image.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
pub(super) struct Landmark {
    pub x: f32,
    pub y: f32,
    #[serde(default)]
    pub z: f32,
    #[serde(default = "seen")]
    pub visibility: f32,
}

fn seen() -> f32 {
    1.0
}

/// A person in the image.
pub(super) struct Image {
    /// Landmarks as shares of the image.
    pub points: [Landmark; POINTS],
    /// Width and height (px).
    pub size: [f32; 2],
}

impl Image {
    /// A landmark's pixel.
    pub fn pixel(&self, k: usize) -> Vec2 {
        Vec2::new(self.points[k].x * self.size[0], self.points[k].y * self.size[1])
    }

    /// Middle of the hips (px).
    pub fn hips(&self) -> [f32; 2] {
        ((self.pixel(HIPS[0]) + self.pixel(HIPS[1])) * 0.5).to_array()
    }

    /// Length of the trunk (px).
    pub fn height(&self) -> f32 {
        let shoulders = (self.pixel(SHOULDERS[0]) + self.pixel(SHOULDERS[1])) * 0.5;
        shoulders.distance(Vec2::from_array(self.hips()))
    }

    /// Focal length that is assumed (px).
    pub fn focal(&self) -> f32 {
        FOCAL * self.size[0].max(self.size[1])
    }
}

/// One person in one frame.
pub(super) struct LandmarkPerson {
    pub time_ns: u64,
    pub image: Option<Image>,
    pub world: Option<[Landmark; POINTS]>,
}

/// A landmark's visibility is its confidence: the model's own estimate that the point is in view.
pub(super) fn tracked(landmark: &Landmark, position: Vec3) -> TrackedJoint {
    TrackedJoint { position, confidence: landmark.visibility }
}
