//! Whole steps against the CPU's.

use glam::Vec3A;
use toile_assets::garment::Garment;
use toile_assets::scene::skirt::{self as scene, Motion, Stretch};
use toile_engine::cloth::{Cloth, Quality, RootSettings, Settings, Wind, measure};

use crate::scene::{REST, apart, around, irregular, nobody, offload, offload_worn, skirt, swaying, walker, worn};

/// How the body walks.
const MOTION: Motion = Motion::Walk;

/// Mean distance that up to 20 steps, and a second of them, may leave between two devices of which one fuses products and
/// sums (m). A hem that swings free doubles what sets it off every few steps: one last bit of one link grew to 3 um and 5 mm.
const MEAN: [f32; 2] = [1e-4, 2e-2];

/// Steps garments on both; gives the mean distance (m) of each at the end, whether all bits are the same, and whether they
/// have to be.
fn both(garments: &[&Garment], settings: impl Fn(usize) -> Settings, steps: usize) -> Option<(Vec<f32>, bool, bool)> {
    let mut gpu = offload(garments, &settings(0))?;
    let colliders = nobody();
    let mut cloths: Vec<Cloth> = garments.iter().map(|g| Cloth::new(g, &colliders).in_wind(g)).collect();
    for n in 0..steps {
        let palette = swaying(n);
        let settings = &settings(n);
        let all: Vec<_> = garments.iter().map(|_| around(&palette, &colliders, settings)).collect();
        for ((cloth, garment), step) in cloths.iter_mut().zip(garments).zip(&all) {
            cloth.step(garment, step);
        }
        gpu.step(garments, &all).expect("the step is sent");
    }
    gpu.finish().expect("the last step comes back");
    let (mut means, mut same) = (Vec::new(), true);
    for (k, (cloth, garment)) in cloths.iter_mut().zip(garments).enumerate() {
        let (alike, all, most) = apart(gpu.positions(k), &cloth.positions);
        let pairs = gpu.positions(k).iter().zip(&*cloth.positions);
        let mean = pairs.map(|(a, b)| a.distance(*b)).sum::<f32>() / cloth.positions.len() as f32;
        let strain = measure::strain(cloth, garment).mean * 100.0;
        println!("{}: {alike} of {all} the same, mean {mean} m, most {most} m, strain {strain} %", garment.name);
        assert_eq!(gpu.events(k).rolled_back, 0);
        assert_eq!(gpu.events(k).speed_limited, cloth.events.speed_limited);
        assert_eq!(gpu.substeps(k), cloth.substeps());
        means.push(mean);
        same &= alike == all;
    }
    Some((means, same, gpu.device().adapter().kind == "software"))
}

fn held(garments: &[&Garment], settings: &Settings, steps: usize) {
    let Some((means, same, software)) = both(garments, |_| *settings, steps) else { return };
    let bound = MEAN[usize::from(steps > 20)];
    assert!(means.iter().all(|m| *m <= bound), "{means:?} m apart");
    assert!(same || !software, "{means:?} m apart on an adapter that fuses nothing");
}

#[test]
fn a_second_of_the_skirt_is_the_cpus() {
    held(&[&skirt(20, Stretch::Inextensible)], &Settings::default(), 120);
}

#[test]
fn a_skirt_of_long_fibers_stays_near_the_cpus() {
    let garment = skirt(98, Stretch::Inextensible);
    let Some((means, same, _)) = both(&[&garment], |_| Settings::default(), 6) else { return };
    assert!(!same, "cyclic reduction rounds otherwise: was it run?");
    assert!(means[0] <= MEAN[0], "{means:?} m apart");
}

/// Steps the skirt on its walking body, `speed` times as fast as it walks.
fn walked(n: usize, speed: f64, steps: usize) {
    let (garment, settings) = (skirt(n, Stretch::Inextensible), Settings::default());
    let mut colliders = walker();
    let Some(mut gpu) = offload_worn(&[&garment], &[&colliders], &settings) else { return };
    let mut cloth = Cloth::new(&garment, &colliders);
    let mut palette = REST;
    for k in 0..steps {
        let time = speed * k as f64 / 120.0;
        palette[0] = scene::root(MOTION, time);
        colliders.place_spheres(&scene::spheres(MOTION, time));
        let step = around(&palette, &colliders, &settings);
        cloth.step(&garment, &step);
        gpu.step(&[&garment], &[step]).expect("the step is sent");
    }
    gpu.finish().expect("the last step comes back");
    let tally = cloth.contact_counts();
    let (alike, all, most) = apart(gpu.positions(0), &cloth.positions);
    println!("walking skirt x {speed}: {alike} of {all} the same, most {most} m, {tally:?}");
    assert!(tally.near > 0, "the body was not met");
    assert!(speed < 2.0 || tally.swept > 0, "nothing was fast");
    let software = gpu.device().adapter().kind == "software";
    assert!(!software || alike == all, "{most} m apart on an adapter that fuses nothing");
    assert!(most < 0.05, "{most} m apart");
    assert_eq!((gpu.events(0).rolled_back, cloth.events.rolled_back), (0, 0));
}

