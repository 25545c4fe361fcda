//! Readback: results come back a frame late through a ring of staging buffers, and are dropped rather than waited for.

use std::sync::Arc;
use std::sync::atomic::{AtomicU8, Ordering};
use std::time::{Duration, Instant};

use wgpu::{Buffer, BufferDescriptor, BufferSlice, BufferUsages, CommandEncoder, MapMode};

/// Staging buffers: one that is read, one on its way, one spare for a late driver.
const PLACES: usize = 3;

/// States of a staging buffer.
const FREE: u8 = 0;
const UNDER_WAY: u8 = 1;
const ARRIVED: u8 = 2;
const FAILED: u8 = 3;

/// Staging buffers in turn.
#[derive(Debug)]
pub struct ReadbackRing {
    places: [StagingBuffer; PLACES],
    /// Number of the newest step that was taken.
    newest: u64,
    /// Whether the newest step was dropped because no place was free: what was read last is older than what the device has.
    pub behind: bool,
    /// Steps that were sent, came back, and were dropped because no place was free.
    pub tally: ReadbackCounts,
}

/// A staging buffer.
#[derive(Debug)]
struct StagingBuffer {
    buffer: Buffer,
    state: Arc<AtomicU8>,
    /// Number of the step that comes back to it, and when that was sent.
    number: u64,
    since: Instant,
}

/// Counts of the steps read back.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct ReadbackCounts {
    /// Sent to come back.
    pub sent: u64,
    /// Came back and were taken.
    pub taken: u64,
    /// Were not sent, because no place was free, came back older than one that had been taken, or did not come back readable.
    pub dropped: u64,
}

impl StagingBuffer {
    fn is(&self, state: u8) -> bool {
        // Acquire: pairs with the callback's release, after which the buffer is ours again.
        self.state.load(Ordering::Acquire) == state
    }
}

impl ReadbackRing {
    /// A ring for results of this many bytes a step.
    pub fn new(device: &wgpu::Device, bytes: u64) -> Self {
        let place = || {
            let usage = BufferUsages::COPY_DST | BufferUsages::MAP_READ;
            let descriptor =
                BufferDescriptor { label: Some("back"), size: bytes.max(16), usage, mapped_at_creation: false };
            let buffer = device.create_buffer(&descriptor);
            StagingBuffer { buffer, state: Arc::new(AtomicU8::new(FREE)), number: 0, since: Instant::now() }
        };
        Self { places: [place(), place(), place()], newest: 0, behind: false, tally: ReadbackCounts::default() }
    }

    /// Lets the parts of a step, one behind the other, be copied to a free place; gives the place, none where the step is
    /// dropped.
    pub fn send(&mut self, encoder: &mut CommandEncoder, parts: &[BufferSlice<'_>]) -> Option<usize> {
        let free = self.places.iter().position(|p| p.is(FREE));
        self.behind = free.is_none();
        let Some(free) = free else {
            self.tally.dropped += 1;
            return None;
        };
        let mut at = 0;
        for part in parts {
            let size = part.size();
            encoder.copy_buffer_to_buffer(part.buffer(), part.offset(), &self.places[free].buffer, at, size);
            at += size;
        }
        Some(free)
    }

    /// After the submission: asks for the place to be readable.
    pub fn ask(&mut self, place: usize) {
        self.tally.sent += 1;
        let place = &mut self.places[place];
        (place.number, place.since) = (self.tally.sent, Instant::now());
        // Relaxed: nothing else looks at it before the callback.
        place.state.store(UNDER_WAY, Ordering::Relaxed);
        let state = Arc::clone(&place.state);
        place.buffer.map_async(MapMode::Read, .., move |result| {
            // Release: pairs with the readers' acquire, so that they see the mapped bytes.
            state.store(if result.is_ok() { ARRIVED } else { FAILED }, Ordering::Release);
        });
    }

    /// For how long the oldest step that is on its way back has been; none where none is.
    pub fn waiting(&self) -> Option<Duration> {
        self.places.iter().filter(|p| p.is(UNDER_WAY)).map(|p| p.since.elapsed()).max()
    }

    /// Gives the bytes of the newest step that has arrived to `read`, unless a newer one was taken before, and frees all that
    /// have; false where none was given.
    pub fn take(&mut self, read: impl FnOnce(&[u8])) -> bool {
        let newer = |p: &StagingBuffer| p.is(ARRIVED) && p.number > self.newest;
        let newest = (0..PLACES).filter(|&k| newer(&self.places[k])).max_by_key(|&k| self.places[k].number);
        let mut taken = false;
        if let Some(k) = newest
            && let Ok(bytes) = self.places[k].buffer.get_mapped_range(..)
        {
            read(&bytes);
            taken = true;
            self.newest = self.places[k].number;
            self.tally.taken += 1;
        }
        for (k, place) in self.places.iter().enumerate() {
            match place.state.load(Ordering::Acquire) {
                ARRIVED => {
                    self.tally.dropped += u64::from(!taken || Some(k) != newest);
                    place.buffer.unmap();
                }
                FAILED => self.tally.dropped += 1,
                _ => continue,
            }
            // Relaxed: only this thread looks at free places.
            place.state.store(FREE, Ordering::Relaxed);
        }
        taken
    }
}
