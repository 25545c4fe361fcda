//! Crash: should any thread panic, the last seconds of the run are written as a recording, which `toile replay` takes.

use std::fs;
use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use toile_engine::frame_loop::flight_recorder::FlightRecorder;
use toile_engine::frame_loop::queue::{Sender, bounded};
use toile_engine::frame_loop::recording::{ENTRIES, ENTRIES_NAME, Entry};

/// Longest that a dying thread waits for the black box.
const LONGEST_WAIT: Duration = Duration::from_millis(500);

/// What is saved, and where; one run at a time.
static KEPT: Mutex<Option<(Arc<FlightRecorder>, PathBuf)>> = Mutex::new(None);

/// From now on a panic of any thread writes this box there.
pub fn keep(black_box: &Arc<FlightRecorder>, path: PathBuf) {
    *KEPT.lock().unwrap_or_else(PoisonError::into_inner) = Some((black_box.clone(), path));
}

/// A box whose file begins with this header (`frame_loop::recording::header`), kept from now on for a crash; and the end of the tape that fills it.
pub fn record(header: Vec<u8>, path: PathBuf) -> (Arc<FlightRecorder>, Sender<Entry>) {
    let (sender, entries) = bounded(ENTRIES_NAME, ENTRIES);
    let black_box = Arc::new(FlightRecorder::new(header, entries));
    keep(&black_box, path);
    (black_box, sender)
}

/// The run is over.
pub fn forget() {
    *KEPT.lock().unwrap_or_else(PoisonError::into_inner) = None;
}

/// Writes the box, if one is kept; the sentence says where, or why not. For the panic hook, which must not panic itself.
pub fn save() -> Option<String> {
    // Nobody holds this lock for long, but who panics may be the one that does.
    let (black_box, path) = KEPT.try_lock().ok()?.take()?;
    let name = path.display();
    let Some(bytes) = black_box.save(LONGEST_WAIT) else {
        return Some("no recording of the last seconds could be had".to_owned());
    };
    Some(match fs::write(&path, bytes) {
        Ok(()) => format!("the last seconds are recorded in {name}; take them again with `toile replay {name}`"),
        Err(e) => format!("the last seconds could not be recorded in {name} ({e})"),
    })
}
