//! Whole steps against the CPU's.

use glam::Vec3A;
use toile_assets::scene::skirt::{self as scene, SkirtMotion, Stretch};
use toile_base::garment::Garment;
use toile_engine::cloth::{Cloth, Quality, RootSettings, Settings, Wind, step::measure};

use super::scene::{
    REST, apart, around, irregular, no_body, nudge, offload, offload_worn, skirt, swaying, walker, worn,
};

/// How the body walks.
const MOTION: SkirtMotion = SkirtMotion::Walk;

/// How much farther from the processor a device that fuses products and sums may come than the processor itself does with last
/// bits changed before every step, and what both may (m). A hem that swings free doubles what sets it off every few steps, and the
/// device rounds otherwise in each phase of each substep.
const OF_NUDGED: f32 = 4.0;
const ANY: f32 = 1e-5;

/// Whether a device is no farther off than it may be: its distance and the nudged processor's (m).
fn near(off: f32, nudged: f32) -> bool {
    off <= ANY + OF_NUDGED * nudged
}

/// How garments came out on both.
struct Outcome {
    /// Mean distance of each garment to the processor's (m): the device's, and that of the processor with last bits changed.
    means: Vec<[f32; 2]>,
    /// Whether all bits are the same.
    same: bool,
    /// Whether they have to be.
    software: bool,
}

impl Outcome {
    fn hold(&self) {
        assert!(self.means.iter().all(|[off, nudged]| near(*off, *nudged)), "{:?} m apart", self.means);
        assert!(self.same || !self.software, "{:?} m apart on an adapter that fuses nothing", self.means);
    }
}

/// Mean and largest distance of particles (m).
fn distance(one: &[Vec3A], other: &[Vec3A]) -> [f32; 2] {
    let each = || one.iter().zip(other).map(|(a, b)| a.distance(*b));
    [each().sum::<f32>() / one.len() as f32, each().fold(0.0, f32::max)]
}

/// Steps garments on both, and on the processor with last bits changed.
fn both(garments: &[&Garment], settings: impl Fn(usize) -> Settings, steps: usize) -> Option<Outcome> {
    let mut gpu = offload(garments, &settings(0))?;
    let colliders = no_body();
    let mut cloths: Vec<Cloth> = garments.iter().map(|g| Cloth::new(g, &colliders).in_wind(g)).collect();
    let (mut nudged, mut chance) = (cloths.clone(), 1);
    for n in 0..steps {
        let palette = swaying(n);
        let settings = &settings(n);
        let all: Vec<_> = garments.iter().map(|_| around(&palette, &colliders, settings)).collect();
        for (((cloth, nudged), garment), step) in cloths.iter_mut().zip(&mut nudged).zip(garments).zip(&all) {
            cloth.step(garment, step);
            nudge(nudged, garment, &mut chance);
            nudged.step(garment, step);
        }
        gpu.step(garments, &all).expect("the step is sent");
    }
    gpu.finish().expect("the last step comes back");
    let (mut means, mut same) = (Vec::new(), true);
    for (k, (cloth, garment)) in cloths.iter_mut().zip(garments).enumerate() {
        let (alike, all, _) = apart(gpu.positions(k), &cloth.positions);
        let [[mean, most], [shaken, _]] =
            [gpu.positions(k), &nudged[k].positions].map(|other| distance(other, &cloth.positions));
        let strain = measure::strain(cloth, garment).mean * 100.0;
        println!(
            "{}: {alike} of {all} the same, mean {mean} m ({shaken} m by last bits alone), most {most} m, strain {strain} %",
            garment.name
        );
        assert_eq!(gpu.events(k).rolled_back, 0);
        assert_eq!(gpu.events(k).speed_limited, cloth.events.speed_limited);
        assert_eq!(gpu.substeps(k), cloth.substeps());
        means.push([mean, shaken]);
        same &= alike == all;
    }
    Some(Outcome { means, same, software: gpu.device().adapter().kind == "software" })
}

fn held(garments: &[&Garment], settings: &Settings, steps: usize) {
    if let Some(outcome) = both(garments, |_| *settings, steps) {
        outcome.hold();
    }
}

