//! One moment as a sensor saw it: joints, hand states, a depth frame.
//!
//! World: right-handed, y up, metres, the floor at y = 0, the shopper facing +z (their left is +x).

use glam::{Affine3A, Vec3};

use crate::limits::{CONFIDENCE_GATE, MAX_PIXELS, MAX_SIDE};
use crate::skeleton::{JOINTS, Joint};

/// One joint as tracked.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct TrackedJoint {
    /// World position (m); meaningless where `confidence` is 0.
    pub position: Vec3,
    /// How far to believe it, 0 (absent) to 1 (seen); believed from [`CONFIDENCE_GATE`].
    pub confidence: f32,
}

impl TrackedJoint {
    /// Whether the joint is believed: finite, and of a confidence of at least [`CONFIDENCE_GATE`].
    pub fn is_believed(&self) -> bool {
        self.confidence >= CONFIDENCE_GATE && self.position.is_finite()
    }
}

/// What a hand does, as the sensor itself reports it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum HandState {
    /// Not reported, not seen, or neither open nor closed.
    #[default]
    Unknown,
    /// The palm is open.
    Open,
    /// The hand is closed to a fist.
    Closed,
}

/// All joints at one moment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Joints {
    /// Time since the session began (ns).
    pub time_ns: u64,
    /// The joints, by [`Joint::index`].
    pub joints: [TrackedJoint; JOINTS],
    /// What the hands do, left and right.
    pub hands: [HandState; 2],
}

impl Joints {
    /// A moment at which nothing was tracked.
    pub const fn absent(time_ns: u64) -> Self {
        let nowhere = TrackedJoint { position: Vec3::ZERO, confidence: 0.0 };
        Self { time_ns, joints: [nowhere; JOINTS], hands: [HandState::Unknown; 2] }
    }

    /// A moment at which all joints were seen, at these places (m): what a sensor without noise or loss would give.
    pub fn seen(time_ns: u64, positions: [Vec3; JOINTS]) -> Self {
        let joints = positions.map(|position| TrackedJoint { position, confidence: 1.0 });
        Self { time_ns, joints, hands: [HandState::Unknown; 2] }
    }

    /// The tracked state of one joint.
    pub fn at(&self, joint: Joint) -> &TrackedJoint {
        &self.joints[joint.index()]
    }

    /// One joint, to be written.
    pub fn at_mut(&mut self, joint: Joint) -> &mut TrackedJoint {
        &mut self.joints[joint.index()]
    }

    /// Position of a believed joint (m).
    pub fn believed(&self, joint: Joint) -> Option<Vec3> {
        let tracked = self.at(joint);
        tracked.is_believed().then_some(tracked.position)
    }

