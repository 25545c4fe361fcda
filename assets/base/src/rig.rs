//! The collision body: spheres, and the tapered capsules (round cones) between them.

use glam::Vec3;

use crate::body::Body;
use crate::cone::round_cone;
use crate::limits::{MAX_CAPSULES, MAX_SPHERES};

/// Spheres of a rig: 24 on either side and 3 in the middle.
pub const SPHERES: usize = 51;

const _: () = assert!(SPHERES <= MAX_SPHERES);

/// A collision sphere that a bone carries.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sphere {
    /// The bone, an index below [`crate::skeleton::BONES`].
    pub bone: u8,
    /// Centre, from the bone's rest origin, in the rest frame (m).
    pub offset: Vec3,
    /// Radius (m).
    pub radius: f32,
}

/// The collision body of one body.
#[derive(Debug, Clone, PartialEq)]
pub struct Rig {
    /// The spheres: each left one is followed by its mirror image, those of the middle come last.
    pub spheres: [Sphere; SPHERES],
    /// The pairs of spheres that span a capsule.
    pub capsules: [[u8; 2]; MAX_CAPSULES],
}

impl Rig {
    /// Spheres in the rest pose of the body that the rig was fitted to: centre and radius, world (m).
    pub fn placed(&self, body: &Body) -> [(Vec3, f32); SPHERES] {
        let origins = body.skeleton.bone_origins();
        self.spheres.map(|s| (origins[usize::from(s.bone)] + s.offset, s.radius))
    }

    /// Signed distance from a point to the union of the capsules in the body's rest pose (m), negative inside, where it
    /// is the way out of the one capsule that is deepest.
    pub fn distance(&self, body: &Body, p: Vec3) -> f32 {
        let placed = self.placed(body);
        let to = |[a, b]: &[u8; 2]| round_cone(p, placed[usize::from(*a)], placed[usize::from(*b)]).0;
        self.capsules.iter().map(to).fold(f32::INFINITY, f32::min)
    }
}
