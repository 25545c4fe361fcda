//! Measuring by depth: what is refused, and what real sensors recorded.

use glam::{Affine3A, Mat3, Vec3};
use toile_base::body::{Measures as BodyMeasures, Sex};
use toile_base::frame::{DepthFrame, Intrinsics, Joints};
use toile_fitting::dress::measured::{MeasuredSubject, ShopperFacts, measure};
use toile_fitting::dress::session;
use toile_sensors::source::synthetic::SyntheticCamera;
use toile_sensors::source::{OpenOptions, Session, open};
use toile_track::measure::{MeasureError, Source};

use crate::recordings;

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
fn empty_rooms_and_cupboards_are_refused() {
    let nothing = frame(|_, _| 0.0);
    let room = frame(|_, y| if y > 0.0 { (1.2 / y).min(4.0) } else { 4.0 });
    let cupboard = frame(|x, y| if x.abs() < 0.2 && y > -0.3 { 2.5 } else { 4.0 });
    for seen in [nothing, room, cupboard] {
        assert_eq!(refusal(seen), MeasureError::NoPerson { frames: 1 }.to_string());
    }
}

#[test]
fn joints_measure_where_no_body_fits_the_depth() {
    let body = toile_assets::body::build(Sex::Female, &BodyMeasures::average(Sex::Female)).unwrap();
    let second = |i: u64| Joints::seen(i * 33_333_333, body.skeleton.rest);
    let nothing = frame(|_, _| 0.0);
    let both = Session { depth: vec![nothing.clone()], ..session::of_joints((0..30).map(second).collect()) };
    let found = measure(&both, ShopperFacts::default()).unwrap();
    assert!(found.fitted.is_none());
    assert_eq!((found.best.source, found.best.people, found.best.valid_pixels), (Source::Joints, 1, 0));
    let seated = ShopperFacts { seated: true, ..ShopperFacts::default() };
    let found = measure(&both, seated).unwrap().best;
    assert!(found.measures.stature.is_some() && found.measures.hip_girth.is_none(), "a chair hides the hips");
    let why = measure(&session::of_depth(vec![nothing]), seated).unwrap_err().to_string();
    assert!(why.contains("record joints, or stand"), "{why}");
}

#[test]
fn a_distant_person_is_told_to_come_closer() {
    let body = toile_assets::body::build(Sex::Male, &BodyMeasures::average(Sex::Male)).unwrap();
    let camera = SyntheticCamera::looking_at(Intrinsics::KINECT_V1, Vec3::new(0.0, 1.2, 5.5), Vec3::new(0.0, 1.2, 0.0));
    let mut image = vec![0.0; camera.intrinsics.pixels()];
    camera.render(&body.mesh.positions, &body.mesh.triangles, &mut image);
    let mm = |z: &f32| if z.is_finite() { (z * 1000.0) as u16 } else { 0 };
    let seen = camera.frame(0, image.iter().map(mm).collect());
    let why = refusal(seen);
    assert!(why.starts_with("the person stands 5.") && why.contains("come closer"), "{why}");
}

fn refusal(seen: DepthFrame) -> String {
    measure(&session::of_depth(vec![seen]), ShopperFacts::default()).unwrap_err().to_string()
}

fn measured(file: &str, camera: Option<&str>) -> Option<MeasuredSubject> {
    let root = recordings::folder()?;
    let options = OpenOptions { camera: camera.map(|c| root.join(c)) };
    Some(measure(&open(&root.join(file), &options).unwrap(), ShopperFacts::default()).unwrap())
}

#[test]
fn a_whole_woman_with_shoes_and_hair_is_as_tall_as_her_picture() {
    let folder = "depth/depthkit-chae/derived";
    let image = format!("{folder}/chae_depth_mm_1024x512.u16le");
    let camera = format!("{folder}/chae_depth_camera.json");
    let Some(m) = measured(&image, Some(&camera)) else { return };
    let m = m.best;
    assert_eq!(m.people, 1);
    assert!(m.valid_pixels.abs_diff(165_326) < 1_000, "{}", m.valid_pixels);
    let stature = m.measures.stature.unwrap();
    // 1.750 m between the 0.2 and 99.8 percentiles, 1.782 m from end to end; shoes count as leg.
    assert!((1.74..1.82).contains(&stature.value), "{stature:?}");
    // A slim woman, whom no tape measured: the bounds are those of slim women of her stature.
    for (name, estimate, range) in [
        ("chest", m.measures.chest_girth, 0.75..1.05),
        ("waist", m.measures.waist_girth, 0.60..0.95),
        ("hip", m.measures.hip_girth, 0.82..1.12),
    ] {
        assert!(range.contains(&estimate.unwrap().value), "{name}: {estimate:?}");
    }
}

#[test]
fn people_seen_from_the_waist_up_have_an_unsure_stature() {
    // Frames of one man in a wide shirt; in the last one another person stands behind him.
    let frames = [1028894671u64, 1038901490, 1045879925, 1051883281, 1058893191, 1064898470, 1078881076, 1399145206];
    let mut chests = 0;
    for number in frames {
        let file = format!("depth/skeltrack/depth-data-{number}.u16le");
        let Some(m) = measured(&file, None) else { return };
        let m = m.best;
        assert_eq!(m.people, if number == 1399145206 { 2 } else { 1 }, "{number}");
        let stature = m.measures.stature.unwrap();
        assert!((1.5..1.9).contains(&stature.value) && stature.sigma > 0.025, "{number}: {stature:?}");
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
fn a_mug_is_refused() {
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
    assert_eq!(refusal(seen), MeasureError::NoPerson { frames: 1 }.to_string());
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
