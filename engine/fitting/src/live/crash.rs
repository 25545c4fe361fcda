//! Crash: should any thread panic, the last seconds of the run are written as a recording, which `toile replay` takes.

use std::fs;
use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use toile_engine::frame_loop::flight_recorder::FlightRecorder;
use toile_engine::frame_loop::queue::{Sender, bounded};
use toile_engine::frame_loop::recording::{ENTRIES, ENTRIES_NAME, Entry};

/// Longest that a panicking thread waits for the flight recorder.
const LONGEST_WAIT: Duration = Duration::from_millis(500);

/// The recorder that is saved, and the file; one run at a time.
static KEPT: Mutex<Option<(Arc<FlightRecorder>, PathBuf)>> = Mutex::new(None);

/// From now on a panic of any thread writes what this recorder holds to this file.
pub fn keep(recorder: &Arc<FlightRecorder>, path: PathBuf) {
    *KEPT.lock().unwrap_or_else(PoisonError::into_inner) = Some((recorder.clone(), path));
}

/// A recorder whose file begins with this header (`frame_loop::recording::header`), saved if a thread panics from now on; and
/// the queue that fills it.
pub fn record(header: Vec<u8>, path: PathBuf) -> (Arc<FlightRecorder>, Sender<Entry>) {
    let (sender, entries) = bounded(ENTRIES_NAME, ENTRIES);
    let recorder = Arc::new(FlightRecorder::new(header, entries));
    keep(&recorder, path);
    (recorder, sender)
}

/// Forgets the recorder: the run is over.
pub fn forget() {
    *KEPT.lock().unwrap_or_else(PoisonError::into_inner) = None;
}

/// Saves the recorder, if there is one; the sentence says where, or why not. For the panic hook, which must not panic itself.
pub fn save() -> Option<String> {
    // No thread holds this lock for long, but the panicking thread may hold it itself.
    let (recorder, path) = KEPT.try_lock().ok()?.take()?;
    let name = path.display();
    let Some(bytes) = recorder.save(LONGEST_WAIT) else {
        return Some("no recording of the last seconds could be had".to_owned());
    };
    Some(match fs::write(&path, bytes) {
        Ok(()) => format!("the last seconds are recorded in {name}; take them again with `toile replay {name}`"),
        Err(e) => format!("the last seconds could not be recorded in {name} ({e})"),
    })
}
