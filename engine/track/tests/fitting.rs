//! The body fit compared with truth: known bodies before a synthetic camera, and recordings of a real one.

use glam::{Affine3A, Quat, Vec3};
use toile_assets::body::shape::Shapes;
use toile_assets::body::{En, Wanted};
use toile_assets::sizes::Population;
use toile_base::body::Sex;
use toile_base::frame::{DepthFrame, Intrinsics};
use toile_base::skeleton::Joint;
use toile_sensors::source::synthetic::SyntheticCamera;
use toile_sensors::source::{OpenOptions, open};
use toile_track::fit::measuring::{self, MEASURES};
use toile_track::fit::tracker::track;
use toile_track::fit::{BodyFit, FitOptions};
use toile_track::point_cloud::PersonFinder;

use crate::recordings;

/// A camera with half the pixels of an Azure Kinect each way, 2.3 m off and 1 m high.
fn camera() -> SyntheticCamera {
    let intrinsics = Intrinsics { width: 320, height: 288, fx: 252.0, fy: 252.0, cx: 159.5, cy: 143.5 };
    SyntheticCamera::looking_at(intrinsics, Vec3::new(0.0, 1.0, 2.3), Vec3::new(0.0, 1.0, 0.0))
}

/// A body in its rest pose (arms half raised), turned and moved, as the camera sees it.
fn seen(sex: Sex, wanted: &Wanted<En>, place: Affine3A) -> (DepthFrame, Truth) {
    seen_before(&[], sex, wanted, place)
}

/// The same before walls (m): corners of triangles.
fn seen_before(walls: &[[Vec3; 3]], sex: Sex, wanted: &Wanted<En>, place: Affine3A) -> (DepthFrame, Truth) {
    let shapes = Shapes::of(sex);
    let shape = shapes.wanted(wanted).expect("a body");
    let fitted = shapes.body(&shape);
    let mut positions: Vec<Vec3> = fitted.body.mesh.positions.iter().map(|p| place.transform_point3(*p)).collect();
    let mut triangles = fitted.body.mesh.triangles.to_vec();
    for wall in walls {
        triangles.push([0, 1, 2].map(|k| positions.len() as u32 + k));
        positions.extend(wall);
    }
    let camera = camera();
    let mut image = vec![0.0; camera.intrinsics.pixels()];
    camera.render(&positions, &triangles, &mut image);
    let mm = |z: &f32| if z.is_finite() { (z * 1e3).round() as u16 } else { 0 };
    let joints = Joint::ALL.map(|j| place.transform_point3(fitted.body.skeleton.at(j)));
    let measures = MEASURES.map(|t| t.1.of(&fitted.readings));
    (camera.frame(0, image.iter().map(mm).collect()), Truth { joints, measures })
}

/// What is true of the person in the picture.
struct Truth {
    joints: [Vec3; toile_base::skeleton::JOINTS],
    measures: [f32; MEASURES.len()],
}

fn turned(by: f32, to: Vec3) -> Affine3A {
    Affine3A::from_rotation_translation(Quat::from_rotation_y(by), to)
}

const BARE: FitOptions = FitOptions { clothed: false, ..FitOptions::LIVE };

#[test]
fn joints_come_from_depth_alone() {
    let (frame, truth) = seen(Sex::Male, &Wanted::new().with(En::Stature, 1.80), turned(0.2, Vec3::new(0.1, 0.0, 0.0)));
    let mut fit = BodyFit::new(Sex::Male, BARE);
    let mut found = fit.push(&frame);
    assert!(found.found && found.started, "{found:?}");
    for _ in 0..3 {
        found = fit.push(&frame);
    }
    assert!(!found.started && found.explained > 0.95, "{} {}", found.explained, found.off);
    for joint in [
        Joint::Pelvis,
        Joint::Chest,
        Joint::Neck,
        Joint::Head,
        Joint::LeftShoulder,
        Joint::RightShoulder,
        Joint::LeftElbow,
        Joint::RightElbow,
        Joint::LeftWrist,
        Joint::RightWrist,
        Joint::LeftKnee,
        Joint::RightKnee,
        Joint::LeftAnkle,
        Joint::RightAnkle,
    ] {
        let off = found.joints.at(joint).position.distance(truth.joints[joint.index()]);
        assert!(off < 0.04, "{joint:?} is {off} m off");
        assert!(found.joints.at(joint).is_believed(), "{joint:?}");
    }
}

