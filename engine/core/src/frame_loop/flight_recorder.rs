//! Flight recorder: keeps the inputs of the last seconds in memory, so that a crash can be replayed.
//!
//! A replay must begin in a known state, which is the moment at which a shopper was dressed. The recorder therefore keeps
//! everything since the last such moment that lies at least [`KEPT_NS`] back: ten seconds or more, with the whole of the
//! session in which they began. The thread that empties the recording's queue fills it; the physics thread only writes to
//! the queue. If a thread panics, the panic hook saves what is kept as a file for `toile replay`.

use std::collections::VecDeque;
use std::sync::{Mutex, MutexGuard, PoisonError, TryLockError};
use std::thread;
use std::time::{Duration, Instant};

use super::queue::{Capacity, Receiver};
use super::recording::{self, Entry, SceneNote};

/// Shortest time that is kept (ns).
pub const KEPT_NS: u64 = 10_000_000_000;

/// Memory that is allocated, and written to once, for each of two sessions at load (bytes): enough for nine minutes. Only a
/// longer session allocates while it goes on.
pub const RESERVED_BYTES: usize = 8 << 20;

/// Most that is kept of one session (bytes): an hour at 15 kB a second. The rest of a longer session is not kept.
pub const MOST_BYTES: usize = 56 << 20;

/// Time between two tries to lock the recorder.
const RETRY: Duration = Duration::from_micros(500);

/// The entries of one session: from one dressing of a shopper to the next.
#[derive(Debug, Default)]
struct RecordedSession {
    /// When its first step was due (ns).
    from_ns: Option<u64>,
    /// Number of the scene that it began with.
    first: u64,
    bytes: Vec<u8>,
}

#[derive(Debug)]
struct RecorderState {
    header: Vec<u8>,
    entries: Receiver<Entry>,
    /// How scenes that are kept or come next are made, as encoded notes, with their numbers.
    notes: VecDeque<(u64, Vec<u8>)>,
    sessions: VecDeque<RecordedSession>,
    newest_ns: u64,
    /// Storage of sessions that were forgotten, for those to come.
    spare: Vec<Vec<u8>>,
}

/// The recorder, shared by the thread that fills it and the panic hook that saves it.
#[derive(Debug)]
pub struct FlightRecorder(Mutex<RecorderState>);

impl FlightRecorder {
    /// An empty recorder whose file begins with this header ([`recording::header`]); it empties this queue.
    pub fn new(header: Vec<u8>, entries: Receiver<Entry>) -> Self {
        // Written to once, so that the system has given it.
        let reserved = || {
            let mut bytes = vec![1; RESERVED_BYTES];
            bytes.clear();
            bytes
        };
        let spare = vec![reserved(), reserved()];
        let (notes, sessions) = (VecDeque::with_capacity(16), VecDeque::with_capacity(16));
        Self(Mutex::new(RecorderState { header, entries, notes, sessions, newest_ns: 0, spare }))
    }

    /// Keeps an entry that comes from elsewhere: how the shopper was dressed before the first step.
    pub fn keep(&self, entry: &Entry) {
        self.locked().keep(entry);
    }

    /// Keeps how a scene is made, as long as it is kept itself. Before the scene is handed over; numbers grow.
    pub fn describe(&self, note: &SceneNote) {
        let mut bytes = Vec::new();
        recording::write_note(note, &mut bytes);
        self.locked().notes.push_back((note.number, bytes));
    }

    /// Empties the queue; each entry is handed on as well.
    pub fn drain(&self, mut each: impl FnMut(&Entry)) {
        let mut inner = self.locked();
        while let Some(entry) = inner.entries.pop() {
            inner.keep(&entry);
            each(&entry);
        }
    }

    /// How full the queue was.
    pub fn capacity(&self) -> Capacity {
        self.locked().entries.capacity()
    }

    /// The bytes of the file, with all that is still in the queue; none where nothing was stepped, or where the recorder
    /// cannot be locked within this time because the thread that fills it panicked while it held the lock.
    pub fn save(&self, within: Duration) -> Option<Vec<u8>> {
        let until = Instant::now() + within;
        let mut inner = loop {
            match self.0.try_lock() {
                Ok(inner) => break inner,
                Err(TryLockError::Poisoned(inner)) => break inner.into_inner(),
                Err(TryLockError::WouldBlock) if Instant::now() < until => thread::sleep(RETRY),
                Err(TryLockError::WouldBlock) => return None,
            }
        };
        while let Some(entry) = inner.entries.pop() {
            inner.keep(&entry);
        }
        inner.sessions.iter().any(|s| s.from_ns.is_some()).then(|| {
            let mut file = inner.header.clone();
            inner.notes.iter().for_each(|(_, note)| file.extend(note));
            inner.sessions.iter().for_each(|s| file.extend(&s.bytes));
            file
        })
    }

