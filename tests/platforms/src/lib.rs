//! State hashes that every platform must reproduce: 600 steps of the benchmark's skirt.
//!
//! One source serves all platforms. A program prints the hashes where there is a standard output; WebAssembly exports them.

#[cfg(target_arch = "wasm32")]
#[expect(unsafe_code, reason = "functions that a host calls by their names")]
mod exports;

use glam::{Affine3A, Vec3, Vec4};
use toile_assets::bake::bake;
use toile_assets::numeric::hash;
use toile_assets::scene::skirt::{self, Motion, Stretch};
use toile_assets::skeleton::BONES;
use toile_engine::cloth::{Cloth, Settings, Step};
use toile_engine::colliders::{Colliders, RestSphere};
use toile_engine::lanes::Width;

/// Steps to each hash: five seconds.
pub const STEPS: u64 = 600;

/// Rows and columns of the skirt: 4,096 vertices.
const SKIRT_SIDE: usize = 64;

/// The hash of the benchmark's skirt after [`STEPS`] steps of its walk, on so many lanes.
///
/// # Panics
/// If the skirt cannot be baked, which no platform may cause.
pub fn skirt_hash(width: Width) -> u64 {
    let shape = skirt::shape(SKIRT_SIDE);
    let fabric = skirt::fabric(&shape, Stretch::default());
    let garment = bake("skirt", "one", &shape, &fabric).expect("the skirt's mesh is cloth");
    let rest = skirt::JOINTS.map(|(p, r)| RestSphere {
        bone: 0,
        centre: Vec3::from_array(p.map(|x| x as f32)),
        radius: r as f32,
    });
    let mut colliders = Colliders::new(&rest, &skirt::CAPSULES, false).expect("the skirt's body is one");
    let mut cloth = Cloth::new(&garment, &colliders);
    let settings = Settings { width, ..Settings::default() };
    let mut palette = [Affine3A::IDENTITY; BONES];
    colliders.place_spheres(&skirt::spheres(Motion::Walk, 0.0));
    for tick in 1..=STEPS {
        let time = tick as f64 * f64::from(settings.step_seconds);
        let spheres: [Vec4; skirt::SPHERES] = skirt::spheres(Motion::Walk, time);
        palette[0] = skirt::root(Motion::Walk, time);
        colliders.place_spheres(&spheres);
        cloth.step(&garment, &Step { palette: &palette, colliders: &colliders, settings: &settings });
    }
    let mut particle = vec![0; garment.source.len()];
    garment.source.iter().enumerate().for_each(|(p, &v)| particle[v as usize] = p);
    hash::of_numbers(
        particle.into_iter().flat_map(|p| [cloth.positions[p], cloth.velocity(p)]).flat_map(|v| v.to_array()),
    )
}
