//! The hashes as functions of a module of WebAssembly.

use std::sync::Mutex;

use toile_engine::lanes::Width;

use crate::dress_recording::DressRecording;

/// The recording, which the host writes.
static FILE: Mutex<Vec<u8>> = Mutex::new(Vec::new());

fn width(lanes: u32) -> Width {
    Width::of(lanes as usize).unwrap_or(Width::One)
}

/// Makes room for a recording and returns its address. The host writes the recording there.
#[unsafe(no_mangle)]
pub extern "C" fn file(bytes: u32) -> *mut u8 {
    let mut file = FILE.lock().expect("one thread");
    *file = vec![0; bytes as usize];
    file.as_mut_ptr()
}

/// The state hash of the skirt on so many lanes.
#[unsafe(no_mangle)]
pub extern "C" fn skirt_hash(lanes: u32) -> u64 {
    crate::skirt_hash(width(lanes))
}

/// The state hash of the recorded dress on so many lanes; 0 where the bytes are no recording.
#[unsafe(no_mangle)]
pub extern "C" fn dress_hash(lanes: u32) -> u64 {
    let file = FILE.lock().expect("one thread");
    DressRecording::from_bytes(&file).map_or(0, |recording| recording.hash(width(lanes)))
}
