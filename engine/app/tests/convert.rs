//! `toile convert`: the parts kept of a recording; no picture of a person is kept unasked.

use crate::common::Scratch;
use crate::recordings;
use serde_json::Value;
use toile_base::skeleton::Joint;
use toile_sensors::session::Session;
use toile_sensors::source::{OpenOptions, open};

/// Records a second of the synthetic shopper.
fn recorded(scratch: &Scratch) -> Session {
    assert!(scratch.toile(&["record", "--out", "in.mcap", "--seconds", "1", "--quiet"]).status.success());
    open(&scratch.path().join("in.mcap"), &OpenOptions::default()).expect("a session")
}

fn converted(scratch: &Scratch, input: &str, out: &str, more: &[&str]) -> (Value, Session) {
    let output = scratch.toile(&[&["convert", input, "--out", out, "--json"], more].concat());
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let json = serde_json::from_slice(&output.stdout).expect("one JSON object");
    (json, open(&scratch.path().join(out), &OpenOptions::default()).expect("a session"))
}

#[test]
fn joints_alone_are_kept_unless_depth_is_asked_for() {
    let scratch = Scratch::new("convert-depth");
    let original = recorded(&scratch);
    let (json, session) = converted(&scratch, "in.mcap", "joints.mcap", &[]);
    assert_eq!(json["schema"], "toile.convert/1");
    assert_eq!((json["joint_frames"].as_u64(), json["depth_frames"].as_u64()), (Some(30), Some(0)));
    assert_eq!(json["depth_frames_left_out"], 30);
    assert!(session.depth.is_empty() && session.joints == original.joints);
    // Replay is exact: all of it comes back, bit for bit, and again from what was converted.
    let (_, all) = converted(&scratch, "in.mcap", "all.mcap", &["--depth", "all"]);
    assert_eq!((&all.joints, &all.depth), (&original.joints, &original.depth));
    converted(&scratch, "all.mcap", "again.mcap", &["--depth", "all"]);
    let bytes = |name: &str| std::fs::read(scratch.path().join(name)).unwrap();
    assert_eq!(bytes("all.mcap"), bytes("again.mcap"));
}

#[test]
fn a_recording_of_depth_alone_is_not_converted_unasked() {
    let scratch = Scratch::new("convert-alone");
    std::fs::write(scratch.path().join("wall.u16le"), vec![7u8; 640 * 480 * 2]).unwrap();
    let output = scratch.toile(&["convert", "wall.u16le", "--out", "out.mcap"]);
    assert_eq!(output.status.code(), Some(4));
    assert!(String::from_utf8_lossy(&output.stderr).contains("--depth"), "{output:?}");
    assert!(!scratch.path().join("out.mcap").exists());
    let (json, session) = converted(&scratch, "wall.u16le", "out.mcap", &["--depth", "all"]);
    assert_eq!((json["depth_frames"].as_u64(), session.depth.len()), (Some(1), 1));
    // A wall is no person: nothing of it is the shopper's.
    let (_, session) = converted(&scratch, "wall.u16le", "shopper.mcap", &["--depth", "shopper"]);
    assert_eq!(session.depth[0].valid_pixels(), 0);
}

/// Median distance between two tracks of a joint (m).
fn apart(a: &Session, b: &Session, joint: Joint) -> f32 {
    let pairs = a.joints.iter().zip(&b.joints).filter(|(p, _)| p.at(joint).is_believed());
    let mut all: Vec<f32> = pairs.map(|(p, q)| p.at(joint).position.distance(q.at(joint).position)).collect();
    all.sort_by(f32::total_cmp);
    assert!(all.len() > 20, "{joint:?} is believed in {} frames", all.len());
    all[all.len() / 2]
}

#[test]
fn joints_are_fitted_to_depth_alone_where_that_is_asked_for_and_dress_a_shopper() {
    let scratch = Scratch::new("convert-fit");
    let original = recorded(&scratch);
    let alone = Session { joints: Vec::new(), ..original.clone() };
    std::fs::write(scratch.path().join("depth.mcap"), alone.to_bytes().expect("a session")).unwrap();
    let (json, session) = converted(&scratch, "depth.mcap", "joints.mcap", &["--fit"]);
    assert_eq!((json["joint_frames"].as_u64(), json["depth_frames"].as_u64()), (Some(30), Some(0)));
    for joint in
        [Joint::Pelvis, Joint::Head, Joint::LeftShoulder, Joint::RightElbow, Joint::LeftWrist, Joint::RightKnee]
    {
        let off = apart(&session, &original, joint);
        assert!(off < 0.06, "{joint:?}: {off}");
    }
    let output = scratch.toile(&["try-on", "--session", "depth.mcap", "--out", "out", "--no-pictures", "--json"]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let json: Value = serde_json::from_slice(&output.stdout).expect("one JSON object");
    assert!(json["physics"]["steps"].as_u64() > Some(100) && json["physics"]["nonfinite"] == 0, "{json}");
    assert!(json["session"]["notes"].to_string().contains("fitted to the depth"), "{}", json["session"]);
    let stature = json["measurements"]["stature_mm"]["value"].as_f64().expect("a stature");
    assert!((stature - 1694.0).abs() < 20.0, "{stature}");
}

#[test]
fn recordings_of_every_kind_become_sessions() {
    let Some(data) = recordings::folder() else { return };
    let scratch = Scratch::new("convert-shared");
    for (file, more) in [
        ("skeleton/kinectron-kinect2/recorded_skeleton.json", &[][..]),
        ("mocap/animated-drawings/dab.bvh", &[]),
        ("depth/pyk4a-azure-mkv/recording.mkv", &["--depth", "all"]),
        ("depth/skeltrack/depth-data-1399145206.u16le", &["--depth", "shopper"]),
    ] {
        let input = data.join(file);
        let (_, session) = converted(&scratch, &input.display().to_string(), "out.mcap", more);
        let original = open(&input, &OpenOptions::default()).unwrap();
        assert_eq!(session.joints, original.joints, "{file}");
        assert_eq!(session.depth.len(), original.depth.len(), "{file}");
    }
}
