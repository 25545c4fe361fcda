//! What fails: a device that is lost, what no kernel does, results that are not fetched, numbers that are none.

use glam::{Affine3A, Vec3A};
use toile_assets::scene::skirt::Stretch;
use toile_base::skeleton::BONES;
use toile_engine::cloth::{Cloth, Settings};
use toile_gpu::device::GpuError;

use super::scene::{REST, apart, around, disturbed, no_body, offload, skirt, swaying};

#[test]
fn a_lost_device_is_an_error_and_the_last_places_stay() {
    let (garment, settings, colliders) = (skirt(12, Stretch::Inextensible), Settings::default(), no_body());
    let Some(mut gpu) = offload(&[&garment], &settings) else { return };
    let step = [around(&REST, &colliders, &settings)];
    gpu.step(&[&garment], &step).expect("the first step is sent");
    gpu.finish().expect("it comes back");
    let before = gpu.positions(0).to_vec();
    gpu.device().lose();
    assert!(matches!(gpu.step(&[&garment], &step), Err(GpuError::Lost(_))));
    assert_eq!(gpu.positions(0), before);
}

#[test]
fn too_many_substeps_are_refused_in_a_sentence() {
    let (garment, settings, colliders) = (skirt(12, Stretch::Inextensible), Settings::default(), no_body());
    let Some(mut gpu) = offload(&[&garment], &settings) else { return };
    let many = Settings { substeps: Some(400), ..settings };
    let error = gpu.step(&[&garment], &[around(&REST, &colliders, &many)]).expect_err("there is no room for so many");
    assert!(error.to_string().contains("skirt") && error.to_string().contains("substeps"), "{error}");
    gpu.step(&[&garment], &[around(&REST, &colliders, &settings)]).expect("and what is right goes on");
}

#[test]
fn results_come_back_late_and_are_dropped_rather_than_waited_for() {
    let (garment, settings, colliders) = (skirt(12, Stretch::Inextensible), Settings::default(), no_body());
    let Some(mut gpu) = offload(&[&garment], &settings) else { return };
    for _ in 0..20 {
        gpu.step(&[&garment], &[around(&REST, &colliders, &settings)]).expect("the step is sent");
    }
    gpu.finish().expect("the last step comes back");
    let tally = gpu.tally();
    assert!(tally.sent <= 20 && tally.taken >= 1, "{tally:?}");
    // Each step was taken, overtaken by a later one, or never sent.
    // Where the last was dropped, `finish` has fetched it.
    assert!((20..=21).contains(&(tally.taken + tally.dropped)), "{tally:?}");
}

#[test]
fn a_step_that_ends_with_a_number_that_is_none_is_rolled_back_on_the_device() {
    let (garment, settings, colliders) = (skirt(12, Stretch::Inextensible), Settings::default(), no_body());
    let Some(mut gpu) = offload(&[&garment], &settings) else { return };
    let step = [around(&REST, &colliders, &settings)];
    let (x, mut v) = disturbed(&garment);
    // A number when the step begins, and far beyond them when lengths are squared.
    v[80] = Vec3A::splat(1e35);
    gpu.disturb(0, &x, &v);
    gpu.step(&[&garment], &step).expect("the step is sent");
    gpu.finish().expect("it comes back");
    assert_eq!((gpu.events(0).repaired, gpu.events(0).rolled_back), (0, 1));
    assert_eq!(gpu.positions(0), x);
    assert!(gpu.particles(0).expect("read").v.iter().all(|v| *v == Vec3A::ZERO));
    gpu.step(&[&garment], &step).expect("the step is sent");
    gpu.finish().expect("it comes back");
    assert_eq!(gpu.events(0).rolled_back, 1, "one fault, one step");
}