#[test]
fn a_shopper_who_leaves_is_lost_and_found_again_elsewhere() {
    let wanted = Wanted::new();
    let (here, _) = seen(Sex::Female, &wanted, turned(0.0, Vec3::new(-0.3, 0.0, 0.0)));
    let (there, truth) = seen(Sex::Female, &wanted, turned(-0.2, Vec3::new(0.5, 0.0, -0.4)));
    let nothing = DepthFrame { depth_mm: vec![0; here.depth_mm.len()].into_boxed_slice(), ..here.clone() };
    let mut fit = BodyFit::new(Sex::Female, BARE);
    assert!(fit.push(&here).found);
    for _ in 0..6 {
        let gone = fit.push(&nothing);
        assert!(!gone.found && gone.joints.joints.iter().all(|j| !j.is_believed()));
    }
    let again = fit.push(&there);
    assert!(again.found && again.started, "{again:?}");
    assert!(again.joints.at(Joint::Pelvis).position.distance(truth.joints[0]) < 0.05);
}

/// Floor and the wall behind.
fn room() -> [[Vec3; 3]; 4] {
    let at = |x: f32, y: f32, z: f32| Vec3::new(x, y, z);
    let (side, high, behind, ahead) = (4.0, 3.0, -1.2, 3.0);
    [
        [at(-side, 0.0, ahead), at(side, 0.0, ahead), at(-side, 0.0, behind)],
        [at(side, 0.0, ahead), at(-side, 0.0, behind), at(side, 0.0, behind)],
        [at(-side, 0.0, behind), at(side, 0.0, behind), at(-side, high, behind)],
        [at(side, 0.0, behind), at(-side, high, behind), at(side, high, behind)],
    ]
}

#[test]
fn a_person_is_tracked_before_a_visible_room() {
    let room = room();
    let step = |i: usize| turned(0.02 * i as f32, Vec3::new(-0.1 + 0.03 * i as f32, 0.0, 0.02 * i as f32));
    let frames: Vec<(DepthFrame, Truth)> =
        (0..6).map(|i| seen_before(&room, Sex::Female, &Wanted::new(), step(i))).collect();
    let mut frames: Vec<(DepthFrame, Truth)> = frames
        .into_iter()
        .enumerate()
        .map(|(i, (frame, truth))| (DepthFrame { time_ns: i as u64 * 33_333_333, ..frame }, truth))
        .collect();
    // In the last frame no person is in view: nothing is made up.
    let (last, _) = seen_before(&room, Sex::Female, &Wanted::new(), turned(0.0, Vec3::new(40.0, 0.0, 0.0)));
    let only: Vec<DepthFrame> =
        frames.iter().map(|f| f.0.clone()).chain([DepthFrame { time_ns: 2_000_000_000, ..last }]).collect();
    let joints = track(&only, Sex::Female, BARE);
    assert_eq!(joints.len(), 7);
    for (found, (frame, truth)) in joints.iter().zip(frames.drain(..)) {
        assert_eq!(found.time_ns, frame.time_ns);
        for joint in [Joint::Pelvis, Joint::Head, Joint::LeftElbow, Joint::RightWrist, Joint::LeftKnee] {
            let off = found.at(joint).position.distance(truth.joints[joint.index()]);
            assert!(off < 0.05 && found.at(joint).is_believed(), "{joint:?} is {off} m off at {}", frame.time_ns);
        }
    }
    assert!(joints[6].joints.iter().all(|j| !j.is_believed()));
}

#[test]
fn a_bare_body_taken_for_clothed_hardly_shrinks() {
    let (frame, truth) = seen(Sex::Male, &Wanted::new().with(En::Stature, 1.82), turned(0.1, Vec3::ZERO));
    let found = measuring::measure(&[frame.clone(), frame], Population::Men, FitOptions::MEASURING).expect("a fit");
    let stature = found.named("stature").expect("taken");
    assert!((stature.value - truth.measures[0]).abs() < 0.015, "{stature:?} {}", truth.measures[0]);
}

