//! Tests of contact through the whole step, on any capsule and any throw.

use glam::{Affine3A, Vec3, Vec3A};
use proptest::prelude::*;
use toile_bake::bake;
use toile_base::fabric::Fabric;
use toile_base::garment::Garment;
use toile_base::skeleton::BONES;
use toile_engine::cloth::{Cloth, Settings, Step};
use toile_engine::colliders::{Colliders, RestSphere, RoundCone};
use toile_workspace::cloth::sheet;
use toile_workspace::tolerance;

/// A small cloth, not held anywhere, in the middle of the world.
fn garment(friction: f32) -> Garment {
    let fabric =
        Fabric { friction, ..toile_assets::fabric::built_in("cotton-lawn").expect("a fabric that is built in") };
    bake("cloth", "one", &sheet(5, 5, 0.03, Vec3::new(-0.075, 0.075, 0.0), false), &fabric).expect("it can be baked")
}

fn rig(spheres: usize, floor: bool) -> Colliders {
    let still = RestSphere { bone: 0, centre: Vec3::ZERO, radius: 0.0 };
    let capsules: &[[u8; 2]] = if spheres > 1 { &[[0, 1]] } else { &[] };
    Colliders::new(&vec![still; spheres], capsules, floor).expect("a capsule is within the limits")
}

fn step(cloth: &mut Cloth, garment: &Garment, colliders: &Colliders, settings: &Settings) {
    cloth.step(garment, &Step { palette: &[Affine3A::IDENTITY; BONES], colliders, settings });
}

fn within(size: f32) -> impl Strategy<Value = Vec3> {
    (-1.0f32..1.0, -1.0f32..1.0, -1.0f32..1.0).prop_map(move |(x, y, z)| Vec3::new(x, y, z) * size)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn nothing_ends_inside_a_capsule_however_both_move(
        from in within(0.3), half in within(0.15), speed in within(8.0), thrown in within(8.0),
        radii in (0.02f32..0.08, 0.02f32..0.08), friction in 0.0f32..1.5,
    ) {
        // It starts outside.
        let from = from + from.normalize_or(Vec3::Z) * 0.4;
        let garment = garment(friction);
        let mut colliders = rig(2, false);
        let at = |time: f32| {
            let middle = from - from.normalize() * speed.length() * time;
            [(middle - half).extend(radii.0), (middle + half).extend(radii.1)]
        };
        colliders.place_spheres(&at(0.0));
        let mut cloth = Cloth::new(&garment, &colliders);
        (0..garment.particles()).for_each(|i| cloth.disturb(i, garment.start[i].into(), thrown.into()));
        let settings = Settings { gravity: Vec3A::ZERO, ..Settings::default() };
        for k in 1..=24 {
            colliders.place_spheres(&at(k as f32 * settings.step_seconds));
            step(&mut cloth, &garment, &colliders, &settings);
            let cone: RoundCone = colliders.cone(0, 1.0);
            let deepest = cloth.positions.iter().map(|p| -cone.distance((*p).into()).0).fold(f32::MIN, f32::max);
            prop_assert!(deepest < tolerance::PENETRATION_M, "step {}: {} m deep", k, deepest);
        }
    }

    #[test]
    fn colliders_that_nothing_comes_near_leave_no_trace(
        place in within(1.0), half in within(0.2), thrown in within(3.0), radius in 0.01f32..0.1,
    ) {
        let garment = garment(0.5);
        // The cloth flies 0.15 m and falls 12 mm in six steps, and reaches 0.11 m about its middle.
        let middle = place.normalize_or(Vec3::X) * (0.75 + place.length());
        let spheres = [(middle - half).extend(radius), (middle + half).extend(radius)];
        let [mut with, mut without] = [rig(2, false), rig(0, false)];
        let settings = Settings::default();
        let mut cloths = [&with, &without].map(|c| Cloth::new(&garment, c));
        for cloth in &mut cloths {
            (0..garment.particles()).for_each(|i| cloth.disturb(i, garment.start[i].into(), thrown.into()));
        }
        for _ in 0..6 {
            with.place_spheres(&spheres);
            without.place_spheres(&[]);
            step(&mut cloths[0], &garment, &with, &settings);
            step(&mut cloths[1], &garment, &without, &settings);
        }
        prop_assert!(cloths[0].positions == cloths[1].positions);
        prop_assert_eq!(cloths[0].contact_counts().swept, 0);
    }

    #[test]
    fn friction_never_speeds_anything_up(thrown in within(4.0), friction in 0.0f32..2.0, high in 0.09f32..0.3) {
        let garment = garment(friction);
        let colliders = rig(0, true);
        let mut cloth = Cloth::new(&garment, &colliders);
        let settings = Settings::default();
        let level = |v: Vec3A| Vec3::new(v.x, 0.0, v.z);
        // It lies flat above the floor.
        for i in 0..garment.particles() {
            let p = garment.start[i];
            cloth.disturb(i, Vec3A::new(p.x, high, p.y), thrown.into());
        }
        let mass: f32 = garment.inverse_mass.iter().map(|w| w.recip()).sum();
        let drift = |cloth: &Cloth| {
            let momenta = garment.inverse_mass.iter().enumerate().map(|(i, w)| level(cloth.velocity(i)) / *w);
            momenta.sum::<Vec3>() / mass
        };
        let mut last = drift(&cloth).length();
        for k in 0..60 {
            step(&mut cloth, &garment, &colliders, &settings);
            let now = drift(&cloth).length();
            prop_assert!(now <= last + tolerance::DRIFT_M_S, "step {}: from {} to {} m/s", k, last, now);
            last = now;
        }
    }
}
