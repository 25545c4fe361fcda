//! Tests of the whole step, through the engine's public interface.

use glam::{Affine3A, Vec3, Vec3A};
use toile_bake::bake;
use toile_base::clock::ticks_to_ns;
use toile_base::fabric::Fabric;
use toile_base::frame::Joints;
use toile_base::garment::Garment;
use toile_base::limits::{STEP_HZ, STEP_SECONDS};
use toile_base::skeleton::BONES;
use toile_engine::body::{Poser, palette};
use toile_engine::cloth::{Cloth, Settings, Step, step::measure};
use toile_engine::colliders::Colliders;
use toile_engine::world::World;
use toile_sensors::sample::sample;
use toile_workspace::cloth::{plain_fabric, sheet};
use toile_workspace::dressed;

/// Gravity of the default settings (m/s2).
const G: f32 = 9.81;

/// Steps a garment alone in the world, its bones at rest.
fn alone(garment: &Garment, settings: &Settings, steps: u32) -> Cloth {
    let colliders = Colliders::new(&[], &[], false).expect("no colliders at all");
    let bones = [Affine3A::IDENTITY; BONES];
    let mut cloth = Cloth::new(garment, &colliders);
    for _ in 0..steps {
        cloth.step(garment, &Step { palette: &bones, colliders: &colliders, settings });
    }
    cloth
}

#[test]
fn free_fall_is_that_of_galileo_and_of_the_air() {
    let settings = Settings::default();
    // Half a second within the height of a room: velocities come from differences of positions, whose last bit is worth
    // 1e-4 m/s there, and a hundred times that far away from any shopper.
    let steps = STEP_HZ / 2;
    for k in [0.0f32, 1.05] {
        let shape = sheet(6, 6, 0.05, Vec3::new(0.3, 1.0, -0.2), false);
        let garment = bake("sheet", "one", &shape, &plain_fabric(0.1, 4000.0, k)).unwrap();
        let cloth = alone(&garment, &settings, steps);
        let t = steps as f32 * STEP_SECONDS;
        let expected = match k {
            0.0 => 0.5 * G * t * t,
            k => G / k * (t - (1.0 - (-k * t).exp()) / k),
        };
        for (p, start) in cloth.positions.iter().zip(&garment.start) {
            let fallen = start.y - p.y;
            assert!((fallen / expected - 1.0).abs() < 4e-3, "damping {k}: fell {fallen} m instead of {expected} m");
            assert!((p.x - start.x).abs() < 1e-4 && (p.z - start.z).abs() < 1e-4, "it drifts: {p} from {start}");
        }
        assert_eq!(cloth.events.speed_limited + cloth.events.rolled_back, 0);
    }
}

/// How far the lower edge of a strip hangs below where it was cut (m). The strip is 1 m long.
fn hanging(fabric: &Fabric, substeps: u32) -> f32 {
    // About the origin, where f32 is finest: of what a substep falls, 3 um, the last bit at 2 m is already 9 %.
    let garment = bake("strip", "one", &sheet(2, 10, 0.1, Vec3::new(0.0, 0.5, 0.0), true), fabric).unwrap();
    let settings = Settings { substeps: Some(substeps), ..Settings::default() };
    // Five seconds: the slowest oscillation, 5 Hz, has died away by exp(-12).
    let cloth = alone(&garment, &settings, 5 * STEP_HZ);
    let lower = garment.start.len() - 3..garment.start.len();
    let sag = lower.map(|i| garment.start[i].y - cloth.positions[i].y);
    sag.sum::<f32>() / 3.0
}

#[test]
fn a_hanging_strip_stretches_by_its_weight_whatever_the_substeps() {
    // Tensile stiffness E (N/m), weight per area w (N/m2), length 1 m: u = w L^2 / (2 E), and a discrete chain with
    // half a mass at its end reaches it exactly.
    for (density, stiffness) in [(0.5, 200.0), (0.3, 90.0)] {
        let fabric = plain_fabric(density, stiffness, 5.0);
        let expected = density * G / (2.0 * stiffness);
        let sags = [8, 12, 16].map(|substeps| hanging(&fabric, substeps));
        eprintln!("a strip of {stiffness} N/m: {expected} m expected, {sags:?} m with 8, 12, 16 substeps");
        for sag in sags {
            assert!((sag / expected - 1.0).abs() < 0.04, "{sag} m instead of {expected} m");
        }
        assert!((sags[0] / sags[2] - 1.0).abs() < 0.03, "statics depend on the substeps: {sags:?}");
    }
}

