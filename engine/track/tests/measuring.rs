//! Measuring by the proportions of joints: what is refused, and what real sensors recorded.

use glam::Vec3;
use toile_assets::sizes::Population;
use toile_base::body::{Body, Measures as BodyMeasures, Sex};
use toile_base::frame::{Joints, TrackedJoint};
use toile_base::skeleton::Joint;
use toile_sensors::source::{OpenOptions, open};
use toile_track::fit::measuring::FRAMES;
use toile_track::measure::{MeasureError, Source, by_proportions};
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
        let m = by_proportions(&joints_of(&body), &Hint::default()).unwrap();
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
    let m = by_proportions(&joints, &hint).unwrap();
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
        let why = by_proportions(&frames, &Hint::default()).unwrap_err();
        assert_eq!(why, MeasureError::TooFewFrames { got: 0, frames: 40, need: 3 });
        assert!(why.to_string().ends_with('.'));
    }
}

#[test]
fn a_recorded_skeleton_gives_a_plausible_person() {
    let files = [
        "labanotation-kinect2/Ges01_wavehand.csv",
        "labanotation-kinect2/joints.csv",
        "kinectron-kinect2/recorded_skeleton.json",
    ];
    for file in files {
        let Some(folder) = recordings::folder() else { return };
        let session = open(&folder.join("skeleton").join(file), &OpenOptions::default()).unwrap();
        let hint = Hint { scale_known: session.raw_scale_known, ..Hint::default() };
        let m = by_proportions(&session.joints, &hint).unwrap();
        let stature = m.measures.stature.unwrap();
        assert!((1.5..2.0).contains(&stature.value) && (0.02..0.10).contains(&stature.sigma), "{file}: {stature:?}");
        assert_eq!(m.source, Source::Joints);
    }
}
