//! The collision body: 51 spheres and the 32 tapered capsules between them, fitted to one body's surface.
//!
//! A tapered capsule (round cone) is the convex hull of two spheres. The fit minimises the squared distance between the
//! body's surface and the union of the capsules by Levenberg-Marquardt, left and right mirrored. Large distances cost
//! more than their square, and skin outside the union more than union outside the skin: cloth rests on the union while
//! the picture shows the body, and the worst place is what is seen. Points above the skin keep the union from standing
//! out where no skin is near.

mod fitting;
mod plan;
mod report;
mod shell;
pub(crate) mod skin;
mod system;
mod union;
mod zones;

use glam::Vec3;

use plan::{CAPSULES, PAIRS, PLAN};
pub use report::{MEAN_GOAL_MM, P95_GOAL_MM, RigReport, ZoneReport};
pub use shell::CapsuleSurface;
use toile_base::body::Body;
use toile_base::rig::{Rig, SPHERES, Sphere};
use toile_base::skeleton::Joint;
pub use zones::Zone;

/// Fits the spheres to a body in its rest pose. The same body gives the same bits.
pub fn fit(body: &Body) -> Rig {
    let placed = fitting::spheres(body);
    let mut spheres = [Sphere { bone: 0, offset: Vec3::ZERO, radius: 0.0 }; SPHERES];
    for (i, sphere) in spheres.iter_mut().enumerate() {
        let joint = carrier(i);
        let (centre, radius) = placed[i];
        *sphere = Sphere { bone: joint.index() as u8, offset: centre - body.skeleton.at(joint), radius };
    }
    Rig { spheres, capsules: CAPSULES }
}

/// How closely the union follows the skin of the body that the rig was fitted to, in its rest pose.
pub fn report(rig: &Rig, body: &Body) -> RigReport {
    RigReport::new(body, &rig.placed(body))
}

/// The capsules as surfaces to look at, in the rest pose of the body that the rig was fitted to.
pub fn shell(rig: &Rig, body: &Body) -> CapsuleSurface {
    CapsuleSurface::new(&rig.placed(body))
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
