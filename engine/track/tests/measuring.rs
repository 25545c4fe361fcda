//! Measuring by joints and depth: refusals, and recordings of real sensors.

use glam::{Affine3A, Mat3, Vec3};
use toile_assets::sizes::Population;
use toile_base::body::{Body, Measures as BodyMeasures, Sex};
use toile_base::frame::{DepthFrame, Intrinsics, Joints, TrackedJoint};
use toile_base::skeleton::Joint;
use toile_sensors::source::synthetic::SyntheticCamera;
use toile_sensors::source::{OpenOptions, open};
use toile_track::fit::measuring::FRAMES;
use toile_track::measure::{MeasureError, Measurements, Source, measure};
use toile_track::measures::Hint;

use crate::recordings;

/// A rest pose as frames of joints, all believed, with a wobble of a centimetre that averages out.
fn joints_of(body: &Body) -> Vec<Joints> {
    let wobble = |i: usize, k: usize| 0.01 * ((i * 7 + k * 3) as f32).sin();
    (0..FRAMES)
        .map(|i| {
            let off = |k| Vec3::new(wobble(i, k), wobble(i + 5, k), wobble(i + 9, k));
            Joints::seen(i as u64 * 33_333_333, std::array::from_fn(|k| body.skeleton.rest[k] + off(k)))
        })
        .collect()
}

#[test]
fn joints_alone_give_stature_and_shoulders_within_their_sigma_and_girths_as_guesses() {
    for sex in [Sex::Female, Sex::Male] {
        let body = toile_assets::body::build(sex, &BodyMeasures::average(sex)).unwrap();
        let m = measure(&joints_of(&body), &[], &Hint::default()).unwrap();
        assert_eq!((m.source, m.people, m.valid_pixels), (Source::Joints, 1, 0));
        let b = &body.measures;
        let truth = [b.stature, b.shoulder_breadth, b.chest_girth, b.waist_girth, b.hip_girth];
        for ((name, estimate), truth) in m.measures.named().into_iter().zip(truth) {
            let e = estimate.unwrap();
            assert!((e.value - truth).abs() < 1.5 * e.sigma, "{sex:?} {name}: {e:?} against {truth}");
        }
        assert!(m.measures.chest_girth.unwrap().sigma > 0.07, "a guess says that it is one");
    }
}

#[test]
fn without_a_unit_the_stature_is_assumed_and_says_so() {
    let body = toile_assets::body::build(Sex::Female, &BodyMeasures::average(Sex::Female)).unwrap();
    let mut joints = joints_of(&body);
    for j in joints.iter_mut().flat_map(|f| &mut f.joints) {
        j.position *= 39.37;
    }
    let hint = Hint { population: Population::Women, scale_known: false };
    let m = measure(&joints, &[], &hint).unwrap();
    let (stature, shoulder) = (m.measures.stature.unwrap(), m.measures.shoulder_breadth.unwrap());
    assert!((stature.value - 1.628).abs() < 1e-3 && stature.sigma > 0.06, "{stature:?}");
    assert!((shoulder.value - 0.365).abs() < 2.0 * shoulder.sigma && shoulder.value < 0.5, "{shoulder:?}");
    assert!(m.notes.iter().any(|n| n.contains("assumed")), "{:?}", m.notes);
}

#[test]
fn implausible_joints_are_refused_in_one_sentence() {
    let absent = Joints::absent(0);
    let mut nan = absent;
    nan.joints[Joint::Pelvis.index()] = TrackedJoint { position: Vec3::NAN, confidence: 1.0 };
    for frames in [vec![absent; 40], vec![nan; 40]] {
        let why = measure(&frames, &[], &Hint::default()).unwrap_err();
        assert_eq!(why, MeasureError::TooFewFrames { got: 0, frames: 40, need: 3 });
        assert!(why.to_string().ends_with('.'));
    }
    assert_eq!(measure(&[], &[], &Hint::default()).unwrap_err(), MeasureError::Empty);
}

