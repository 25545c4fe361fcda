//! The stepper: what is asked for steps, what is disturbed is taken along, and a device that fails loses no garment.

use std::time::{Duration, Instant};

use glam::{Affine3A, Vec3, Vec3A};
use toile_assets::scene::skirt::Stretch;
use toile_base::garment::Garment;
use toile_base::skeleton::BONES;
use toile_engine::cloth::{Cloth, Settings, Step, Wind};
use toile_gpu::backend::{Backend, Backends, ClothStepper};
use toile_gpu::cloth_batch::ClothBatch;
use toile_gpu::graphics::Graphics;

use super::scene::{REST, around, no_body, skirt, swaying};

/// An open device; none where this machine has none, which CI does not excuse.
fn graphics() -> Option<Graphics> {
    match Graphics::open() {
        Ok(graphics) => Some(graphics),
        Err(error) => {
            assert_ne!(std::env::var("CI").as_deref(), Ok("true"), "{error}");
            eprintln!("not run: {error}");
            None
        }
    }
}

/// Steps cloths with a stepper.
fn step(stepper: &mut ClothStepper, cloths: &mut [Cloth], garments: &[&Garment], n: usize, settings: &Settings) {
    let (palette, colliders) = (swaying(n), no_body());
    let steps: Vec<_> = garments.iter().map(|_| around(&palette, &colliders, settings)).collect();
    stepper.step(&mut ClothBatch { cloths, garments, steps: &steps }, None).expect("no worker panics");
}

#[test]
fn a_device_gives_what_the_processor_gives_with_disturbances_and_other_settings_in_between() {
    let Some(graphics) = graphics() else { return };
    let garment = [skirt(14, Stretch::Physical), skirt(12, Stretch::Inextensible)];
    let garments: Vec<&Garment> = garment.iter().collect();
    let cloths: Vec<Cloth> = garments.iter().map(|g| Cloth::new(g, &no_body())).collect();
    let [mut one, mut other] = [cloths.clone(), cloths];
    let mut cpu = ClothStepper::cpu();
    let mut gpu = Backends::from(graphics.clone()).stepper();
    for n in 0..24 {
        // More substeps than the best quality has, for a while: it has to be laid out again.
        let many = (8..12).contains(&n).then_some(40);
        let settings = Settings { substeps: many, ..Settings::default() };
        if n == 5 {
            for cloths in [&mut one, &mut other] {
                let at = cloths[1].positions[100];
                cloths[1].disturb(100, at + Vec3A::X * 0.004, Vec3A::Y * 0.3);
            }
        }
        if n % 7 == 6 {
            one[0].inject_fault(n as u64);
            other[0].inject_fault(n as u64);
        }
        step(&mut cpu, &mut one, &garments, n, &settings);
        step(&mut gpu, &mut other, &garments, n, &settings);
        assert_eq!(one[0].substeps(), other[0].substeps());
    }
    assert_eq!((gpu.backend(), gpu.fallback()), (Backend::Gpu, None));
    let software = gpu.adapter().is_some_and(|a| a.kind == "software");
    for (a, b) in one.iter().zip(&other) {
        let most = a.positions.iter().zip(&b.positions).map(|(p, q)| p.distance(*q)).fold(0.0, f32::max);
        assert!(if software { most == 0.0 } else { most < 1e-3 }, "{most} m apart");
        assert_eq!(a.events, b.events);
    }
    assert!(one[0].events.repaired >= 12, "{:?}", one[0].events);
}

/// A cloth with a past: it hung at rest and then somewhere else for a while, stepped by the processor.
fn hung(garment: &Garment, root: &[Affine3A; BONES], wind: bool) -> Cloth {
    let (colliders, settings) = (no_body(), Settings::default());
    let cloth = Cloth::new(garment, &colliders);
    let mut cloth = if wind { cloth.in_wind(garment) } else { cloth };
    for palette in [&REST, root, root] {
        cloth.step(garment, &around(palette, &colliders, &settings));
    }
    cloth
}

