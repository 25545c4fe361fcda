//! The union of the capsules in the rest pose.

use glam::Vec3;

use super::plan::CAPSULES;
use toile_base::cone::round_cone;
use toile_base::rig::SPHERES;

/// Spheres in the rest pose: centre and radius (m).
pub(super) type RestSpheres = [(Vec3, f32); SPHERES];

/// Distance to the union, and the capsule and place on it that are nearest.
pub(super) fn nearest(placed: &RestSpheres, p: Vec3) -> (f32, usize, f32) {
    let mut best = (f32::INFINITY, 0, 0.0);
    for (i, [a, b]) in CAPSULES.iter().enumerate() {
        let (distance, t) = round_cone(p, placed[usize::from(*a)], placed[usize::from(*b)]);
        if distance < best.0 {
            best = (distance, i, t);
        }
    }
    best
}
