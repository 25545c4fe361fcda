//! The benchmark's skirt, small and short: its errors and its hard cases, but no times.

mod faults;

use std::thread;

use toile_assets::scene::skirt::{SkirtMotion, Stretch};
use toile_engine::lanes::Width;
use toile_fitting::heap::HeapProbe;
use toile_perf::skirt::options::{SkirtMesh, SkirtOptions, WARM_UP};
use toile_perf::skirt::{FrameErrors, Gauge, SkirtScene};

use faults::{SkirtFault, SkirtRecovery, heavy_hem, patches, recover};

/// Steps that are measured after the warm-up: a cycle of the walk, two of the fast motion.
const STEPS: usize = 120;

/// Deepest penetration allowed (m).
const DEEPEST_M: f32 = 1e-3;

/// The smallest skirt of the scene.
fn small() -> SkirtOptions {
    SkirtOptions { verts: 1_024, ..SkirtOptions::default() }
}

fn scene(options: &SkirtOptions) -> SkirtScene {
    SkirtScene::new(options, &HeapProbe::none()).expect("the scene can be built")
}

/// Means of strain mean and 99th percentile, worst of all else, over the steps after the warm-up.
fn run(scene: &mut SkirtScene) -> FrameErrors {
    let mut gauge = Gauge::new(scene);
    let mut sum = FrameErrors::default();
    for step in 0..WARM_UP + STEPS {
        scene.prepare();
        scene.step();
        let frame = gauge.read(&scene.cloths[0].positions, &scene.spheres);
        assert_eq!(frame.nonfinite, 0, "step {step}");
        if step >= WARM_UP {
            sum.strain_mean += frame.strain_mean / STEPS as f64;
            sum.strain_p99 += frame.strain_p99 / STEPS as f64;
            sum.beyond_mean += frame.beyond_mean / STEPS as f64;
            sum.beyond_max = sum.beyond_max.max(frame.beyond_max);
            sum.compression_max = sum.compression_max.max(frame.compression_max);
            sum.stretch_max = sum.stretch_max.max(frame.stretch_max);
            sum.deepest = sum.deepest.max(frame.deepest);
            sum.wrong_legs += frame.wrong_legs;
        }
    }
    assert_eq!(scene.events().rolled_back, 0);
    sum
}

/// Strain mean and 99th percentile stay below bounds (%), nothing is inside the body, the hem is around both legs.
fn holds(name: &str, options: &SkirtOptions, [mean, p99]: [f64; 2]) {
    let found = run(&mut scene(options));
    eprintln!("{name}: {found:?}");
    assert!(found.strain_mean * 100.0 <= mean && found.strain_mean > 0.0, "{name}: {found:?}");
    assert!(found.strain_p99 * 100.0 <= p99, "{name}: {found:?}");
    assert!(found.deepest <= DEEPEST_M, "{name}: {found:?}");
    assert_eq!(found.wrong_legs, 0, "{name}: a leg came out of the skirt");
}

#[test]
fn a_walk_strains_the_skirt_by_a_fifth_of_a_per_cent() {
    holds("walk", &small(), [0.2, 2.0]);
}

#[test]
fn a_walk_in_cloth_that_stretches_does_the_same() {
    holds("walk, 2,000 N/m", &SkirtOptions { stretch: Stretch::Physical, ..small() }, [0.2, 2.0]);
}

#[test]
fn a_walk_in_an_irregular_mesh_does_twice_that() {
    holds("irregular", &SkirtOptions { mesh: SkirtMesh::Irregular, ..small() }, [0.4, 4.0]);
}

#[test]
fn in_fast_motion_no_leg_comes_out_of_the_skirt() {
    holds("fast", &SkirtOptions { motion: SkirtMotion::Fast, ..small() }, [1.0, 10.0]);
}

