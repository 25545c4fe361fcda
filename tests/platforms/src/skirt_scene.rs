//! The benchmark's skirt, walked for 600 steps.

use glam::{Affine3A, Vec3};
use toile_bake::bake;
use toile_base::skeleton::BONES;
use toile_engine::cloth::{Cloth, Settings, Step};
use toile_engine::colliders::{Colliders, RestSphere};
use toile_engine::lanes::Width;

use crate::skirt::{self, SkirtMotion, Stretch};
use crate::{STEPS, hash_of};

/// Rows and columns of the skirt: 4,096 vertices.
const SIDE: usize = 64;

/// The state hash of the benchmark's skirt after [`STEPS`] steps of its walk, on so many lanes.
///
/// # Panics
/// If the skirt cannot be baked, which no platform may cause.
pub fn skirt_hash(width: Width) -> u64 {
    let shape = skirt::shape(SIDE);
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
    colliders.place_spheres(&skirt::spheres(SkirtMotion::Walk, 0.0));
    for tick in 1..=STEPS {
        let time = tick as f64 * f64::from(settings.step_seconds);
        palette[0] = skirt::root(SkirtMotion::Walk, time);
        colliders.place_spheres(&skirt::spheres(SkirtMotion::Walk, time));
        cloth.step(&garment, &Step { palette: &palette, colliders: &colliders, settings: &settings });
    }
    let mut particle = vec![0; garment.source.len()];
    garment.source.iter().enumerate().for_each(|(p, &v)| particle[v as usize] = p);
    hash_of(&cloth, particle.into_iter())
}