/// Steps `cloth` and `other` on both; the places and events are the same, to the bit where nothing is fused.
fn same(cloth: &mut Cloth, other: &mut Cloth, gpu: &mut ClothStepper, garment: &Garment, step: &Step<'_>) {
    let software = gpu.adapter().is_some_and(|a| a.kind == "software");
    let one = std::slice::from_mut(cloth);
    let mut batch = ClothBatch { cloths: one, garments: &[garment], steps: &[*step] };
    ClothStepper::cpu().step(&mut batch, None).expect("no worker panics");
    let mut batch = ClothBatch { cloths: std::slice::from_mut(other), garments: &[garment], steps: &[*step] };
    gpu.step(&mut batch, None).expect("no worker panics");
    let most = cloth.positions.iter().zip(&other.positions).map(|(p, q)| p.distance(*q)).fold(0.0, f32::max);
    assert!(if software { most == 0.0 } else { most < 1e-4 }, "{most} m apart");
    assert_eq!(cloth.events, other.events);
}

#[test]
fn a_cloth_goes_on_from_its_past_on_the_device_and_from_there_on_the_processor() {
    let Some(graphics) = graphics() else { return };
    let garment = skirt(12, Stretch::Inextensible);
    // Farther off than a root goes in a step, so that a past that is forgotten is a jump.
    let far = |n: usize| swaying(n).map(|bone| Affine3A::from_translation(Vec3::X * 2.0) * bone);
    let mut cpu = hung(&garment, &far(0), false);
    let mut gpu = cpu.clone();
    let mut stepper = Backends::from(graphics.clone()).stepper();
    let (colliders, settings) = (no_body(), Settings::default());
    for n in 1..8 {
        let palette = far(n);
        if n == 5 {
            graphics.opened().device.lose();
        }
        same(&mut cpu, &mut gpu, &mut stepper, &garment, &around(&palette, &colliders, &settings));
        assert_eq!(gpu.events.teleports, 1, "it jumped there when it was stepped first, and never again");
    }
    assert_eq!(stepper.backend(), Backend::Cpu, "the device was lost");
}

#[test]
fn wind_blows_only_what_was_made_ready_for_it() {
    let Some(graphics) = graphics() else { return };
    let garment = skirt(12, Stretch::Inextensible);
    let air = Wind { velocity: Vec3A::new(4.0, 0.5, -3.0), drag: 0.6, lift: 0.2 };
    let settings = Settings { wind: Some(air), ..Settings::default() };
    for wind in [false, true] {
        let mut cpu = hung(&garment, &swaying(0), wind);
        let mut gpu = cpu.clone();
        let mut stepper = Backends::from(graphics.clone()).stepper();
        for n in 1..5 {
            same(&mut cpu, &mut gpu, &mut stepper, &garment, &around(&swaying(n), &no_body(), &settings));
        }
        assert_eq!(stepper.fallback(), None);
    }
}

#[test]
fn what_is_spoilt_before_the_first_step_goes_back_to_where_it_was() {
    let Some(graphics) = graphics() else { return };
    let garment = skirt(12, Stretch::Inextensible);
    let mut cpu = hung(&garment, &swaying(0), false);
    let at = cpu.positions.len() - 1;
    cpu.disturb(at, Vec3A::NAN, Vec3A::ZERO);
    let mut gpu = cpu.clone();
    let mut stepper = Backends::from(graphics).stepper();
    for n in 1..5 {
        same(&mut cpu, &mut gpu, &mut stepper, &garment, &around(&swaying(n), &no_body(), &Settings::default()));
    }
    assert_eq!((gpu.events.repaired, stepper.fallback()), (1, None));
}

#[test]
fn a_device_that_is_lost_loses_no_garment_and_the_processor_goes_on_within_a_second() {
    let Some(graphics) = graphics() else { return };
    let (garment, settings) = (skirt(14, Stretch::Inextensible), Settings::default());
    let mut cloths = [Cloth::new(&garment, &no_body())];
    let mut stepper = Backends::from(graphics.clone()).stepper();
    for n in 0..4 {
        step(&mut stepper, &mut cloths, &[&garment], n, &settings);
    }
    let before = cloths[0].positions.clone();
    graphics.opened().device.lose();
    let begun = Instant::now();
    step(&mut stepper, &mut cloths, &[&garment], 4, &settings);
    assert!(begun.elapsed() < Duration::from_secs(1), "it took {:?}", begun.elapsed());
    assert_eq!(stepper.backend(), Backend::Cpu);
    assert!(
        stepper.fallback().is_some_and(|why| why.contains("lost") && why.contains("CPU")),
        "{:?}",
        stepper.fallback()
    );
    let way = cloths[0].positions.iter().zip(&before).map(|(a, b)| a.distance(*b)).fold(0.0, f32::max);
    assert!(way > 0.0 && way < 0.02, "it went on from where it was: {way} m");
    assert_eq!(cloths[0].events.rolled_back, 0);
}