/// The scene's shopper in a sun dress of a coarse mesh, dressed as she stands at the begin of a track.
fn coarse(track: &[Joints]) -> World {
    let body = dressed::shopper();
    let garment = dressed::dress_coarsely("strap-dress", &body);
    let mut world = dressed::world(body, vec![garment]);
    world.dress(&track[0]);
    world
}

/// Runs `look` after each step of a track.
fn play(world: &mut World, track: &[Joints], mut look: impl FnMut(u64, &World)) {
    let (start, end) = (track[0].time_ns, track[track.len() - 1].time_ns);
    let mut tick = 0;
    while start + ticks_to_ns(tick) <= end {
        world.step(&sample(track, start + ticks_to_ns(tick)).expect("a track with frames"));
        look(tick, world);
        tick += 1;
    }
}

#[test]
fn pinned_particles_never_leave_the_skin() {
    let track = dressed::track(&dressed::shopper(), 3.2, 2.0);
    let mut farthest = 0.0f32;
    play(&mut coarse(&track), &track, |tick, world| {
        let (garment, cloth) = (&world.garments()[0], &world.cloths()[0]);
        let mut bones = [Affine3A::IDENTITY; BONES];
        palette(&world.body().skeleton, world.pose(), &mut bones);
        for (&i, w) in garment.fixed.iter().zip(&garment.fixed_weights) {
            let rest = Vec3A::from(garment.start[i as usize]);
            let parts = w.bones.iter().zip(w.weights).map(|(b, w)| bones[usize::from(*b)].transform_point3a(rest) * w);
            let off = cloth.positions[i as usize].distance(parts.sum());
            assert!(off < 1e-5, "tick {tick}: particle {i} is {off} m off the skin");
            farthest = farthest.max(cloth.positions[i as usize].distance(rest));
        }
        assert!(!garment.fixed.is_empty());
    });
    assert!(farthest > 0.01, "the shopper moved: {farthest} m");
}

/// Energy of motion of the free particles (J).
fn kinetic_energy(world: &World) -> f32 {
    world.cloths()[0].kinetic_energy(&world.garments()[0]) as f32
}

#[test]
fn a_garment_at_rest_settles() {
    let track = dressed::track(&dressed::shopper(), 0.0, 0.1);
    let mut world = coarse(&track);
    let seconds = 3;
    let mut energy = Vec::new();
    for _ in 0..seconds * STEP_HZ {
        world.step(&track[0]);
        assert!(dressed::is_finite(&world));
        energy.push(kinetic_energy(&world));
    }
    let mean = |part: &[f32]| part.iter().sum::<f32>() / part.len() as f32;
    let seconds: Vec<f32> = energy.chunks(STEP_HZ as usize).map(mean).collect();
    eprintln!("energy of motion in each second: {seconds:?} J");
    assert!(seconds[2] < 0.5 * seconds[0], "it does not come to rest: {seconds:?} J");
    let mass: f32 = world.garments()[0].inverse_mass.iter().filter(|w| **w > 0.0).map(|w| w.recip()).sum();
    let speed = (2.0 * seconds[2] / mass).sqrt();
    assert!(speed < 0.05, "after two seconds it still moves at {speed} m/s");
}

