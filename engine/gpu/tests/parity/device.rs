//! What fails: a device that is lost, what no kernel does, results that are not fetched, numbers that are none.

use glam::{Affine3A, Vec3A};
use toile_assets::scene::skirt::Stretch;
use toile_assets::skeleton::BONES;
use toile_engine::cloth::{Cloth, Settings, Wind};
use toile_gpu::device::GpuError;

use crate::scene::{REST, apart, around, disturbed, nobody, offload, skirt};

#[test]
fn a_lost_device_is_an_error_and_the_last_places_stay() {
    let (garment, settings, colliders) = (skirt(12, Stretch::Inextensible), Settings::default(), nobody());
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
fn what_no_kernel_does_is_refused_in_a_sentence() {
    let (garment, settings) = (skirt(12, Stretch::Inextensible), Settings::default());
    let Some(mut gpu) = offload(&[&garment], &settings) else { return };
    let wind = Some(Wind { velocity: Vec3A::X, drag: 0.1, lift: 0.05 });
    let colliders = nobody();
    let windy = Settings { wind, ..settings };
    let error = gpu.step(&[&garment], &[around(&REST, &colliders, &windy)]).expect_err("there is no kernel for wind");
    assert!(error.to_string().contains("skirt") && error.to_string().contains("wind"), "{error}");
    let many = Settings { substeps: Some(400), ..settings };
    let error = gpu.step(&[&garment], &[around(&REST, &colliders, &many)]).expect_err("there is no room for so many");
    assert!(error.to_string().contains("substeps"), "{error}");
    gpu.step(&[&garment], &[around(&REST, &colliders, &settings)]).expect("and what is right goes on");
}

#[test]
fn results_come_back_late_and_are_dropped_rather_than_waited_for() {
    let (garment, settings, colliders) = (skirt(12, Stretch::Inextensible), Settings::default(), nobody());
    let Some(mut gpu) = offload(&[&garment], &settings) else { return };
    for _ in 0..20 {
        gpu.step(&[&garment], &[around(&REST, &colliders, &settings)]).expect("the step is sent");
    }
    gpu.finish().expect("the last step comes back");
    let tally = gpu.tally();
    assert!(tally.sent <= 20 && tally.taken >= 1, "{tally:?}");
    // Each step was taken, overtaken by a later one, or never sent.
    assert_eq!(tally.taken + tally.dropped, 20, "{tally:?}");
}

#[test]
fn a_number_that_is_none_is_rolled_back_on_the_device() {
    let (garment, settings, colliders) = (skirt(12, Stretch::Inextensible), Settings::default(), nobody());
    let Some(mut gpu) = offload(&[&garment], &settings) else { return };
    let step = [around(&REST, &colliders, &settings)];
    gpu.step(&[&garment], &step).expect("the step is sent");
    gpu.finish().expect("it comes back");
    let good = gpu.positions(0).to_vec();
    let (mut x, v) = disturbed(&garment);
    x[80] = Vec3A::NAN;
    gpu.disturb(0, &x, &v);
    gpu.step(&[&garment], &step).expect("the step is sent");
    gpu.finish().expect("it comes back");
    assert_eq!(gpu.events(0).rolled_back, 1);
    assert_eq!(gpu.positions(0), good);
    assert!(gpu.particles(0).expect("read").v.iter().all(|v| *v == Vec3A::ZERO));
    gpu.step(&[&garment], &step).expect("the step is sent");
    gpu.finish().expect("it comes back");
    assert_eq!(gpu.events(0).rolled_back, 1, "one fault, one step");
}

#[test]
fn a_root_that_jumps_takes_the_garment_along() {
    let (garment, settings, colliders) = (skirt(12, Stretch::Inextensible), Settings::default(), nobody());
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