/// Steps a skirt on both after one particle got a place and a velocity; gives how many particles were repaired and how many
/// steps rolled back, the same on both.
fn poisoned(place: Option<Vec3A>, velocity: Option<Vec3A>) -> Option<(u64, u64)> {
    let (garment, settings, colliders) = (skirt(12, Stretch::Inextensible), Settings::default(), no_body());
    let mut gpu = offload(&[&garment], &settings)?;
    let mut cloth = Cloth::new(&garment, &colliders);
    for n in 0..8 {
        if n == 3 {
            let state = gpu.particles(0).expect("read");
            let (mut x, mut v) = (state.x, state.v);
            (x[80], v[80]) = (place.unwrap_or(x[80]), velocity.unwrap_or(v[80]));
            gpu.disturb(0, &x, &v);
            cloth.disturb(80, x[80], v[80]);
        }
        let palette = swaying(n);
        let step = around(&palette, &colliders, &settings);
        cloth.step(&garment, &step);
        gpu.step(&[&garment], &[step]).expect("the step is sent");
    }
    gpu.finish().expect("the last step comes back");
    let (report, events) = (gpu.events(0), cloth.events);
    let (alike, all, most) = apart(gpu.positions(0), &cloth.positions);
    println!("{place:?} {velocity:?}: {alike} of {all} the same, {report:?}");
    let counts = (report.repaired, report.rolled_back);
    assert_eq!(counts, (events.repaired, events.rolled_back), "{place:?} {velocity:?}");
    let software = gpu.device().adapter().kind == "software";
    assert!(!software || alike == all, "{place:?} {velocity:?}: {most} m apart");
    Some(counts)
}

#[test]
fn the_same_poison_has_the_same_end_on_both() {
    let far = Vec3A::splat(1e30);
    let Some(counts) = poisoned(Some(Vec3A::NAN), None) else { return };
    assert_eq!(counts, (1, 0));
    assert_eq!(poisoned(Some(Vec3A::new(0.0, f32::INFINITY, 0.0)), None), Some((1, 0)));
    assert_eq!(poisoned(None, Some(Vec3A::new(0.0, 0.0, f32::NEG_INFINITY))), Some((1, 0)));
    assert_eq!(poisoned(Some(Vec3A::NAN), Some(Vec3A::NAN)), Some((1, 0)));
    // As good a place as the caller says it is: step after step it is put back there, and the garment is rolled back.
    assert!(poisoned(Some(far), None).is_some_and(|(repaired, rolled_back)| repaired > 0 && rolled_back > 0));
    assert!(poisoned(None, Some(far)).is_some_and(|(_, rolled_back)| rolled_back > 0));
}

#[test]
fn what_spoils_the_state_is_repaired_as_on_the_cpu() {
    let (garment, settings, colliders) = (skirt(14, Stretch::Physical), Settings::default(), no_body());
    let Some(mut gpu) = offload(&[&garment], &settings) else { return };
    let mut cloth = Cloth::new(&garment, &colliders);
    for n in 0..24 {
        if n % 4 == 3 {
            cloth.inject_fault(n);
            gpu.inject_fault(0, n);
        }
        let palette = swaying(n as usize);
        let step = around(&palette, &colliders, &settings);
        cloth.step(&garment, &step);
        gpu.step(&[&garment], &[step]).expect("the step is sent");
    }
    gpu.finish().expect("the last step comes back");
    let (alike, all, most) = apart(gpu.positions(0), &cloth.positions);
    let (report, events) = (gpu.events(0), cloth.events);
    println!("spoilt six times: {alike} of {all} the same, {report:?}");
    assert!(events.repaired >= 24 && report.repaired >= 24, "{events:?} {report:?}");
    assert_eq!(events.rolled_back, report.rolled_back);
    // How far a fault spreads before it is found is a matter of last bits where a device fuses.
    let software = gpu.device().adapter().kind == "software";
    assert!(!software || alike == all && events.repaired == report.repaired, "{most} m apart, {events:?} {report:?}");
}

#[test]
fn a_root_that_jumps_takes_the_garment_along() {
    let (garment, settings, colliders) = (skirt(12, Stretch::Inextensible), Settings::default(), no_body());
    let Some(mut gpu) = offload(&[&garment], &settings) else { return };
    let mut cloth = Cloth::new(&garment, &colliders);
    let away = [Affine3A::from_translation(glam::Vec3::new(3.0, 0.0, -2.0)); BONES];
    for palette in [&REST, &REST, &away, &away] {
        let step = around(palette, &colliders, &settings);
        gpu.step(&[&garment], &[step]).expect("the step is sent");
        cloth.step(&garment, &step);
    }
    gpu.finish().expect("it comes back");
    assert_eq!(cloth.events.teleports, 1);
    let (_, _, most) = apart(gpu.positions(0), &cloth.positions);
    assert!(most < 1e-5, "{most} m apart");
}