#[test]
fn a_skirt_left_alone_hangs_at_its_elastic_strain_and_comes_to_rest() {
    for stretch in [Stretch::Inextensible, Stretch::Physical] {
        let options = SkirtOptions { motion: SkirtMotion::Settled, stretch, ..small() };
        let mut scene = scene(&options);
        // Ten seconds: the air takes two thirds of the speed in each.
        for _ in 0..1_200 {
            scene.prepare();
            scene.step();
        }
        let frame = Gauge::new(&scene).read(&scene.cloths[0].positions, &scene.spheres);
        let energy = scene.kinetic_energy();
        eprintln!("{stretch:?}: {frame:?}, {energy} J");
        assert!(frame.beyond_mean <= 0.000_5, "{stretch:?}: {frame:?}");
        // The half per cent that is aimed at is missed at the substeps that the bake chooses: 1.1 %, compression in the row
        // that hangs from the pins (.76 % while shear lost most of its stiffness there).
        assert!(frame.beyond_max <= 0.012, "{stretch:?}: {frame:?}");
        assert!(energy <= 1e-3, "{stretch:?}: {energy} J");
    }
}

#[test]
fn no_substep_count_pumps_energy_into_a_skirt_at_rest() {
    for substeps in [2, 8, 32] {
        let mut scene = scene(&SkirtOptions { motion: SkirtMotion::Settled, substeps: Some(substeps), ..small() });
        for _ in 0..1_200 {
            scene.prepare();
            scene.step();
        }
        let energy = scene.kinetic_energy();
        eprintln!("{substeps} substeps: {energy} J");
        assert!(energy <= 1e-3, "{substeps} substeps: {energy} J");
    }
}

fn after(fault: SkirtFault) -> SkirtRecovery {
    let found = recover(&small(), fault);
    eprintln!("{fault:?}: {found:?}");
    assert_eq!(found.nonfinite, 0, "{fault:?}: {found:?}");
    found
}

#[test]
fn a_leg_that_jumps_a_metre_and_back_is_forgotten_in_half_a_second() {
    let found = after(SkirtFault::Jump);
    assert!(found.worst_stretch <= 1.0, "{found:?}");
    assert!(found.recovered_steps <= 60, "{found:?}");
}

#[test]
fn nothing_that_is_no_number_is_published_or_stays() {
    thread::scope(|scope| {
        for value in [f32::NAN, f32::INFINITY] {
            for fault in [SkirtFault::Collider(value), SkirtFault::Particle(value), SkirtFault::Pin(value)] {
                scope.spawn(move || {
                    let found = after(fault);
                    assert!(found.recovered_steps <= 2, "{fault:?}: {found:?}");
                });
            }
        }
    });
}

/// How much a strain that is stable may differ from one cycle to the next (1).
const STEADY: f64 = 1.5;

#[test]
fn long_steps_and_unequal_masses_are_stable() {
    let slow = scene(&SkirtOptions { step_s: 1.0 / 30.0, ..small() });
    let patched = SkirtScene::with(&small(), &HeapProbe::none(), patches).expect("the scene can be built");
    let hemmed = SkirtScene::with(&small(), &HeapProbe::none(), heavy_hem).expect("the scene can be built");
    for (name, mut scene) in [("dt = 1/30", slow), ("patches", patched), ("heavy hem", hemmed)] {
        let [first, last] = [(); 2].map(|()| run(&mut scene));
        eprintln!("{name}: {first:?}, then {last:?}");
        assert!(last.strain_mean <= STEADY * first.strain_mean, "{name}: {first:?}, then {last:?}");
        let farthest = scene.cloths[0].positions.iter().map(|p| p.length()).fold(0.0, f32::max);
        assert!(farthest < 3.0, "{name}: a part of the skirt is {farthest} m away");
    }
}

#[test]
fn every_width_and_every_run_gives_the_same_bits() {
    let play = |width: Width| {
        let mut scene = scene(&SkirtOptions { motion: SkirtMotion::Fast, lanes: Some(width), ..small() });
        for _ in 0..STEPS {
            scene.prepare();
            scene.step();
        }
        scene.state_hash()
    };
    let widest = play(Width::widest());
    assert_eq!(widest, play(Width::widest()));
    for width in Width::ALL.into_iter().filter(|w| w.available()) {
        assert_eq!(play(width), widest, "{width:?}");
    }
}

#[test]
fn an_irregular_skirt_has_the_same_bits_with_two_workers_and_at_every_width() {
    let play = |threads: usize, width: Width| {
        let stepped = SkirtOptions {
            mesh: SkirtMesh::Irregular,
            lanes: Some(width),
            verts: 9_216,
            threads,
            ..SkirtOptions::default()
        };
        let mut scene = scene(&stepped);
        for _ in 0..8 {
            scene.prepare();
            scene.step();
        }
        scene.state_hash()
    };
    let one = play(1, Width::widest());
    for width in Width::ALL.into_iter().filter(|w| w.available()) {
        assert_eq!(play(2, width), one, "{width:?}");
    }
}

