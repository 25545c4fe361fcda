//! Skinning against the CPU's: the bodies in poses, several at once, bones that are no numbers, results that are late.

use std::f32::consts::PI;

use glam::{Affine3A, Quat, Vec3};
use toile_assets::scene::shopper;
use toile_base::body::{Measures, Sex};
use toile_base::mesh::WideWeights;
use toile_base::skeleton::{BONES, Joint, Pose, Skeleton};
use toile_engine::body::palette;
use toile_engine::skin::{Blend, SkinningJob};
use toile_gpu::device::{AdapterChoice, Device, GpuError};
use toile_gpu::skin::{Skinning, needs};

use super::scene::{REST, opened};

/// What a blend may be off by on a device that fuses products and sums and rounds quotients to 2.5 units of the last place
/// (m, and of a unit normal): within 3 m of the origin a place is a dozen sums, each rounded to 1.2e-7 of up to 4 m.
const BOUND: f32 = 4e-6;

type Palette = [Affine3A; BONES];

fn body(sex: Sex) -> (Skeleton, SkinningJob) {
    let body = toile_assets::body::build(sex, &Measures::average(sex)).expect("it can be built");
    let job = SkinningJob::new(&body.mesh.positions, &body.normals, &body.weights).expect("a body of ours");
    (body.skeleton, job)
}

/// A surface of which some vertices follow eight bones.
fn wide() -> SkinningJob {
    let wave = |v: usize, k: f32| (v as f32 * k + k).sin();
    let points: Vec<Vec3> = (0..700).map(|v| Vec3::new(wave(v, 1.3), 1.0 + wave(v, 2.1), wave(v, 0.7))).collect();
    let weights: Vec<WideWeights> = (0..700)
        .map(|v| {
            let count = 1 + v % 8;
            let weight = |k: usize| if k < count { (1 + k) as f32 / (count * (count + 1) / 2) as f32 } else { 0.0 };
            WideWeights {
                bones: std::array::from_fn(|k| (v / 100 + 4 * k) as u8),
                weights: std::array::from_fn(weight),
            }
        })
        .collect();
    SkinningJob::new(&points, &points, &weights).expect("it is a skin")
}

fn of(skeleton: &Skeleton, pose: &Pose) -> Palette {
    let mut bones = REST;
    palette(skeleton, pose, &mut bones);
    bones
}

/// Rest, two moments of a walk, and arms that are bent and twisted by 120 degrees.
fn poses(skeleton: &Skeleton) -> Vec<(&'static str, Palette)> {
    let mut bent = Pose::rest(skeleton);
    for side in [Joint::LeftElbow, Joint::LeftWrist, Joint::LeftShoulder] {
        let axis = if side == Joint::LeftWrist { Vec3::X } else { Vec3::Y };
        let turn = Quat::from_axis_angle(axis, 2.0 * PI / 3.0);
        bent.local[side.index()] = turn;
        bent.local[side.mirror().index()] = turn.inverse();
    }
    let walk = |time: f32| of(skeleton, &shopper(skeleton, time));
    vec![
        ("rest", of(skeleton, &Pose::rest(skeleton))),
        ("walking", walk(4.1)),
        ("walking on", walk(4.7)),
        ("arms 120 degrees", of(skeleton, &bent)),
    ]
}

/// A device for skins, and the skins on it.
fn skinning(jobs: &[&SkinningJob]) -> Option<(Device, Skinning)> {
    let device = opened(Device::open(&AdapterChoice::Fastest, needs(jobs)))?;
    let skinning = Skinning::new(&device, jobs).expect("the device was opened for it");
    Some((device, skinning))
}

