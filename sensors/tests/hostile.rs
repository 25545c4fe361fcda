//! No bytes whatever make a reader panic, hang or hand out a number that is not finite.

use toile_base::numeric::random::SplitMix64;
use toile_sensors::session::{self, Session};
use toile_sensors::source::{SourceError, read_bytes};

use crate::common::samples;

/// One recording of every kind: its name, its bytes, and the camera where it needs one.
fn kinds() -> Vec<(&'static str, Vec<u8>, Option<&'static str>)> {
    vec![
        ("session.mcap", samples::session().to_bytes().unwrap(), None),
        ("kinect.csv", samples::kinect_csv(4), None),
        ("kinectron.json", samples::kinectron(3), None),
        ("motion.bvh", samples::bvh(4), None),
        ("depth.u16le", samples::raw_depth(), Some(samples::CAMERA)),
        ("depth.png", samples::png(16, 12), Some(samples::CAMERA)),
    ]
}

fn read(name: &str, bytes: &[u8], camera: Option<&str>) -> Result<Session, SourceError> {
    read_bytes(name, "sample", bytes, camera.map(|json| ("camera.json", json.as_bytes())))
}

/// Either a sentence that begins with the file's name, or a session that keeps its promises.
fn survives(name: &str, bytes: &[u8], camera: Option<&str>) -> bool {
    match read(name, bytes, camera) {
        Err(error) => {
            let text = error.to_string();
            assert!(text.starts_with(name) || text.starts_with("camera.json"), "{text}");
            assert!(!text.contains('\n') && text.len() < 400, "{text}");
            false
        }
        Ok(session) => {
            assert!(session.joints.iter().all(|f| f.is_valid()) && session.depth.iter().all(|f| f.fault().is_none()));
            assert!(session.joints.windows(2).all(|w| w[0].time_ns < w[1].time_ns));
            assert!(session.to_bytes().is_ok());
            true
        }
    }
}

#[test]
fn every_sample_is_read_completely() {
    for (name, bytes, camera) in kinds() {
        let session = read(name, &bytes, camera).unwrap_or_else(|e| panic!("{e}"));
        assert!(session.joints.len() + session.depth.len() >= 2 || name == "depth.png", "{name}");
    }
}

#[test]
fn truncation_at_any_byte_is_an_error_or_a_shorter_session() {
    for (name, bytes, camera) in kinds() {
        let whole = read(name, &bytes, camera).unwrap();
        let mut read_anyway = 0;
        for end in 0..bytes.len() {
            if survives(name, &bytes[..end], camera) {
                read_anyway += 1;
                let part = read(name, &bytes[..end], camera).unwrap();
                assert!(
                    part.joints.len() <= whole.joints.len() && part.depth.len() <= whole.depth.len(),
                    "{name} {end}"
                );
            }
        }
        println!("{name}: {} bytes, {read_anyway} of the shorter files give a session", bytes.len());
        assert!(read_anyway < bytes.len() / 2, "{name}");
    }
}

#[test]
fn a_long_recording_cut_in_the_middle_keeps_its_first_frames_and_says_so() {
    let mut long = samples::session();
    long.joints = (0..2000).map(|i| samples::standing(i * 8_333_333)).collect();
    let bytes = long.to_bytes().unwrap();
    let cut = session::read("cut.mcap", &bytes[..bytes.len() * 2 / 3]).unwrap();
    assert!((600..1500).contains(&cut.joints.len()), "{}", cut.joints.len());
    assert_eq!(cut.joints[..], long.joints[..cut.joints.len()]);
    assert!(cut.notes.last().unwrap().contains("cut off"), "{:?}", cut.notes);
}

#[test]
fn changed_bytes_do_no_harm() {
    let mut rng = SplitMix64::new(2024);
    for (name, bytes, camera) in kinds() {
        for _ in 0..3000 {
            let mut changed = bytes.clone();
            for _ in 0..1 + rng.next_u64() % 4 {
                let at = (rng.next_u64() % changed.len() as u64) as usize;
                changed[at] = rng.next_u64() as u8;
            }
            survives(name, &changed, camera);
        }
    }
}

#[test]
fn runs_of_extreme_bytes_do_no_harm() {
    let mut rng = SplitMix64::new(7);
    for (name, bytes, camera) in kinds() {
        for _ in 0..2000 {
            let mut changed = bytes.clone();
            let at = (rng.next_u64() % changed.len() as u64) as usize;
            let end = (at + 1 + (rng.next_u64() % 16) as usize).min(changed.len());
            changed[at..end].fill([0x00, 0xff, 0x7f, b'9', b'e', b','][(rng.next_u64() % 6) as usize]);
            survives(name, &changed, camera);
        }
    }
}

