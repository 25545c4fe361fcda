//! Skeleton trackers: each shows the same person standing as we see them, and nothing they send does harm.

use std::fs;
use std::path::PathBuf;

use glam::Vec3;
use proptest::prelude::*;
use toile_base::frame::{Joints, TrackedJoint};
use toile_base::skeleton::{JOINTS, Joint};
use toile_sensors::filter::JointFilter;
use toile_sensors::source::vmc::Decoder;
use toile_sensors::source::{OpenOptions, open, read_bytes};

use crate::common::{samples, skeletons};

#[test]
fn every_tracker_shows_the_same_person() {
    let all = [
        ("kinect20", skeletons::kinect_20(5)),
        ("azure", skeletons::azure(5)),
        ("mediapipe", skeletons::mediapipe(5)),
        ("kinect25", samples::kinect_csv(5)),
    ];
    for (name, bytes) in all {
        let session = read_bytes(name, name, &bytes, None).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!(session.joints.len(), 5, "{name}");
        let (frame, truth) = (&session.joints[1], samples::standing(0));
        for joint in [
            Joint::Head,
            Joint::LeftShoulder,
            Joint::LeftWrist,
            Joint::RightElbow,
            Joint::LeftHip,
            Joint::RightKnee,
            Joint::LeftToe,
        ] {
            let (seen, wanted) = (frame.at(joint), truth.at(joint).position);
            let off = seen.position - wanted;
            assert!(seen.is_believed() && off.length() < 0.06, "{name}: {joint:?} at {} for {wanted}", seen.position);
        }
    }
}

#[test]
fn a_jump_before_a_webcam_is_seen() {
    let session = read_bytes("jump", "jump", &skeletons::mediapipe(6), None).unwrap();
    let rise = session.joints[5].at(Joint::Pelvis).position.y - session.joints[2].at(Joint::Pelvis).position.y;
    assert!((rise - 0.3).abs() < 0.02, "{rise} m");
    assert!(!session.raw_scale_known);
}

#[test]
fn times_that_run_back_are_dropped_and_noted() {
    let text = String::from_utf8(skeletons::azure(4)).unwrap();
    let mut lines: Vec<&str> = text.lines().collect();
    lines.swap(2, 3);
    let session = read_bytes("late", "late", lines.join("\n").as_bytes(), None).unwrap();
    assert_eq!(session.joints.len(), 3);
    assert!(session.notes.iter().any(|n| n.contains("back in time")), "{:?}", session.notes);
}