/// Holds a body on the device against the CPU's; a software adapter, which fuses nothing, to the bit.
fn held(
    name: &str,
    (device, gpu): &(Device, Skinning),
    number: usize,
    job: &SkinningJob,
    blend: Blend,
    bones: &Palette,
) {
    let mut posed = job.posed();
    job.run(blend, bones, &mut posed);
    let (mut same, mut most) = (0, [0.0f32; 2]);
    for v in 0..job.vertices() {
        let pairs = [(gpu.positions(number)[v], posed.position(v)), (gpu.normals(number)[v], posed.normal(v))];
        for ((got, expected), most) in pairs.into_iter().zip(&mut most) {
            assert_eq!(got.is_finite(), expected.is_finite(), "{name} {blend}, vertex {v}: {got} for {expected}");
            if expected.is_finite() {
                *most = most.max((got - expected).abs().max_element());
            }
            // -0 and 0 are the same place; numbers that are none need not be the same none.
            let alike = |(a, b): (f32, f32)| a == b || a.is_nan() && b.is_nan();
            same += got.to_array().into_iter().zip(expected.to_array()).filter(|p| alike(*p)).count();
        }
    }
    let all = 6 * job.vertices();
    println!("{name} {blend}: {same} of {all} the same, {} m and {} apart", most[0], most[1]);
    assert!(most.iter().all(|m| *m <= BOUND), "{name} {blend}: {most:?} apart");
    assert!(same == all || device.adapter().kind != "software", "{name} {blend}: {same} of {all}, {most:?} apart");
}

#[test]
fn both_blends_agree_with_their_references_everywhere() {
    for sex in [Sex::Female, Sex::Male] {
        let (skeleton, job) = body(sex);
        let Some(mut on) = skinning(&[&job]) else { return };
        for (name, bones) in poses(&skeleton) {
            for blend in Blend::ALL {
                on.1.step(&on.0, blend, &[&bones]).expect("the step is sent");
                on.1.finish(&on.0).expect("it comes back");
                held(&format!("{sex:?} {name}"), &on, 0, &job, blend, &bones);
            }
        }
    }
}

#[test]
fn bodies_of_one_dispatch_do_not_see_each_other() {
    let ((tall, one), (short, other), wide) = (body(Sex::Male), body(Sex::Female), wide());
    let jobs = [&one, &wide, &other];
    let Some(mut on) = skinning(&jobs) else { return };
    let (his, hers) = (poses(&tall), poses(&short));
    for blend in Blend::ALL {
        let bones = [&his[3].1, &hers[2].1, &hers[1].1];
        on.1.step(&on.0, blend, &bones).expect("the step is sent");
        on.1.finish(&on.0).expect("it comes back");
        (0..3).for_each(|k| held(&format!("body {k}"), &on, k, jobs[k], blend, bones[k]));
        // The first alone moves on.
        on.1.step(&on.0, blend, &[&his[1].1]).expect("the step is sent");
        on.1.finish(&on.0).expect("it comes back");
        held("the first", &on, 0, jobs[0], blend, &his[1].1);
        (1..3).for_each(|k| held(&format!("still body {k}"), &on, k, jobs[k], blend, bones[k]));
    }
}

#[test]
fn a_bone_that_is_no_number_spoils_what_it_spoils_on_the_cpu() {
    let (skeleton, job) = body(Sex::Female);
    let Some(mut on) = skinning(&[&job, &job]) else { return };
    let sound = poses(&skeleton)[1].1;
    for (blend, number) in Blend::ALL.into_iter().flat_map(|b| [(b, f32::NAN), (b, f32::INFINITY)]) {
        let mut broken = sound;
        broken[20].matrix3.x_axis.y = number;
        on.1.step(&on.0, blend, &[&broken, &sound]).expect("the step is sent");
        on.1.finish(&on.0).expect("it comes back");
        assert!(on.1.positions(0).iter().any(|p| !p.is_finite()), "no vertex follows the bone");
        held("broken", &on, 0, &job, blend, &broken);
        held("beside it", &on, 1, &job, blend, &sound);
        on.1.step(&on.0, blend, &[&sound, &sound]).expect("the step is sent");
        on.1.finish(&on.0).expect("it comes back");
        held("sound again", &on, 0, &job, blend, &sound);
    }
}