/// A Kinect's frame, level and 1.2 m above the floor, from a depth for each pixel (m; 0 = nothing).
fn frame(depth: impl Fn(f32, f32) -> f32) -> DepthFrame {
    let k = Intrinsics::KINECT_V1;
    let level = Mat3::from_cols(Vec3::X, Vec3::NEG_Y, Vec3::NEG_Z);
    let pixel = |i: usize| {
        let (u, v) = ((i % k.width as usize) as f32, (i / k.width as usize) as f32);
        (depth((u - k.cx) / k.fx, (v - k.cy) / k.fy) * 1000.0) as u16
    };
    DepthFrame {
        time_ns: 0,
        intrinsics: k,
        camera_to_world: Affine3A::from_mat3_translation(level, Vec3::new(0.0, 1.2, 2.5)),
        depth_mm: (0..k.width as usize * k.height as usize).map(pixel).collect(),
    }
}

#[test]
fn an_empty_room_and_a_cupboard_are_rejected() {
    let nothing = frame(|_, _| 0.0);
    let room = frame(|_, y| if y > 0.0 { (1.2 / y).min(4.0) } else { 4.0 });
    let cupboard = frame(|x, y| if x.abs() < 0.2 && y > -0.3 { 2.5 } else { 4.0 });
    for seen in [nothing, room, cupboard] {
        let why = measure(&[], &[seen], &Hint::default()).unwrap_err();
        assert_eq!(why, MeasureError::NoPerson { frames: 1 });
    }
}

#[test]
fn who_stands_too_far_is_told_to_come_closer() {
    let body = toile_assets::body::build(Sex::Male, &BodyMeasures::average(Sex::Male)).unwrap();
    let camera = SyntheticCamera::looking_at(Intrinsics::KINECT_V1, Vec3::new(0.0, 1.2, 5.5), Vec3::new(0.0, 1.2, 0.0));
    let mut image = vec![0.0; camera.intrinsics.pixels()];
    camera.render(&body.mesh.positions, &body.mesh.triangles, &mut image);
    let mm = |z: &f32| if z.is_finite() { (z * 1000.0) as u16 } else { 0 };
    let seen = camera.frame(0, image.iter().map(mm).collect());
    let why = measure(&[], &[seen], &Hint::default()).unwrap_err();
    assert!(matches!(why, MeasureError::TooFar { distance, .. } if (5.2..5.6).contains(&distance)), "{why}");
    assert!(why.to_string().contains("come closer"), "{why}");
}

fn measured(file: &str, camera: Option<&str>) -> Option<Result<Measurements, MeasureError>> {
    let root = recordings::folder()?;
    let options = OpenOptions { camera: camera.map(|c| root.join(c)) };
    let session = open(&root.join(file), &options).unwrap();
    Some(measure(&session.joints, &session.depth, &Hint { scale_known: session.raw_scale_known, ..Hint::default() }))
}

#[test]
fn a_whole_woman_with_shoes_and_hair_is_as_tall_as_her_picture() {
    let folder = "depth/depthkit-chae/derived";
    let image = format!("{folder}/chae_depth_mm_1024x512.u16le");
    let Some(result) = measured(&image, Some(&format!("{folder}/chae_depth_camera.json"))) else { return };
    let m = result.unwrap();
    assert_eq!(m.people, 1);
    assert!(m.valid_pixels.abs_diff(165_326) < 1_000, "{}", m.valid_pixels);
    let stature = m.measures.stature.unwrap();
    // 1.750 m between the 0.2 and 99.8 percentiles, 1.782 m from end to end.
    assert!((1.74..1.80).contains(&stature.value), "{stature:?}");
    // A slim woman in tight clothes; she was not measured by hand, so the bounds are those of slim women of her stature.
    for (name, estimate, range) in [
        ("chest", m.measures.chest_girth, 0.75..1.05),
        ("waist", m.measures.waist_girth, 0.60..0.95),
        ("hip", m.measures.hip_girth, 0.82..1.08),
    ] {
        assert!(range.contains(&estimate.unwrap().value), "{name}: {estimate:?}");
    }
}