#[test]
fn a_skirt_on_a_walking_body_is_the_cpus() {
    walked(20, 1.0, 60);
}

#[test]
fn what_is_fast_is_followed_as_on_the_cpu() {
    walked(18, 6.0, 40);
}

#[test]
fn every_quality_is_the_cpus() {
    for quality in Quality::ALL {
        let settings = Settings { quality, ..Settings::default() };
        held(&[&skirt(16, Stretch::Physical)], &settings, 20);
    }
}

#[test]
fn garments_of_one_scene_do_not_see_each_other() {
    let garments = [skirt(18, Stretch::Physical), worn("t-shirt"), skirt(26, Stretch::Inextensible)];
    let garments: Vec<&Garment> = garments.iter().collect();
    held(&garments, &Settings::default(), 12);
    // With as many substeps for each, and with fewer than they ask for.
    held(&garments, &Settings { substeps: Some(3), ..Settings::default() }, 4);
    held(&garments, &Settings { substep_share: 0.5, ..Settings::default() }, 4);
}

#[test]
fn a_garment_solved_once_a_substep_stands_beside_others() {
    let scattered = irregular(20, Stretch::Physical);
    assert!(scattered.layout().is_scattered());
    let garments = [skirt(18, Stretch::Inextensible), scattered, worn("t-shirt")];
    let garments: Vec<&Garment> = garments.iter().collect();
    held(&garments[1..2], &Settings::default(), 20);
    held(&garments, &Settings::default(), 12);
    held(&garments, &Settings { substeps: Some(5), ..Settings::default() }, 4);
}

/// A gust, and a root of which little is felt.
fn blown(wind: bool, carried: bool) -> Settings {
    let wind = wind.then_some(Wind { velocity: Vec3A::new(4.0, 0.5, -3.0), drag: 0.6, lift: 0.2 });
    let less = RootSettings { linear: 0.2, angular: 0.4, centrifugal: 0.5, ..RootSettings::default() };
    Settings { wind, root: if carried { less } else { RootSettings::default() }, ..Settings::default() }
}

#[test]
fn what_is_in_the_wind_is_blown_as_on_the_cpu() {
    held(&[&skirt(18, Stretch::Inextensible), &worn("t-shirt")], &blown(true, false), 20);
}

#[test]
fn what_is_not_to_feel_the_root_does_not_feel_it_as_on_the_cpu() {
    let garments = [skirt(18, Stretch::Inextensible), worn("t-shirt")];
    let garments: Vec<&Garment> = garments.iter().collect();
    held(&garments, &blown(false, true), 20);
    held(&garments, &blown(true, true), 8);
}

#[test]
fn settings_may_change_from_step_to_step() {
    let garments = [worn("t-shirt"), skirt(16, Stretch::Physical)];
    let garments: Vec<&Garment> = garments.iter().collect();
    // Bending in stages and as a force, with and without what else pushes the particles.
    let each = [blown(false, false), blown(true, false), blown(true, true), blown(false, true)];
    let few = |s: Settings| Settings { substep_share: 0.5, ..s };
    let all: Vec<Settings> = each.into_iter().flat_map(|s| [s, few(s)]).collect();
    let Some((_, same, software)) = both(&garments, |n| all[n % all.len()], 16) else { return };
    assert!(same || !software, "another result on an adapter that fuses nothing");
}

#[test]
fn a_run_gives_the_same_bits_again() {
    let (garment, settings, colliders) = (skirt(16, Stretch::Inextensible), Settings::default(), nobody());
    let run = || {
        let mut gpu = offload(&[&garment], &settings)?;
        for n in 0..10 {
            gpu.step(&[&garment], &[around(&swaying(n), &colliders, &settings)]).expect("the step is sent");
        }
        gpu.finish().expect("the last step comes back");
        Some(gpu.positions(0).to_vec())
    };
    assert_eq!(run(), run());
}
