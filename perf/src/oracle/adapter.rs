//! From the engine's colliders and positions to the oracle's: the one place that knows both, and it copies numbers only.

use glam::{DVec3, Vec3A, Vec4, Vec4Swizzles};
use toile_base::garment::Garment;
use toile_engine::cloth::contact;
use toile_engine::colliders::Colliders;

use super::solids::{Ball, Plane, Solids};

/// The engine's colliders at the start and at the end of their step.
pub fn solids(colliders: &Colliders) -> [Solids; 2] {
    [colliders.start(), colliders.end()].map(|spheres| {
        let ball = |s: u8| spheres.get(usize::from(s)).map_or(ball(Vec4::ZERO), |s| ball(*s));
        let floor = colliders.floor.then_some(Plane { normal: DVec3::Y, offset_m: 0.0 });
        let plane = |p: &Vec4| Plane { normal: p.xyz().as_dvec3(), offset_m: p.w.into() };
        Solids {
            cones: colliders.capsules().iter().map(|ends| ends.map(ball)).collect(),
            planes: floor.into_iter().chain(colliders.planes().iter().map(plane)).collect(),
        }
    })
}

fn ball(sphere: Vec4) -> Ball {
    Ball { centre: sphere.xyz().as_dvec3(), radius: sphere.w.into() }
}

/// Which cones each particle can touch, for [`Problem::reach`](super::Problem::reach).
pub fn reach(garment: &Garment, colliders: &Colliders) -> Vec<u32> {
    garment.parts.iter().map(|part| contact::body::reach(*part, colliders)).collect()
}

/// The engine's positions in f64.
pub fn positions(of: &[Vec3A]) -> Vec<DVec3> {
    of.iter().map(|p| p.as_dvec3()).collect()
}