#[test]
fn people_seen_from_the_waist_up_have_a_chest_but_no_stature() {
    // Frames of one man in a wide shirt; in the last one a person stands behind him.
    let frames = [1028894671u64, 1038901490, 1045879925, 1051883281, 1058893191, 1064898470, 1078881076, 1399145206];
    let mut chests = 0;
    for number in frames {
        let Some(result) = measured(&format!("depth/skeltrack/depth-data-{number}.u16le"), None) else { return };
        let m = result.unwrap();
        assert_eq!(m.people, if number == 1399145206 { 2 } else { 1 }, "{number}");
        assert_eq!(m.measures.stature, None, "{number}");
        assert!(m.notes.iter().any(|n| n.contains("feet")), "{number}: {:?}", m.notes);
        if let Some(chest) = m.measures.chest_girth {
            // One frame of a wide shirt: what is plausible for the man has to lie within what is stated.
            let [least, most] = [chest.value - chest.sigma, chest.value + chest.sigma];
            assert!(least < 1.45 && most > 0.85 && chest.sigma < 0.08, "{number}: {chest:?}");
            chests += 1;
        }
    }
    assert!(chests >= 6, "{chests} of 8");
}

#[test]
fn a_mug_is_no_person() {
    let Some(root) = recordings::folder() else { return };
    let bytes = std::fs::read(root.join("depth/pyk4a-azure-mkv/recording.mkv")).unwrap();
    // The one frame of the depth track: a Matroska block of track 2 with 640 x 576 big-endian pixels.
    let size = 640 * 576 * 2;
    let at =
        (4..bytes.len() - size).find(|&i| bytes[i] == 0x82 && vint_before(&bytes, i) == Some(size as u64 + 4)).unwrap();
    let depth_mm = bytes[at + 4..at + 4 + size].chunks_exact(2).map(|b| u16::from_be_bytes([b[0], b[1]])).collect();
    // Calibration.json over 1024 x 1024 px, cut to the middle.
    let intrinsics = Intrinsics { width: 640, height: 576, fx: 504.6, fy: 504.7, cx: 333.3, cy: 349.3 };
    let seen = DepthFrame { intrinsics, depth_mm, ..frame(|_, _| 0.0) };
    let valid = seen.depth_mm.iter().filter(|&&mm| mm > 0).count();
    assert!(valid > 100_000, "{valid} valid pixels");
    assert_eq!(measure(&[], &[seen], &Hint::default()).unwrap_err(), MeasureError::NoPerson { frames: 1 });
}

/// The EBML number that ends before a byte, if one does in 3 to 8 bytes.
fn vint_before(bytes: &[u8], end: usize) -> Option<u64> {
    (3..=8.min(end)).find_map(|n| {
        let first = bytes[end - n];
        let value =
            bytes[end - n + 1..end].iter().fold(u64::from(first) & ((1 << (8 - n)) - 1), |v, &b| v << 8 | u64::from(b));
        (first.leading_zeros() as usize + 1 == n && value > 1000).then_some(value)
    })
}

#[test]
fn a_recorded_skeleton_gives_a_plausible_person() {
    let files = [
        "labanotation-kinect2/Ges01_wavehand.csv",
        "labanotation-kinect2/joints.csv",
        "kinectron-kinect2/recorded_skeleton.json",
    ];
    for file in files {
        let Some(result) = measured(&format!("skeleton/{file}"), None) else { return };
        let m = result.unwrap();
        let stature = m.measures.stature.unwrap();
        assert!((1.5..2.0).contains(&stature.value) && (0.02..0.10).contains(&stature.sigma), "{file}: {stature:?}");
        assert_eq!(m.source, Source::Joints);
    }
}