#[test]
fn a_second_of_the_skirt_is_the_cpus() {
    held(&[&skirt(20, Stretch::Inextensible)], &Settings::default(), 120);
}

/// Mean distance that six steps with cyclic reduction may leave (m): it rounds in another order, on whatever device.
const CYCLIC: f32 = 1e-4;

#[test]
fn a_skirt_of_long_fibers_stays_near_the_cpus() {
    let garment = skirt(98, Stretch::Inextensible);
    let Some(Outcome { means, same, .. }) = both(&[&garment], |_| Settings::default(), 6) else { return };
    assert!(!same, "cyclic reduction rounds otherwise: was it run?");
    assert!(means[0][0] <= CYCLIC, "{means:?} m apart");
}

/// Steps the skirt on its walking body, `speed` times as fast as it walks.
fn walked(n: usize, speed: f64, steps: usize) {
    let (garment, settings) = (skirt(n, Stretch::Inextensible), Settings::default());
    let mut colliders = walker();
    let Some(mut gpu) = offload_worn(&[&garment], &[&colliders], &settings) else { return };
    let mut cloth = Cloth::new(&garment, &colliders);
    let (mut nudged, mut chance) = (cloth.clone(), 1);
    let mut palette = REST;
    for k in 0..steps {
        let time = speed * k as f64 / 120.0;
        palette[0] = scene::root(MOTION, time);
        colliders.place_spheres(&scene::spheres(MOTION, time));
        let step = around(&palette, &colliders, &settings);
        cloth.step(&garment, &step);
        nudge(&mut nudged, &garment, &mut chance);
        nudged.step(&garment, &step);
        gpu.step(&[&garment], &[step]).expect("the step is sent");
    }
    gpu.finish().expect("the last step comes back");
    let tally = cloth.contact_counts();
    let (alike, all, most) = apart(gpu.positions(0), &cloth.positions);
    let [off, shaken] = [gpu.positions(0), &nudged.positions].map(|other| distance(other, &cloth.positions)[0]);
    println!(
        "walking skirt x {speed}: {alike} of {all} the same, mean {off} m ({shaken} m by last bits alone), {tally:?}"
    );
    assert!(tally.near > 0, "the body was not met");
    assert!(speed < 2.0 || tally.swept > 0, "nothing was fast");
    let software = gpu.device().adapter().kind == "software";
    assert!(!software || alike == all, "{most} m apart on an adapter that fuses nothing");
    assert!(near(off, shaken), "{off} m apart, {shaken} m by last bits alone");
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
    let garments = [skirt(18, Stretch::Physical), worn("tee"), skirt(26, Stretch::Inextensible)];
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
    let garments = [skirt(18, Stretch::Inextensible), scattered, worn("tee")];
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
    held(&[&skirt(18, Stretch::Inextensible), &worn("tee")], &blown(true, false), 20);
}

#[test]
fn what_is_not_to_feel_the_root_does_not_feel_it_as_on_the_cpu() {
    let garments = [skirt(18, Stretch::Inextensible), worn("tee")];
    let garments: Vec<&Garment> = garments.iter().collect();
    held(&garments, &blown(false, true), 20);
    held(&garments, &blown(true, true), 8);
}

#[test]
fn settings_may_change_from_step_to_step() {
    let garments = [worn("tee"), skirt(16, Stretch::Physical)];
    let garments: Vec<&Garment> = garments.iter().collect();
    // Bending in stages and as a force, with and without what else pushes the particles.
    let each = [blown(false, false), blown(true, false), blown(true, true), blown(false, true)];
    let few = |s: Settings| Settings { substep_share: 0.5, ..s };
    let all: Vec<Settings> = each.into_iter().flat_map(|s| [s, few(s)]).collect();
    if let Some(outcome) = both(&garments, |n| all[n % all.len()], 16) {
        outcome.hold();
    }
}

#[test]
fn a_run_gives_the_same_bits_again() {
    let (garment, settings, colliders) = (skirt(16, Stretch::Inextensible), Settings::default(), no_body());
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