#[test]
fn what_is_faster_is_measured_and_steps() {
    let means = Backends::open(Backend::Auto);
    if means.fallback().is_some() && graphics().is_none() {
        return;
    }
    let (garment, settings) = (skirt(10, Stretch::Inextensible), Settings::default());
    let mut cloths = [Cloth::new(&garment, &no_body())];
    let mut stepper = means.stepper();
    step(&mut stepper, &mut cloths, &[&garment], 0, &settings);
    let measured = stepper.measured().expect("both were measured");
    let faster = if measured.cpu_us <= measured.gpu_us { Backend::Cpu } else { Backend::Gpu };
    assert_eq!(stepper.backend(), faster, "{measured:?}");
    assert_eq!(stepper.fallback(), None);
    let mut alone = Cloth::new(&garment, &no_body());
    let (palette, colliders) = (swaying(0), no_body());
    alone.step(&garment, &around(&palette, &colliders, &settings));
    let apart = alone.positions.iter().zip(&cloths[0].positions).map(|(a, b)| a.distance(*b)).fold(0.0, f32::max);
    assert!(apart < 1e-5, "measuring has moved the garment by {apart} m");
}

#[test]
fn the_devices_clock_tells_what_the_stages_took() {
    let Some(graphics) = graphics() else { return };
    let (garment, settings) = (skirt(12, Stretch::Inextensible), Settings { timed: true, ..Settings::default() });
    let mut cloths = [Cloth::new(&garment, &no_body())];
    let mut stepper = Backends::from(graphics.clone()).stepper();
    for n in 0..3 {
        step(&mut stepper, &mut cloths, &[&garment], n, &settings);
    }
    // An adapter without a clock tells nothing.
    let Some(spent) = stepper.spent() else { return };
    let sum: f64 = spent.stages_ns.iter().sum();
    assert!(sum > 0.0 && sum <= 1.001 * spent.whole_ns, "{spent:?}");
    // Bending, weft, fibers and contact all take time.
    assert!([1, 3, 4, 5].iter().all(|&stage| spent.stages_ns[stage] > 0.0), "{spent:?}");
}

#[test]
fn two_threads_on_one_device_lose_no_step() {
    let Some(graphics) = graphics() else { return };
    let means = Backends::from(graphics);
    let (garment, settings) = (skirt(8, Stretch::Inextensible), Settings::default());
    let run = || {
        let mut cloths = [Cloth::new(&garment, &no_body())];
        let mut stepper = means.stepper();
        (0..400).for_each(|n| step(&mut stepper, &mut cloths, &[&garment], n, &settings));
        (stepper.fallback().map(str::to_owned), cloths[0].positions.clone())
    };
    let [one, other] = std::thread::scope(|scope| {
        let threads = [scope.spawn(run), scope.spawn(run)];
        threads.map(|thread| thread.join().expect("no thread panics"))
    });
    assert_eq!((one.0, other.0, means.fallback()), (None, None, None));
    assert_eq!((one.1, means.used()), (other.1, "gpu"), "the same garment, the same bits");
}

#[test]
fn another_garment_of_as_many_particles_is_laid_out_anew() {
    let Some(graphics) = graphics() else { return };
    let (one, other) = (skirt(10, Stretch::Physical), skirt(10, Stretch::Inextensible));
    let (settings, mut stepper) = (Settings::default(), Backends::from(graphics).stepper());
    let start = [Cloth::new(&one, &no_body())];
    let [mut on_cpu, mut on_gpu] = [start.clone(), start];
    for n in 0..8 {
        let garment = if n < 4 { &one } else { &other };
        if n == 4 {
            on_cpu = [Cloth::new(garment, &no_body())];
            on_gpu = on_cpu.clone();
        }
        step(&mut ClothStepper::cpu(), &mut on_cpu, &[garment], n, &settings);
        step(&mut stepper, &mut on_gpu, &[garment], n, &settings);
    }
    assert_eq!(stepper.fallback(), None);
    let most = on_cpu[0].positions.iter().zip(&on_gpu[0].positions).map(|(p, q)| p.distance(*q)).fold(0.0, f32::max);
    assert!(most < 1e-4, "{most} m apart");
}