#[test]
fn fibers_that_end_before_others_of_their_bundle_have_the_same_bits_at_every_width() {
    // The last rows of a small irregular mesh have fewer fibers than a vector has lanes, at the very end of its particles.
    for verts in [196, 256, 484, 576] {
        let play = |width: Width| {
            let mesh = SkirtMesh::Irregular;
            let mut scene = scene(&SkirtOptions { mesh, lanes: Some(width), verts, ..SkirtOptions::default() });
            for _ in 0..8 {
                scene.prepare();
                scene.step();
            }
            scene.state_hash()
        };
        let plain = play(Width::One);
        for width in Width::ALL.into_iter().filter(|w| w.available()) {
            assert_eq!(play(width), plain, "{verts} vertices, {width:?}");
        }
    }
}

/// Hash of the skirt of 9,216 vertices after [`GOLDEN_STEPS`] of walking. A change of it is a change of what every user
/// sees: it has to be meant, and said in the changelog. (Sines of the scene come from the platform's library; the hash is
/// that of Linux on x86-64.)
const GOLDEN: u64 = 0x0968_5acc_582b_f880;

/// Farthest that a settled skirt whose bending rubs may creep in a minute (m).
const CREEP_M: f32 = 1e-3;

#[test]
fn a_settled_skirt_that_rubs_creeps_less_than_a_millimetre_a_minute() {
    let mut scene = scene(&SkirtOptions { motion: SkirtMotion::Settled, hysteresis: true, ..small() });
    let mut run = |seconds: usize| {
        for _ in 0..120 * seconds {
            scene.prepare();
            scene.step();
        }
        scene.cloths[0].positions.clone()
    };
    let (before, after) = (run(15), run(60));
    let crept = before.iter().zip(&after).map(|(p, q)| p.distance(*q)).fold(0.0, f32::max);
    eprintln!("{} mm in a minute", crept * 1e3);
    assert!(crept < CREEP_M, "{crept} m");
}

#[test]
fn bending_that_rubs_gives_the_same_bits_by_one_worker_and_two_and_others_than_without() {
    let play = |threads: usize, hysteresis: bool| {
        let mut scene = scene(&SkirtOptions { verts: 9_216, threads, hysteresis, ..SkirtOptions::default() });
        for _ in 0..GOLDEN_STEPS {
            scene.prepare();
            scene.step();
        }
        scene.state_hash()
    };
    let one = play(1, true);
    assert_eq!(play(2, true), one, "two workers");
    assert_ne!(play(1, false), one, "friction changes nothing");
}

#[test]
fn curved_links_give_equal_bits_at_every_width() {
    let play = |threads: usize, lanes: Width, curved: bool| {
        let mut scene = scene(&SkirtOptions {
            verts: 9_216,
            threads,
            lanes: Some(lanes),
            stretch: Stretch::Physical,
            curves: curved,
            buckling: curved,
            ..SkirtOptions::default()
        });
        for _ in 0..GOLDEN_STEPS {
            scene.prepare();
            scene.step();
        }
        scene.state_hash()
    };
    let one = play(1, Width::widest(), true);
    assert_ne!(play(1, Width::widest(), false), one, "the curves change nothing");
    for width in Width::ALL.into_iter().filter(|w| w.available()) {
        assert_eq!(play(2, width, true), one, "{width:?}");
    }
}

/// Steps to the golden hash.
const GOLDEN_STEPS: usize = 40;

#[test]
fn one_worker_and_two_give_the_golden_bits_with_and_without_wind() {
    let play = |threads: usize, wind: bool| {
        // Large enough to be shared by two workers.
        let options = SkirtOptions { verts: 9_216, threads, wind, ..SkirtOptions::default() };
        let mut scene = scene(&options);
        for _ in 0..GOLDEN_STEPS {
            scene.prepare();
            scene.step();
        }
        scene.state_hash()
    };
    let one = play(1, false);
    assert_eq!(play(2, false), one, "two workers");
    assert_eq!(play(2, true), play(1, true), "two workers in the wind");
    if cfg!(all(target_os = "linux", target_arch = "x86_64")) {
        assert_eq!(one, GOLDEN, "{one:#018x} is what it is now");
    }
}