    fn locked(&self) -> MutexGuard<'_, RecorderState> {
        // A record that was half written ends the file early, which the reader accepts.
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl RecorderState {
    fn keep(&mut self, entry: &Entry) {
        let begins = match entry {
            Entry::Dressed(_) => Some(0),
            Entry::Changed { number, afresh: true } => Some(*number),
            _ => None,
        };
        if let Some(first) = begins {
            let bytes = self.spare.pop().unwrap_or_default();
            self.sessions.push_back(RecordedSession { from_ns: None, first, bytes });
        }
        let Some(session) = self.sessions.back_mut() else { return };
        if session.bytes.len() < MOST_BYTES {
            recording::write(entry, &mut session.bytes);
        }
        if let Entry::Step { scheduled_ns, .. } = entry {
            session.from_ns = session.from_ns.or(Some(*scheduled_ns));
            self.newest_ns = *scheduled_ns;
            self.forget();
        }
    }

    /// Forgets sessions that lie so far back that those after them are enough.
    fn forget(&mut self) {
        let enough = self.newest_ns.saturating_sub(KEPT_NS);
        while self.sessions.get(1).and_then(|s| s.from_ns).is_some_and(|from| from <= enough) {
            if let Some(mut old) = self.sessions.pop_front() {
                old.bytes.clear();
                self.spare.push(old.bytes);
            }
        }
        let first = self.sessions.front().map_or(0, |session| session.first);
        while self.notes.front().is_some_and(|(number, _)| *number < first) {
            self.notes.pop_front();
        }
    }
}

#[cfg(test)]
mod tests {
    use toile_base::clock::{SECOND_NS, ticks_to_ns};
    use toile_base::frame::Joints;

    use super::*;
    use crate::frame_loop::queue::bounded;

    fn step(tick: u64) -> Entry {
        Entry::Step { tick, scheduled_ns: ticks_to_ns(tick), level: 0, fingerprint: tick }
    }

    /// The first and the last step of the file.
    fn kept(file: &[u8]) -> (Entry, u64, u64) {
        let recording::LoopRecording { text, notes, entries } = recording::read(file).unwrap();
        assert_eq!(text, "a scene");
        let Entry::Changed { number: first, .. } = entries[0] else { panic!("{:?}", entries[0]) };
        let described: Vec<u64> = notes.iter().map(|note| note.number).collect();
        let changed =
            entries.iter().filter_map(|e| if let Entry::Changed { number, .. } = e { Some(*number) } else { None });
        assert_eq!(described, changed.collect::<Vec<_>>(), "each that is kept, from {first} on, and no other");
        let ticks = entries.iter().filter_map(|e| if let Entry::Step { tick, .. } = e { Some(*tick) } else { None });
        let ticks: Vec<u64> = ticks.collect();
        (entries[0], ticks[0], ticks[ticks.len() - 1])
    }

    #[test]
    fn ten_seconds_are_kept_from_a_dressing_on() {
        let (mut sender, receiver) = bounded("", 4_096);
        let recorder = FlightRecorder::new(recording::header("a scene"), receiver);
        assert!(recorder.save(Duration::ZERO).is_none(), "nothing was stepped yet");
        // A session every 8 s for a minute, a garment changed in the middle of each.
        for tick in 0..120 * 60 {
            if tick % 480 == 0 {
                let number = tick / 480;
                recorder.describe(&SceneNote { number, first: Joints::absent(0), text: "another".into() });
                sender.push(Entry::Changed { number, afresh: tick % 960 == 0 });
            }
            sender.push(step(tick));
            if tick % 100 == 0 {
                recorder.drain(|_| {});
            }
        }
        // The rest is still in the queue.
        let (first, from, to) = kept(&recorder.save(Duration::ZERO).unwrap());
        assert_eq!((first, to), (Entry::Changed { number: 12, afresh: true }, 120 * 60 - 1));
        assert_eq!(from, 120 * 48, "the session under way ten seconds ago");
        assert!(ticks_to_ns(to) - ticks_to_ns(from) >= KEPT_NS && KEPT_NS == 10 * SECOND_NS);
    }

    #[test]
    fn a_box_that_is_held_is_not_waited_for_without_end() {
        let (_sender, receiver) = bounded("", 4);
        let recorder = FlightRecorder::new(Vec::new(), receiver);
        let held = recorder.locked();
        assert!(recorder.save(Duration::from_millis(5)).is_none());
        drop(held);
    }
}
