//! Empties the queue of recorded entries into the flight recorder, and onto a disk that may be full.

use std::fs::File;
use std::io::{self, Write};
use std::sync::Arc;

use toile_base::numeric::hash::Fnv1a;
use toile_engine::clock::Clock;
use toile_engine::frame_loop::ThreadLoop;
use toile_engine::frame_loop::flight_recorder::FlightRecorder;
use toile_engine::frame_loop::recording::{self, Entry};

use super::fault_kind::FaultKind;
use super::observed_loops::{Observation, ObservedLoop, RunContext};

/// Time between two looks at the queue (ns).
const LOOK_NS: u64 = 20_000_000;

/// What waits for the disk at most (bytes): more than a minute. What is more is lost, and the recording ends there.
const MOST_WAITING: usize = 1 << 20;

/// The thread that records.
#[derive(Debug)]
pub struct RecorderLoop<C> {
    context: RunContext<C>,
    flight_recorder: Arc<FlightRecorder>,
    /// Where the recording goes; none lets it go nowhere.
    file: Option<File>,
    waiting: Vec<u8>,
    ended: bool,
    /// Steps that were recorded.
    pub steps: u64,
    /// A hash over the hashes of their states.
    pub hash: u64,
    /// Writes that the disk refused.
    pub refused: u64,
    /// Bytes that were written.
    pub written: u64,
    /// Why the recording is not whole.
    pub trouble: Option<String>,
    wrote: Option<u64>,
}

impl<C: Clock> RecorderLoop<C> {
    /// At load; the header is written at once.
    pub fn new(
        context: RunContext<C>,
        flight_recorder: Arc<FlightRecorder>,
        file: Option<File>,
        header: &[u8],
    ) -> Self {
        let mut waiting = Vec::with_capacity(MOST_WAITING);
        waiting.extend(header);
        Self {
            context,
            flight_recorder,
            file,
            waiting,
            ended: false,
            steps: 0,
            hash: Fnv1a::OFFSET_BASIS,
            refused: 0,
            written: 0,
            trouble: None,
            wrote: None,
        }
    }

    /// Takes what is there. For the end of a run too.
    pub fn look(&mut self) {
        let flight_recorder = self.flight_recorder.clone();
        flight_recorder.drain(|entry| self.take(entry));
        self.write();
    }

    /// An entry; the first comes from who starts the run.
    pub fn take(&mut self, entry: &Entry) {
        if let Entry::Step { fingerprint, .. } = entry {
            self.steps += 1;
            self.hash = (self.hash ^ fingerprint).wrapping_mul(0x9e37_79b9_7f4a_7c15).rotate_left(29);
        }
        if self.waiting.len() < MOST_WAITING && !self.ended {
            recording::write(entry, &mut self.waiting);
        } else if !self.ended {
            self.ended = true;
            self.trouble = Some("the disk was full for longer than a minute, and the recording ends there".into());
        }
    }

    fn write(&mut self) {
        if self.waiting.is_empty() {
            return;
        }
        match self.put() {
            Ok(()) => {
                self.written += self.waiting.len() as u64;
                self.waiting.clear();
                self.wrote = Some(self.context.clock.now_ns());
            }
            Err(_) => self.refused += 1,
        }
    }

    /// Onto the disk, which is full when the scenario says so.
    fn put(&mut self) -> io::Result<()> {
        let now = self.context.clock.now_ns().saturating_sub(self.context.origin_ns);
        if self.context.scenario.fault_at(now).is_some_and(|f| f.kind == FaultKind::DiskFull) {
            return Err(io::ErrorKind::StorageFull.into());
        }
        self.file.as_mut().map_or(Ok(()), |file| file.write_all(&self.waiting))
    }
}

impl<C: Clock> ThreadLoop for RecorderLoop<C> {
    fn run_due(&mut self) -> Option<u64> {
        self.look();
        Some(self.context.clock.now_ns() + LOOK_NS)
    }
}

impl<C: Clock> ObservedLoop for RecorderLoop<C> {
    fn observation(&mut self) -> Option<Observation> {
        self.wrote.take().map(Observation::Wrote)
    }
}
