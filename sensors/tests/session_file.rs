//! Session files as other programs write them, and what a session file keeps.

use toile_base::frame::HandState;
use toile_base::frame::HandState::{Closed, Open, Unknown};
use toile_sensors::session;

use crate::common::samples;

const PYTHON_ZSTD: &[u8] = include_bytes!("data/python-zstd.mcap");
const PYTHON_LZ4: &[u8] = include_bytes!("data/python-lz4.mcap");
const GAP: &[u8] = include_bytes!("data/gap.mcap");
const BOMBS: [&[u8]; 2] = [include_bytes!("data/bomb.mcap"), include_bytes!("data/large-bomb.mcap")];

fn states(i: usize) -> [HandState; 2] {
    [[Unknown, Open, Closed][i % 3], [Unknown, Open, Closed][(i + 1) % 3]]
}

#[test]
fn a_file_of_the_python_writer_is_read_with_its_hands() {
    let session = session::read("python-zstd.mcap", PYTHON_ZSTD).unwrap();
    assert_eq!((session.name.as_str(), session.joints.len(), session.raw_scale_known), ("by python", 40, true));
    for (i, frame) in session.joints.iter().enumerate() {
        assert_eq!(frame.time_ns, i as u64 * 33_000_000);
        let place = |k: usize| [k as f32 / 64.0, i as f32 / 64.0, 0.5];
        assert!(frame.joints.iter().enumerate().all(|(k, joint)| joint.position.to_array() == place(k)));
        assert_eq!(frame.hands, states(i));
    }
}

#[test]
fn a_packed_file_cut_off_or_spoilt_anywhere_is_a_sentence_or_a_shorter_session() {
    let mut shorter = 0;
    for end in 0..PYTHON_ZSTD.len() {
        match session::read("cut.mcap", &PYTHON_ZSTD[..end]) {
            Ok(session) => shorter += usize::from((1..=40).contains(&session.joints.len())),
            Err(error) => assert!(!error.to_string().contains('\n')),
        }
    }
    assert!(shorter > 100, "{shorter}");
    for at in 0..PYTHON_ZSTD.len() {
        let mut bytes = PYTHON_ZSTD.to_vec();
        bytes[at] ^= 0x11;
        if let Err(error) = session::read("spoilt.mcap", &bytes) {
            let text = error.to_string();
            assert!(text.starts_with("spoilt.mcap") && !text.contains('\n') && !text.contains(".rs"), "{text}");
        }
    }
}

#[test]
fn what_unpacks_to_more_than_it_says_or_than_a_chunk_may_be_is_refused() {
    for bomb in BOMBS {
        let error = session::read("bomb.mcap", bomb).unwrap_err().to_string();
        assert!(error.contains("chunk") || error.contains("bytes"), "{error}");
    }
}

#[test]
fn another_compression_is_named_with_its_cure() {
    let error = session::read("python-lz4.mcap", PYTHON_LZ4).unwrap_err().to_string();
    assert!(error.contains("`lz4`") && error.contains("zstd are read; write it again"), "{error}");
}

#[test]
fn hands_survive_writing_and_reading_and_cost_nothing_where_there_are_none() {
    let plain = samples::session();
    let mut with = plain.clone();
    for (i, frame) in with.joints.iter_mut().enumerate() {
        frame.hands = states(i);
    }
    let bytes = with.to_bytes().unwrap();
    assert_eq!(session::read("hands.mcap", &bytes).unwrap(), with);
    let without = plain.to_bytes().unwrap();
    assert!(!without.windows(6).any(|w| w == b"/hands"));
    assert_eq!(session::read("plain.mcap", &without).unwrap(), plain);
}

#[test]
fn a_gap_of_a_day_is_refused() {
    let error = session::read("gap.mcap", GAP).unwrap_err().to_string();
    assert!(error.contains("gap.mcap, frame 2: it comes 86400 s after the frame before"), "{error}");
    let mut session = samples::session();
    session.joints[29].time_ns += 86_400_000_000_000;
    assert!(session.to_bytes().is_err());
}