#[test]
fn a_file_of_another_kind_is_refused_in_one_sentence() {
    for (name, bytes, camera) in kinds() {
        // A camera beside a recording that holds no depth changes nothing: what a file is, its content says.
        let [alone, beside] = [camera, Some(samples::CAMERA)].map(|c| read(name, &bytes, c).unwrap());
        assert_eq!(alone, beside, "{name}");
    }
    for bytes in
        [&b""[..], b"\n\n", b"{\"a\":1}", b"PK\x03\x04", b"#!/bin/sh\n", b"[]", b"[1,2]", b"1,2,3", b"HIERARCHY"]
    {
        assert!(!survives("other.bin", bytes, None), "{bytes:?}");
    }
}

#[test]
fn absurd_counts_and_numbers_are_refused_at_once() {
    let csv = String::from_utf8(samples::kinect_csv(3)).unwrap();
    let json = String::from_utf8(samples::kinectron(3)).unwrap();
    let bvh = String::from_utf8(samples::bvh(3)).unwrap();
    let billion = "0.5,".repeat(1_000_000);
    let changed = [
        ("nan.csv", csv.replacen("0.45", "nan", 1)),
        ("inf.csv", csv.replacen("0.45", "inf", 1)),
        ("far.csv", csv.replacen("0.45", "1e30", 1)),
        ("long.csv", format!("{csv}1,{billion}")),
        ("nan.json", json.replacen("0.45", "NaN", 1)),
        ("huge.json", json.replacen("0.45", "1e39", 1)),
        ("time.json", json.replacen("\"record_timestamp\":11", "\"record_timestamp\":1e300", 1)),
        (
            "joints.json",
            json.replacen(
                "\"joints\":[",
                &format!("\"joints\":[{}", "{\"cameraX\":0,\"cameraY\":0,\"cameraZ\":0},".repeat(100_000)),
                1,
            ),
        ),
        ("frames.bvh", bvh.replacen("Frames: 3", "Frames: 1000000000", 1)),
        ("overflow.bvh", bvh.replacen("Frames: 3", "Frames: 99999999999999999999999", 1)),
        ("nan.bvh", bvh.replacen("0.5 0.5", "nan 0.5", 1)),
        ("flung.bvh", bvh.replacen("0 95 0", "0 95000000 0", 1)),
        ("joints.bvh", bvh.replacen("JOINT LeftHip", &"JOINT a\n{\nOFFSET 0 0 0\n}\n".repeat(5000), 1)),
    ];
    for (name, text) in changed {
        assert!(!survives(name, text.as_bytes(), None), "{name}");
    }
    for camera in [
        samples::CAMERA.replace("16", "65535").replace("12", "65535"),
        samples::CAMERA.replace("\"width\":16", "\"width\":0"),
        samples::CAMERA.replace("\"width\":16", "\"width\":99999999999"),
        samples::CAMERA.replace("\"fx\":14", "\"fx\":0"),
        samples::CAMERA.replace("\"fx\":14", "\"fx\":1e60"),
        samples::CAMERA.replace("[1,0,0,0]", "[5,0,0,0]"),
        samples::CAMERA.replace("1000]", "1e12]"),
        "{}".to_owned(),
        String::new(),
    ] {
        assert!(read("depth.u16le", &samples::raw_depth(), Some(&camera)).is_err(), "{camera}");
    }
}

#[test]
fn a_session_that_breaks_its_promises_is_not_written() {
    let good = samples::session();
    let mut backwards = good.clone();
    backwards.joints.swap(3, 4);
    let mut nan = good.clone();
    nan.joints[5].joints[2].position.x = f32::NAN;
    let mut size = good.clone();
    size.depth[1].intrinsics.width = 17;
    for bad in [backwards, nan, size, Session::default()] {
        assert!(bad.to_bytes().is_err());
    }
    let folder = std::env::temp_dir().join(format!("toile-sensors-{}", std::process::id()));
    let nowhere = folder.join("missing").join("a.mcap");
    assert!(session::write(&nowhere, &good).unwrap_err().to_string().contains("cannot be written"));
}

#[test]
fn a_session_returns_as_it_was_written_and_twice_the_same() {
    let session = samples::session();
    let bytes = session.to_bytes().unwrap();
    assert_eq!(bytes, session.to_bytes().unwrap());
    let mut back = session::read("memory", &bytes).unwrap();
    assert_eq!(back, session);
    back.raw_scale_known = false;
    assert!(!session::read("memory", &back.to_bytes().unwrap()).unwrap().raw_scale_known);
    let file = std::env::temp_dir().join(format!("toile-sensors-{}.mcap", std::process::id()));
    session::write(&file, &session).unwrap();
    let opened = toile_sensors::source::open(&file, &Default::default()).unwrap();
    std::fs::remove_file(&file).unwrap();
    assert_eq!(opened, session);
}
