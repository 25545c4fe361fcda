//! The collision body: 51 spheres and the 32 tapered capsules between them, fitted to one body's surface.
//!
//! Reads: a body in its rest pose. Writes: one immutable [`Rig`].
//! Budget: at load only, under 100 ms a body.
//! Thread: the loading thread.
//!
//! A tapered capsule (round cone) is the convex hull of two spheres. The fit minimises the squared distance between the
//! body's surface and the union of the capsules by Levenberg-Marquardt, left and right mirrored. Large distances cost
//! more than their square, and skin outside the union more than union outside the skin: cloth rests on the union while
//! the picture shows the body, and the worst place is what is seen. Points above the skin keep the union from standing
//! out where no skin is near.

mod fit;
mod plan;
mod report;
mod shell;
pub(crate) mod skin;
mod system;
mod union;
mod zones;

use glam::Vec3;

use crate::body::Body;
use crate::limits::{MAX_CAPSULES, MAX_SPHERES};
use crate::skeleton::Joint;
pub use plan::SPHERES;
use plan::{CAPSULES, PAIRS, PLAN};
pub use report::{MEAN_GOAL_MM, P95_GOAL_MM, RigReport, ZoneReport};
pub use shell::CapsuleSurface;
use union::nearest;
pub use zones::Zone;

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
    /// Fits the spheres to a body in its rest pose. The same body gives the same bits.
    pub fn fit(body: &Body) -> Self {
        let placed = fit::spheres(body);
        let mut spheres = [Sphere { bone: 0, offset: Vec3::ZERO, radius: 0.0 }; SPHERES];
        for (i, sphere) in spheres.iter_mut().enumerate() {
            let joint = carrier(i);
            let (centre, radius) = placed[i];
            *sphere = Sphere { bone: joint.index() as u8, offset: centre - body.skeleton.at(joint), radius };
        }
        Self { spheres, capsules: CAPSULES }
    }

    /// Spheres in the rest pose of the body that the rig was fitted to: centre and radius, world (m).
    pub fn placed(&self, body: &Body) -> [(Vec3, f32); SPHERES] {
        let origins = body.skeleton.bone_origins();
        self.spheres.map(|s| (origins[usize::from(s.bone)] + s.offset, s.radius))
    }

    /// Signed distance from a point to the union of the capsules in the body's rest pose (m), negative inside, where it
    /// is the way out of the one capsule that is deepest.
    pub fn distance(&self, body: &Body, p: Vec3) -> f32 {
        nearest(&self.placed(body), p).0
    }

    /// How closely the union follows the skin of the body that the rig was fitted to, in its rest pose.
    pub fn report(&self, body: &Body) -> RigReport {
        RigReport::new(body, &self.placed(body))
    }

    /// The capsules as surfaces to look at, in the rest pose of the body that the rig was fitted to.
    pub fn shell(&self, body: &Body) -> CapsuleSurface {
        CapsuleSurface::new(&self.placed(body))
    }
}

/// The joint that carries a sphere.
fn carrier(sphere: usize) -> Joint {
    match sphere.checked_sub(2 * PAIRS) {
        Some(middle) => PLAN[PAIRS + middle].carrier,
        None if sphere.is_multiple_of(2) => PLAN[sphere / 2].carrier,
        None => PLAN[sphere / 2].carrier.mirror(),
    }
}

#[cfg(test)]
mod tests;