#[test]
fn a_body_of_the_family_is_measured_and_twice_alike() {
    let wanted = Wanted::new().with(En::Stature, 1.72).with(En::WaistGirth, 0.86);
    let (frame, truth) = seen(Sex::Female, &wanted, turned(0.05, Vec3::ZERO));
    let options = FitOptions { clothed: false, ..FitOptions::MEASURING };
    let frames = vec![frame; 3];
    let first = measuring::measure(&frames, Population::Women, options).expect("a fit");
    for ((name, ..), (estimate, truth)) in MEASURES.iter().zip(first.measures.iter().zip(truth.measures)) {
        // Half of the picture's pixels, one pose, no noise: what is left is what the back may be.
        assert!((estimate.value - truth).abs() < 0.02, "{name}: {estimate:?} against {truth}");
        assert!((0.001..0.06).contains(&estimate.sigma), "{name}: {estimate:?}");
    }
    let second = measuring::measure(&frames, Population::Women, options).expect("a fit");
    let bits = |m: &measuring::FittedMeasures| m.measures.map(|e| [e.value.to_bits(), e.sigma.to_bits()]);
    assert_eq!(bits(&first), bits(&second));
}

/// Frames of a person who stands for a moment and then turns so far (rad), fifteen frames a second.
fn turning(by: f32) -> (Vec<DepthFrame>, Truth) {
    let wanted = Wanted::new().with(En::Stature, 1.70).with(En::WaistGirth, 0.86);
    let (front, truth) = seen(Sex::Female, &wanted, turned(0.0, Vec3::ZERO));
    let at = |frame: DepthFrame, i: u64| DepthFrame { time_ns: i * 66_000_000, ..frame };
    let still = (0..4).map(|i| at(front.clone(), i));
    let steps = 60;
    let turn = (0..steps).map(|i| {
        let way = by * (i + 1) as f32 / steps as f32;
        at(seen(Sex::Female, &wanted, turned(way, Vec3::ZERO)).0, 16 + i)
    });
    (still.chain(turn).collect(), truth)
}

#[test]
fn who_turns_all_round_is_measured_from_all_sides_and_who_does_not_from_the_front() {
    let bare = FitOptions { clothed: false, ..FitOptions::MEASURING };
    let (frames, truth) = turning(std::f32::consts::TAU);
    let whole = measuring::measure(&frames, Population::Women, bare).expect("a fit");
    assert!(whole.turned && whole.frames > 50, "{}", whole.frames);
    for name in ["chest_girth", "underbust_girth", "waist_girth", "hip_girth", "stature"] {
        let i = MEASURES.iter().position(|m| m.0 == name).expect("a measure");
        let off = whole.measures[i].value - truth.measures[i];
        assert!(off.abs() < 0.022, "{name} is {off} m off after a turn");
    }
    let (frames, _) = turning(1.2);
    let half = measuring::measure(&frames, Population::Women, bare).expect("a fit");
    let front = measuring::measure(&frames[..4], Population::Women, bare).expect("a fit");
    assert!(!half.turned);
    assert_eq!(half.measures, front.measures, "what is no turn changes nothing");
}

#[test]
fn hostile_pictures_show_no_person_and_no_panic() {
    let (frame, _) = seen(Sex::Male, &Wanted::new(), turned(0.0, Vec3::ZERO));
    let n = frame.depth_mm.len();
    let mut noise = toile_base::numeric::random::SplitMix64::new(3);
    let pictures: [Box<[u16]>; 4] = [
        vec![0; n].into_boxed_slice(),
        vec![u16::MAX; n].into_boxed_slice(),
        vec![1; n].into_boxed_slice(),
        (0..n).map(|_| noise.next_u64() as u16).collect(),
    ];
    let mut fit = BodyFit::new(Sex::Male, BARE);
    for depth_mm in pictures {
        let seen = fit.push(&DepthFrame { depth_mm, ..frame.clone() });
        assert!(seen.joints.is_valid() && seen.off.is_finite());
    }
    assert!(fit.shape().iter().all(|s| s.is_finite()));
}

#[test]
fn a_whole_clothed_woman_is_fitted() {
    let Some(root) = recordings::folder() else { return };
    let folder = root.join("depth/depthkit-chae/derived");
    let options = OpenOptions { camera: Some(folder.join("chae_depth_camera.json")) };
    let session = open(&folder.join("chae_depth_mm_1024x512.u16le"), &options).unwrap();
    let frame = &session.depth[0];
    let alone = PersonFinder::default().push(frame).alone.expect("a person");
    let fitted = measuring::measure(&[alone], Population::Mixed, FitOptions::MEASURING).expect("a fit");
    assert!(fitted.explained > 0.9, "{}", fitted.explained);
    let stature = fitted.measures[0];
    // 1.750 m between the 0.2 and 99.8 percentiles, 1.782 m from end to end.
    assert!((1.73..1.80).contains(&stature.value), "{stature:?}");
}
