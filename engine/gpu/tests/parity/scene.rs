//! What the tests step: the benchmark's skirt, a garment of the wardrobe, and how they are disturbed.

use glam::{Affine3A, DVec3, Quat, Vec3, Vec3A};
use toile_assets::drafting;
use toile_assets::scene::skirt::{self, Stretch};
use toile_bake::bake;
use toile_base::body::{Measures, Sex};
use toile_base::garment::Garment;
use toile_base::skeleton::BONES;
use toile_engine::cloth::{Cloth, Settings, Step};
use toile_engine::colliders::{Colliders, RestSphere};
use toile_gpu::cloth::Offload;
use toile_gpu::device::{AdapterChoice, GpuError};

/// A palette of bones that stand in the rest pose.
pub const REST: [Affine3A; BONES] = [Affine3A::IDENTITY; BONES];

/// The benchmark's skirt of n x n particles.
pub fn skirt(n: usize, stretch: Stretch) -> Garment {
    let shape = skirt::shape(n);
    bake("skirt", "one size", &shape, &skirt::fabric(&shape, stretch)).expect("the skirt bakes")
}

/// The same meshed irregularly.
pub fn irregular(n: usize, stretch: Stretch) -> Garment {
    let shape = skirt::irregular(n, 1);
    bake("irregular", "one size", &shape, &skirt::fabric(&shape, stretch)).expect("the skirt bakes")
}

/// A garment of the wardrobe on the average woman.
pub fn worn(name: &str) -> Garment {
    stiffened(name, 1.0)
}

/// The same in a fabric that is so many times as stiff in bending (1).
pub fn stiffened(name: &str, times: f32) -> Garment {
    let package = drafting::package(name).expect("the garment is built in");
    let body = toile_assets::body::build(Sex::Female, &Measures::average(Sex::Female)).expect("she can be built");
    let mut fabric = toile_assets::fabric::built_in(&package.fabric).expect("its fabric is built in");
    fabric.bend_warp_un_m *= times;
    fabric.bend_weft_un_m *= times;
    fabric.bend_bias_un_m = fabric.bend_bias_un_m.map(|bias| bias * times);
    package.dress_in(&fabric, package.own_size(), &body).expect("it fits")
}

/// The skirt's body of 16 spheres and 28 capsules, on a floor that its hem reaches.
pub fn walker() -> Colliders {
    let sphere =
        |(p, r): ([f64; 3], f64)| RestSphere { bone: 0, centre: DVec3::from_array(p).as_vec3(), radius: r as f32 };
    let mut colliders = Colliders::new(&skirt::JOINTS.map(sphere), &skirt::CAPSULES, true).expect("it is the scene's");
    // A slope that the hem rests on.
    let normal = Vec3::new(0.3, 1.0, 0.1).normalize();
    colliders.set_planes(&[normal.extend(0.32)]).expect("one plane");
    colliders
}

/// No body at all.
pub fn no_body() -> Colliders {
    Colliders::new(&[], &[], false).expect("nothing is not too much")
}

/// The root that sways and turns.
pub fn swaying(step: usize) -> [Affine3A; BONES] {
    let t = step as f32 / 120.0;
    let turn = Quat::from_rotation_y(0.4 * (2.0 * t).sin());
    let at = Vec3::new(0.05 * (5.0 * t).sin(), 0.02 * (4.0 * t).sin(), 0.03 * (3.0 * t).sin());
    [Affine3A::from_rotation_translation(turn, at); BONES]
}

/// Surroundings of a step.
pub fn around<'a>(palette: &'a [Affine3A; BONES], colliders: &'a Colliders, settings: &'a Settings) -> Step<'a> {
    Step { palette, colliders, settings }
}

/// Places and velocities that are off by some millimetres and decimetres a second, the same in every run.
pub fn disturbed(garment: &Garment) -> (Vec<Vec3A>, Vec<Vec3A>) {
    let wave = |i: usize, k: f32| (i as f32 * k + 7.0 * k).sin();
    let noise = |i: usize| Vec3A::new(wave(i, 1.37), wave(i, 2.11), wave(i, 0.77));
    let free = |i: usize| if garment.inverse_mass[i] > 0.0 { 1.0 } else { 0.0 };
    let x = garment.start.iter().enumerate().map(|(i, p)| Vec3A::from(*p) + noise(i) * (0.003 * free(i))).collect();
    let v = (0..garment.particles()).map(|i| noise(i + 31) * (0.3 * free(i))).collect();
    (x, v)
}

/// The garments on an adapter, without bodies.
pub fn offload(garments: &[&Garment], settings: &Settings) -> Option<Offload> {
    let no_body = no_body();
    offload_worn(garments, &vec![&no_body; garments.len()], settings)
}

/// The garments on an adapter, each with its body.
pub fn offload_worn(garments: &[&Garment], colliders: &[&Colliders], settings: &Settings) -> Option<Offload> {
    opened(Offload::new(&AdapterChoice::Fastest, garments, colliders, settings))
}

/// What runs on an adapter: none where this machine has none, which CI does not excuse.
pub fn opened<T>(opened: Result<T, GpuError>) -> Option<T> {
    match opened {
        Ok(opened) => Some(opened),
        Err(error @ GpuError::NoAdapter(_)) => {
            assert_ne!(std::env::var("CI").as_deref(), Ok("true"), "{error}");
            eprintln!("not run: {error}");
            None
        }
        Err(error) => panic!("{error}"),
    }
}

/// How two runs differ: numbers with the same bits, numbers, and the largest difference.
pub fn apart(one: &[Vec3A], other: &[Vec3A]) -> (usize, usize, f32) {
    assert_eq!(one.len(), other.len());
    let pairs = one.iter().zip(other).flat_map(|(a, b)| a.to_array().into_iter().zip(b.to_array()));
    // -0 and 0 are the same place.
    pairs.fold((0, 0, 0.0), |(same, all, most), (a, b)| (same + usize::from(a == b), all + 1, (a - b).abs().max(most)))
}

/// Changes the last bit of each coordinate of about half of a cloth's free particles, other ones in every step: what rounds
/// otherwise does at least that.
pub fn nudge(cloth: &mut Cloth, garment: &Garment, chance: &mut u64) {
    for i in (0..garment.particles()).filter(|&i| garment.inverse_mass[i] > 0.0) {
        // Knuth's multiplier, and the upper bits, which are the better ones.
        *chance = chance.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let (at, velocity, bits) = (cloth.positions[i], cloth.velocity(i), (*chance >> 61) as u32);
        let flipped = |k: u32| f32::from_bits(at[k as usize].to_bits() ^ ((bits >> k) & 1));
        cloth.disturb(i, Vec3A::new(flipped(0), flipped(1), flipped(2)), velocity);
    }
}