/// A folder with a calibration and two cameras of two frames, which is removed in the end.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str, calibration: &[u8], keypoints: &[u8]) -> Self {
        let folder = std::env::temp_dir().join(format!("toile-openpose-{name}-{}", std::process::id()));
        let _ = fs::remove_dir_all(&folder);
        for camera in ["a", "b"] {
            fs::create_dir_all(folder.join(camera)).unwrap();
            for i in 0..2 {
                fs::write(folder.join(camera).join(format!("{i}.json")), keypoints).unwrap();
            }
        }
        fs::write(folder.join("rig.toml"), calibration).unwrap();
        Self(folder)
    }

    fn error(&self) -> String {
        open(&self.0, &OpenOptions::default()).unwrap_err().to_string()
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

const CAMERA: &str = "size = [1000.0, 1000.0]\nmatrix = [[1000.0, 0.0, 500.0], [0.0, 1000.0, 500.0], [0.0, 0.0, 1.0]]\n\
                      rotation = [0.0, 0.0, 0.0]\ntranslation = [0.0, 1.0, 3.0]\n";

#[test]
fn wrong_folders_are_refused_in_one_sentence() {
    let rig = format!("[a]\n{CAMERA}[b]\n{CAMERA}");
    let person = format!("{{\"people\":[{{\"pose_keypoints_2d\":[{}]}}]}}", vec!["500,500,0.9"; 25].join(","));
    for (name, calibration, keypoints) in [
        ("none", "", person.as_str()),
        ("one", &format!("[a]\n{CAMERA}"), &person),
        ("three", &format!("{rig}[c]\n{CAMERA}"), &person),
        ("short", &rig, "{\"people\":[{\"pose_keypoints_2d\":[1]}]}"),
        ("binary", &rig, "\u{0}\u{1}"),
        ("empty", &rig, "{\"people\":[]}"),
        // Two cameras at one place see no depth.
        ("same", &rig, &person),
    ] {
        let folder = Folder::new(name, calibration.as_bytes(), keypoints.as_bytes());
        let error = folder.error();
        assert!(error.contains("toile-openpose") && !error.contains('\n') && error.len() < 400, "{name}: {error}");
    }
    let single = read_bytes("one.json", "one", person.as_bytes(), None).unwrap_err().to_string();
    assert!(single.contains("calibration"), "{single}");
}

/// Any number that a tracker may send: mostly a place in a room, at times none at all.
fn number() -> impl Strategy<Value = f32> {
    prop_oneof![
        8 => -3.0_f32..3.0,
        1 => prop_oneof![Just(f32::NAN), Just(f32::INFINITY), Just(f32::NEG_INFINITY), Just(f32::MAX), Just(1e30), Just(0.0)],
    ]
}

fn any_frame() -> impl Strategy<Value = Joints> {
    let confidence = prop_oneof![4 => Just(1.0_f32), 1 => 0.0_f32..1.0];
    let joint = (number(), number(), number(), confidence)
        .prop_map(|(x, y, z, confidence)| TrackedJoint { position: Vec3::new(x, y, z), confidence });
    (prop::collection::vec(joint, JOINTS), 0_u64..400_000_000).prop_map(|(all, time_ns)| {
        let mut joints = Joints::absent(time_ns);
        joints.joints.copy_from_slice(&all);
        joints
    })
}

/// One good datagram: the hips.
fn hips() -> Vec<u8> {
    let mut bytes = b"/VMC/Ext/Bone/Pos\0\0\0,sfffffff\0\0\0Hips\0\0\0\0".to_vec();
    for x in [0.1_f32, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0] {
        bytes.extend(x.to_be_bytes());
    }
    bytes
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 96, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn any_joints_give_valid_ones_and_the_same_twice(frames in prop::collection::vec(any_frame(), 1..24)) {
        let (mut filter, mut again) = (JointFilter::default(), JointFilter::default());
        for frame in &frames {
            let out = filter.push(frame);
            prop_assert_eq!(out.time_ns, frame.time_ns);
            for joint in &out.joints {
                prop_assert!(joint.confidence == 0.0 || joint.position.is_finite(), "{:?}", joint);
            }
            prop_assert_eq!(out, again.push(frame), "the same frames gave other joints");
        }
        filter.reset();
        prop_assert!(filter.push(&samples::standing(0)).is_valid());
    }

    #[test]
    fn any_datagram_is_taken_or_counted(garbage in prop::collection::vec(any::<u8>(), 0..600),
                                        at in 0_usize..68, byte in any::<u8>(), cut in 0_usize..69) {
        let mut changed = hips();
        changed[at] = byte;
        let truncated = &hips()[..cut];
        let mut decoder = Decoder::new();
        let mut last = None;
        for (i, datagram) in [&garbage[..], &changed, truncated, &hips(), &hips(), &garbage, &hips()].iter().enumerate() {
            let before = decoder.drops().total();
            decoder.push(datagram, i as u64 * 1_000_000);
            prop_assert!(decoder.drops().total() <= before + 1);
            if let Some(joints) = decoder.take() {
                prop_assert!(joints.is_valid() && last.is_none_or(|last| last < joints.time_ns));
                last = Some(joints.time_ns);
            }
        }
        prop_assert!(last.is_some(), "the good ones arrive whatever came before");
        prop_assert!(decoder.drops().total() >= u64::from(cut < hips().len()));
    }

    #[test]
    fn any_change_of_a_recording_is_an_error_or_a_session(kind in 0_usize..3, places in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6),
                                                          cut in any::<prop::sample::Index>()) {
        let mut bytes = [skeletons::kinect_20(2), skeletons::azure(2), skeletons::mediapipe(2)][kind].clone();
        for (at, byte) in places {
            let at = at.index(bytes.len());
            bytes[at] = byte;
        }
        for part in [&bytes[..], &bytes[..cut.index(bytes.len())]] {
            match read_bytes("changed", "changed", part, None) {
                Ok(session) => prop_assert!(session.joints.iter().all(Joints::is_valid)),
                Err(error) => prop_assert!(error.to_string().len() < 400 && !error.to_string().contains('\n')),
            }
        }
    }
}
