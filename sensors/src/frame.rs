//! One moment as a sensor saw it: a depth frame, and the joints.
//!
//! World: right-handed, y up, metres, the floor at y = 0, the shopper facing +z (their left is +x).

use glam::{Affine3A, Vec3};
use toile_assets::skeleton::{JOINTS, Joint};

/// One joint as tracked.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct TrackedJoint {
    /// World position (m); meaningless where `confidence` is 0.
    pub position: Vec3,
    /// How far to believe it, 0 (absent) to 1 (seen); believed from [`toile_assets::limits::CONFIDENCE_GATE`].
    pub confidence: f32,
}

/// All joints at one moment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Joints {
    /// Time since the session began (ns).
    pub time_ns: u64,
    /// The joints, by [`Joint::index`].
    pub joints: [TrackedJoint; JOINTS],
}

impl Joints {
    /// One joint.
    pub fn at(&self, joint: Joint) -> &TrackedJoint {
        &self.joints[joint.index()]
    }
}

/// A pinhole depth camera: pixel (u, v) = (cx + fx x / z, cy + fy y / z), camera x right, y down, z forward.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Intrinsics {
    /// Image width (px).
    pub width: u32,
    /// Image height (px).
    pub height: u32,
    /// Focal length along x (px).
    pub fx: f32,
    /// Focal length along y (px).
    pub fy: f32,
    /// Principal point x (px).
    pub cx: f32,
    /// Principal point y (px).
    pub cy: f32,
}

/// One depth image.
#[derive(Debug, Clone, PartialEq)]
pub struct DepthFrame {
    /// Time since the session began (ns).
    pub time_ns: u64,
    /// The camera.
    pub intrinsics: Intrinsics,
    /// Camera to world (m).
    pub camera_to_world: Affine3A,
    /// Depth along the camera's z (mm), row-major from the top left, 0 = nothing measured `[width * height]`.
    pub depth_mm: Box<[u16]>,
}