#[test]
fn a_blend_that_cancels_is_as_the_cpu_has_it() {
    let weights = [WideWeights { bones: [0, 1, 0, 0, 0, 0, 0, 0], weights: [0.5, 0.5, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0] }];
    let job = SkinningJob::new(&[Vec3::X], &[Vec3::X], &weights).expect("it is a skin");
    let Some(mut on) = skinning(&[&job]) else { return };
    let mut mirrored = REST;
    mirrored[1].matrix3 = -mirrored[1].matrix3;
    let mut turned = REST;
    (turned[0], turned[1]) = (Affine3A::from_rotation_y(-PI), Affine3A::from_rotation_y(PI));
    for (blend, bones) in [(Blend::Linear, mirrored), (Blend::Dual, turned)] {
        on.1.step(&on.0, blend, &[&bones]).expect("the step is sent");
        on.1.finish(&on.0).expect("it comes back");
        held("cancelled", &on, 0, &job, blend, &bones);
    }
}

#[test]
fn a_skin_comes_back_late_is_dropped_rather_than_waited_for_and_not_sent_unasked() {
    let job = wide();
    let Some((device, mut gpu)) = skinning(&[&job]) else { return };
    for _ in 0..20 {
        gpu.step(&device, Blend::Linear, &[&REST]).expect("the step is sent");
    }
    gpu.finish(&device).expect("the last step comes back");
    let tally = gpu.tally();
    assert!(tally.sent <= 20 && tally.taken >= 1, "{tally:?}");
    // Where the last was dropped, `finish` has fetched it.
    assert!((20..=21).contains(&(tally.taken + tally.dropped)), "{tally:?}");
    let before = gpu.positions(0).to_vec();
    gpu.fetch = false;
    let away = [Affine3A::from_translation(Vec3::X); BONES];
    gpu.step(&device, Blend::Linear, &[&away]).expect("the step is sent");
    gpu.finish(&device).expect("nothing comes back");
    assert_eq!((gpu.tally(), gpu.positions(0)), (tally, &before[..]));
}

#[test]
fn a_skin_is_at_rest_before_the_first_step() {
    let (job, nothing) = (wide(), SkinningJob::new::<4>(&[], &[], &[]).expect("no vertex is no fault"));
    let Some(mut on) = skinning(&[&nothing, &job]) else { return };
    assert_eq!((on.1.bodies(), on.1.span(0), on.1.span(1)), (2, 0..0, 0..700));
    let rest = job.posed();
    assert!((0..700).all(|v| on.1.positions(1)[v] == rest.position(v) && on.1.normals(1)[v] == rest.normal(v)));
    on.1.step(&on.0, Blend::Dual, &[&REST, &REST]).expect("the step is sent");
    on.1.finish(&on.0).expect("it comes back");
    held("beside nothing", &on, 1, &job, Blend::Dual, &REST);
}

#[test]
fn a_device_that_is_too_small_or_lost_is_named_and_the_last_skin_stays() {
    let job = wide();
    let Some((device, mut gpu)) = skinning(&[&job]) else { return };
    gpu.step(&device, Blend::Linear, &[&REST]).expect("the step is sent");
    gpu.finish(&device).expect("it comes back");
    let before = gpu.positions(0).to_vec();
    let large = toile_gpu::device::DeviceNeeds { largest: 1 << 40, workgroups: 1 };
    assert!(matches!(device.takes(large), Err(GpuError::TooSmall { .. })));
    device.lose();
    assert!(matches!(gpu.step(&device, Blend::Linear, &[&REST]), Err(GpuError::Lost(_))));
    assert_eq!(gpu.positions(0), before);
    assert!(matches!(Skinning::new(&device, &[&job]), Err(GpuError::Lost(_))));
}