    /// Whether every number is finite and every confidence within 0..1.
    pub fn is_valid(&self) -> bool {
        self.joints.iter().all(|j| j.position.is_finite() && (0.0..=1.0).contains(&j.confidence))
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

impl Intrinsics {
    /// The Kinect v1 depth camera: 640x480, f = 575.8 px, principal point in the middle.
    pub const KINECT_V1: Self = Self { width: 640, height: 480, fx: 575.8, fy: 575.8, cx: 319.5, cy: 239.5 };

    /// Pixels of an image.
    pub const fn pixels(&self) -> usize {
        self.width as usize * self.height as usize
    }

    /// Point seen at the centre of pixel (u, v) at depth `z` (m), camera axes.
    pub fn unproject(&self, u: f32, v: f32, z: f32) -> Vec3 {
        Vec3::new((u - self.cx) / self.fx * z, (v - self.cy) / self.fy * z, z)
    }

    /// Pixel at which a point in camera axes (m) is seen; `None` behind the camera.
    pub fn project(&self, p: Vec3) -> Option<(f32, f32)> {
        (p.z > 0.0).then(|| (self.cx + self.fx * p.x / p.z, self.cy + self.fy * p.y / p.z))
    }

    /// What is wrong with this camera, or `None`: sides within the limits, focal lengths positive, all finite.
    pub fn fault(&self) -> Option<String> {
        let (w, h) = (self.width, self.height);
        let pixels = u64::from(w) * u64::from(h);
        if w == 0 || h == 0 || w > MAX_SIDE || h > MAX_SIDE || pixels > MAX_PIXELS {
            return Some(format!(
                "an image of {w} x {h} pixels is outside 1 .. {MAX_SIDE} a side and {MAX_PIXELS} in all"
            ));
        }
        let lengths = [self.fx, self.fy];
        if lengths.iter().any(|f| !f.is_finite() || *f < 1.0 || *f > 1e6) {
            return Some(format!("focal lengths {} and {} px are not those of a camera", self.fx, self.fy));
        }
        let centre = [self.cx, self.cy];
        if centre.iter().any(|c| !c.is_finite() || c.abs() > 1e6) {
            return Some(format!("principal point ({}, {}) px is not that of a camera", self.cx, self.cy));
        }
        None
    }
}

/// One depth image.
#[derive(Debug, Clone, PartialEq)]
pub struct DepthFrame {
    /// Time since the session began (ns).
    pub time_ns: u64,
    /// The camera that took it.
    pub intrinsics: Intrinsics,
    /// Camera to world (m).
    pub camera_to_world: Affine3A,
    /// Depth along the camera's z (mm), row-major from the top left, 0 = nothing measured `[width * height]`.
    pub depth_mm: Box<[u16]>,
}

impl DepthFrame {
    /// World point seen at pixel (u, v) (m); `None` outside the image or where nothing was measured.
    pub fn point(&self, u: u32, v: u32) -> Option<Vec3> {
        if u >= self.intrinsics.width || v >= self.intrinsics.height {
            return None;
        }
        let depth = self.depth_mm[v as usize * self.intrinsics.width as usize + u as usize];
        if depth == 0 {
            return None;
        }
        let camera = self.intrinsics.unproject(u as f32, v as f32, f32::from(depth) * 1e-3);
        Some(self.camera_to_world.transform_point3(camera))
    }

    /// World points of all measured pixels, row by row (m).
    pub fn points(&self) -> impl Iterator<Item = Vec3> + '_ {
        let (w, h) = (self.intrinsics.width, self.intrinsics.height);
        (0..h).flat_map(move |v| (0..w).filter_map(move |u| self.point(u, v)))
    }

    /// Number of measured pixels.
    pub fn valid_pixels(&self) -> usize {
        self.depth_mm.iter().filter(|d| **d != 0).count()
    }

    /// What is wrong with this frame, or `None`.
    pub fn fault(&self) -> Option<String> {
        if let Some(fault) = self.intrinsics.fault() {
            return Some(fault);
        }
        if self.depth_mm.len() != self.intrinsics.pixels() {
            return Some(format!("{} depths for {} pixels", self.depth_mm.len(), self.intrinsics.pixels()));
        }
        pose_fault(&self.camera_to_world)
    }
}

/// What is wrong with a camera's pose, or `None`: it must be finite, right-handed, and rigid to 5 %, for published
/// calibrations are off by half of that.
pub fn pose_fault(pose: &Affine3A) -> Option<String> {
    if !pose.is_finite() || pose.translation.length() > crate::limits::MAX_COORDINATE {
        return Some("the camera's pose is not finite or lies farther than 100 m away".to_owned());
    }
    let m = pose.matrix3;
    let rigid = (m.transpose() * m).abs_diff_eq(glam::Mat3A::IDENTITY, 0.05);
    if !rigid || m.determinant() < 0.0 {
        return Some("the camera's pose is not a rotation (a scaled, skewed or mirrored matrix)".to_owned());
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pixel_unprojects_to_where_it_projects_from() {
        let camera = Intrinsics::KINECT_V1;
        let p = camera.unproject(100.0, 400.0, 2.5);
        let (u, v) = camera.project(p).unwrap();
        assert!((u - 100.0).abs() < 1e-3 && (v - 400.0).abs() < 1e-3);
        assert!(camera.project(-p).is_none());
    }

    #[test]
    fn point_is_none_outside_and_where_nothing_was_measured() {
        let intrinsics = Intrinsics { width: 2, height: 1, fx: 10.0, fy: 10.0, cx: 0.0, cy: 0.0 };
        let camera_to_world = Affine3A::from_translation(Vec3::Y);
        let frame = DepthFrame { time_ns: 0, intrinsics, camera_to_world, depth_mm: Box::new([0, 2000]) };
        assert_eq!(frame.point(0, 0), None);
        assert_eq!(frame.point(2, 0), None);
        assert_eq!(frame.point(1, 0), Some(Vec3::new(0.2, 1.0, 2.0)));
        assert_eq!(frame.points().count(), frame.valid_pixels());
        assert_eq!(frame.fault(), None);
    }

    #[test]
    fn absurd_cameras_are_named() {
        let good = Intrinsics::KINECT_V1;
        assert!(Intrinsics { width: 65535, height: 65535, ..good }.fault().is_some());
        assert!(Intrinsics { width: 0, ..good }.fault().is_some());
        let most = (MAX_PIXELS / u64::from(MAX_SIDE)) as u32;
        assert!(Intrinsics { width: MAX_SIDE, height: most, ..good }.fault().is_none(), "the largest that is allowed");
        assert!(Intrinsics { width: MAX_SIDE, height: most + 1, ..good }.fault().is_some());
        assert!(Intrinsics { fx: f32::NAN, ..good }.fault().is_some());
        assert!(pose_fault(&Affine3A::from_scale(Vec3::splat(1000.0))).is_some());
        assert!(pose_fault(&Affine3A::from_scale(Vec3::new(-1.0, 1.0, 1.0))).is_some());
        assert!(pose_fault(&Affine3A::IDENTITY).is_none());
    }
}