#[test]
fn joints_that_are_no_numbers_leave_no_trace() {
    let track = dressed::track(&dressed::shopper(), 1.6, 3.5);
    let mut world = coarse(&track);
    let mut poser = Poser::new(&world.body().skeleton);
    let mut off = 0.0;
    for tick in 0..400u64 {
        let clean = sample(&track, track[0].time_ns + ticks_to_ns(tick)).expect("a track with frames");
        let mut dirty = clean;
        if (60..90).contains(&tick) {
            for (i, joint) in dirty.joints.iter_mut().enumerate() {
                joint.position = Vec3::splat([f32::NAN, f32::INFINITY, -1e38, 1e30][i % 4]);
                joint.confidence = if i % 5 == 0 { f32::NAN } else { 1.0 };
            }
        }
        world.step(&dirty);
        assert!(dressed::is_finite(&world), "tick {tick}");
        let pose = poser.pose(&clean, STEP_SECONDS);
        let turns = pose.local.iter().zip(&world.pose().local).map(|(a, b)| a.angle_between(*b));
        off = turns.fold(pose.root.distance(world.pose().root), f32::max);
    }
    assert_eq!(world.cloths()[0].events.rolled_back, 0, "the checks before the cloth keep it out");
    assert!(off < 0.05, "two and a half seconds later the pose is still {off} (m or rad) off");
    let strain = measure::strain(&mut world.cloths()[0].clone(), &world.garments()[0]);
    assert!(strain.max < 0.5, "the dress has not recovered: {strain:?}");
}

#[test]
fn a_shopper_who_is_suddenly_elsewhere_keeps_her_dress() {
    let mut track = dressed::track(&dressed::shopper(), 0.0, 4.0);
    for frame in &mut track[30..] {
        frame.joints.iter_mut().for_each(|j| j.position += Vec3::new(2.0, 0.0, -0.5));
    }
    let mut world = coarse(&track);
    let mut arrived = 0.0;
    let mut worst = 0.0f32;
    // As from a live sensor: the latest frame, nothing between two.
    for tick in 0..480u64 {
        let latest = track[(tick / 4) as usize];
        world.step(&latest);
        assert!(dressed::is_finite(&world), "tick {tick}");
        arrived = world.pose().root.x;
        worst = worst.max(measure::strain(&mut world.cloths()[0].clone(), &world.garments()[0]).max);
    }
    let strain = measure::strain(&mut world.cloths()[0].clone(), &world.garments()[0]);
    eprintln!("strain at worst {worst}, three seconds later {strain:?}");
    assert!((arrived - 2.0).abs() < 0.1, "she is at {arrived} m, not at 2 m");
    assert_eq!(world.cloths()[0].events.rolled_back, 0);
    assert!(worst < 0.3, "an edge was stretched by {worst}");
    assert!(strain.p99 < 0.02, "the dress has not recovered: {strain:?}");
    let cloth = world.cloths()[0].positions.iter().map(|p| p.distance(world.pose().root.into())).fold(0.0, f32::max);
    assert!(cloth < 1.5, "a part of the dress stayed behind, {cloth} m away");
}

/// Bounds of calm motion for a garment of each kind: the 99th percentile of strain, averaged over the steps.
const CALM_STRAIN_P99: [(&str, f32); 4] =
    [("strap-dress", 0.03), ("tee", 0.09), ("wide-leg-trousers", 0.03), ("blazer", 0.08)];

/// Deepest penetration in calm motion (m).
const CALM_PENETRATION_M: f32 = 0.003;

#[test]
fn calm_motion_stretches_little_and_stays_outside_of_the_body() {
    // She stands, then lifts the arms: no fast motion yet.
    let track = dressed::track(&dressed::shopper(), 1.0, 1.5);
    std::thread::scope(|scope| {
        for (name, most) in CALM_STRAIN_P99 {
            let track = &track;
            scope.spawn(move || {
                let mut world = dressed::dressed(&[name], track);
                play(&mut world, track, |tick, world| assert!(dressed::is_finite(world), "{name}: tick {tick}"));
                let strain = world.meters().strain();
                let deepest = world.meters().penetration_max;
                eprintln!("{name}: {strain:?}, deepest {:.1} mm", deepest * 1e3);
                assert!(strain.p99 < most, "{name}: {strain:?}");
                assert!(strain.mean > 0.0, "{name}: nothing was measured");
                assert!(deepest < CALM_PENETRATION_M, "{name}: {:.1} mm deep", deepest * 1e3);
            });
        }
    });
}
