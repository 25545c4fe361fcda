//! Mutated recordings of every kind, found by proptest: an error of one sentence or a session that keeps its promises.

use std::time::{Duration, Instant};

use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::TestRunner;
use toile_sensors::depth::Clean;
use toile_sensors::source::read_bytes;

use crate::common::{data, samples};

/// One change of a file.
#[derive(Debug, Clone)]
enum Change {
    /// A byte becomes another.
    Byte(prop::sample::Index, u8),
    /// A run becomes all of one byte: a wrong length, a NaN.
    Run(prop::sample::Index, u8, usize),
    /// A piece is cut out.
    Cut(prop::sample::Index, usize),
    /// A piece comes twice: time runs backwards.
    Twice(prop::sample::Index, usize),
    /// The rest is missing.
    End(prop::sample::Index),
    /// A number of eight bytes, an extreme one.
    Number(prop::sample::Index, u64),
}

fn change() -> impl Strategy<Value = Change> {
    let at = any::<prop::sample::Index>;
    prop_oneof![
        4 => (at(), any::<u8>()).prop_map(|(i, b)| Change::Byte(i, b)),
        2 => (at(), prop::sample::select(vec![0u8, 0xff, 0x7f, 0x80, b'9', b'-']), 1..24usize)
            .prop_map(|(i, b, n)| Change::Run(i, b, n)),
        1 => (at(), 1..4000usize).prop_map(|(i, n)| Change::Cut(i, n)),
        1 => (at(), 1..4000usize).prop_map(|(i, n)| Change::Twice(i, n)),
        1 => at().prop_map(Change::End),
        1 => (at(), prop::sample::select(vec![u64::MAX, 1 << 63, 0x7ff0_0000_0000_0000, 0x7fc0_0000_7fc0_0000, 1 << 40]))
            .prop_map(|(i, n)| Change::Number(i, n)),
    ]
}

/// Changes a file; `head` bytes from its begin are hit as often as all the rest.
fn changed(original: &[u8], changes: &[Change], head: usize) -> Vec<u8> {
    let mut bytes = original.to_vec();
    for (i, change) in changes.iter().enumerate() {
        if bytes.is_empty() {
            break;
        }
        let reach = if i % 2 == 0 { bytes.len() } else { head.min(bytes.len()) };
        let until = |at: usize, n: usize, len: usize| (at + n).min(len);
        match change {
            Change::Byte(at, b) => bytes[at.index(reach)] = *b,
            Change::Run(at, b, n) => {
                let (at, len) = (at.index(reach), bytes.len());
                bytes[at..until(at, *n, len)].fill(*b);
            }
            Change::Cut(at, n) => {
                let (at, len) = (at.index(reach), bytes.len());
                bytes.drain(at..until(at, *n, len));
            }
            Change::Twice(at, n) => {
                let (at, len) = (at.index(reach), bytes.len());
                let piece = bytes[at..until(at, *n, len)].to_vec();
                bytes.splice(at..at, piece);
            }
            Change::End(at) => bytes.truncate(at.index(reach)),
            Change::Number(at, n) => {
                let (at, len) = (at.index(reach), bytes.len());
                let end = until(at, 8, len);
                bytes[at..end].copy_from_slice(&n.to_be_bytes()[..end - at]);
            }
        }
    }
    bytes
}

/// Reads it, and lets the depth stages see what came of it.
fn survives(name: &str, bytes: &[u8], camera: Option<&[u8]>) -> bool {
    match read_bytes(name, "fuzz", bytes, camera.map(|json| ("camera.json", json))) {
        Err(error) => {
            let text = error.to_string();
            assert!(!text.contains('\n') && text.len() < 500, "{text}");
            false
        }
        Ok(session) => {
            assert!(session.joints.iter().all(|f| f.is_valid()) && session.depth.iter().all(|f| f.fault().is_none()));
            assert!(session.depth.windows(2).all(|w| w[0].time_ns < w[1].time_ns));
            let mut clean = Clean::default();
            for frame in session.depth.iter().take(2).filter(|f| f.depth_mm.len() < 1 << 16) {
                let (_, cloud) = clean.push(frame);
                assert!(cloud.known().all(|(_, p, n)| p.is_finite() && n.is_finite()));
            }
            true
        }
    }
}

/// Bounded in cases and in time, so that a slow machine tries fewer.
fn fuzz(name: &str, original: &[u8], camera: Option<&[u8]>, cases: u32, head: usize) {
    assert!(survives(name, original, camera), "{name} is not read as it is");
    let (begin, mut tried, mut read) = (Instant::now(), 0, 0);
    let mut runner = TestRunner::deterministic();
    let changes = prop::collection::vec(change(), 1..5);
    while tried < cases && begin.elapsed() < Duration::from_secs(8) {
        let changes = changes.new_tree(&mut runner).unwrap().current();
        read += u32::from(survives(name, &changed(original, &changes, head), camera));
        tried += 1;
    }
    println!("{name}: {tried} mutations, {read} of them still read");
    assert!(tried >= 3, "{name}: only {tried} mutations in the time");
}

#[test]
fn small_recordings_of_every_kind() {
    fuzz("session.mcap", &samples::session().to_bytes().unwrap(), None, 3000, 2048);
    fuzz("kinect.csv", &samples::kinect_csv(4), None, 1500, 512);
    fuzz("kinectron.json", &samples::kinectron(3), None, 1500, 512);
    fuzz("motion.bvh", &samples::bvh(4), None, 1500, 512);
    fuzz("depth.u16le", &samples::raw_depth(), Some(samples::CAMERA.as_bytes()), 1500, 64);
    fuzz("depth.png", &samples::png(16, 12), Some(samples::CAMERA.as_bytes()), 3000, 64);
    fuzz("azure.mkv", &samples::azure(3), None, 2000, 1024);
}

#[test]
fn camera_descriptions() {
    let raw = samples::raw_depth();
    let camera = samples::CAMERA.replace("\"fx\"", "\"distortion\":{\"k1\":0.5,\"k4\":0.9,\"p1\":1e-4},\"fx\"");
    let (begin, mut tried) = (Instant::now(), 0);
    let mut runner = TestRunner::deterministic();
    let changes = prop::collection::vec(change(), 1..4);
    while tried < 3000 && begin.elapsed() < Duration::from_secs(8) {
        let changes = changes.new_tree(&mut runner).unwrap().current();
        survives("depth.u16le", &raw, Some(&changed(camera.as_bytes(), &changes, 64)));
        tried += 1;
    }
    assert!(tried >= 3);
}

#[test]
fn real_recordings() {
    let Some(folder) = data() else { return };
    let read = |file: &str| std::fs::read(folder.join(file)).unwrap();
    fuzz("recording.mkv", &read("depth/pyk4a-azure-mkv/recording.mkv"), None, 40, 6_000);
    fuzz("kinect.u16le", &read("depth/skeltrack/depth-data-1399145206.u16le"), None, 40, 64);
}
