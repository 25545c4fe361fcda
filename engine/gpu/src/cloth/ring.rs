//! Ring: what the GPU has made comes back a frame late, and is dropped rather than waited for.

use std::sync::Arc;
use std::sync::atomic::{AtomicU8, Ordering};

use wgpu::{Buffer, BufferDescriptor, BufferSlice, BufferUsages, CommandEncoder, MapMode};

/// Places to come back to: one that is read, one on its way, one to spare for a late driver.
const PLACES: usize = 3;

/// States of a place.
const FREE: u8 = 0;
const UNDER_WAY: u8 = 1;
const ARRIVED: u8 = 2;
const FAILED: u8 = 3;

/// Staging buffers in turn.
#[derive(Debug)]
pub struct Ring {
    places: [(Buffer, Arc<AtomicU8>, u64); PLACES],
    /// Steps that were sent, came back, and were dropped because no place was free.
    pub tally: Tally,
}

/// What became of the steps.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Tally {
    /// Sent to come back.
    pub sent: u64,
    /// Came back and were taken.
    pub taken: u64,
    /// Were not sent, because no place was free, or came back older than one that had been taken.
    pub dropped: u64,
}

impl Ring {
    /// For so many bytes a step.
    pub fn new(device: &wgpu::Device, bytes: u64) -> Self {
        let place = || {
            let usage = BufferUsages::COPY_DST | BufferUsages::MAP_READ;
            let descriptor =
                BufferDescriptor { label: Some("back"), size: bytes.max(16), usage, mapped_at_creation: false };
            (device.create_buffer(&descriptor), Arc::new(AtomicU8::new(FREE)), 0)
        };
        Self { places: [place(), place(), place()], tally: Tally::default() }
    }

    /// Lets the parts of a step, one behind the other, be copied to a free place; gives the place, none where the step is
    /// dropped.
    pub fn send(&mut self, encoder: &mut CommandEncoder, parts: &[BufferSlice<'_>]) -> Option<usize> {
        // Acquire: pairs with the callback's release, after which the buffer is ours again.
        let Some(free) = self.places.iter().position(|p| p.1.load(Ordering::Acquire) == FREE) else {
            self.tally.dropped += 1;
            return None;
        };
        let mut at = 0;
        for part in parts {
            let size = part.size();
            encoder.copy_buffer_to_buffer(part.buffer(), part.offset(), &self.places[free].0, at, size);
            at += size;
        }
        Some(free)
    }

    /// After the submission: asks for the place to be readable.
    pub fn ask(&mut self, place: usize) {
        self.tally.sent += 1;
        let (buffer, state, number) = &mut self.places[place];
        *number = self.tally.sent;
        // Relaxed: nothing else looks at it before the callback.
        state.store(UNDER_WAY, Ordering::Relaxed);
        let state = Arc::clone(state);
        buffer.map_async(MapMode::Read, .., move |result| {
            // Release: what was mapped is seen by whoever sees this.
            state.store(if result.is_ok() { ARRIVED } else { FAILED }, Ordering::Release);
        });
    }

    /// Gives the bytes of the newest step that has arrived to `read`, and frees all that have; false where none has.
    pub fn take(&mut self, read: impl FnOnce(&[u8])) -> bool {
        // Acquire: see above.
        let arrived = |p: &(Buffer, Arc<AtomicU8>, u64)| p.1.load(Ordering::Acquire) == ARRIVED;
        let newest = (0..PLACES).filter(|&k| arrived(&self.places[k])).max_by_key(|&k| self.places[k].2);
        let mut taken = false;
        if let Some(k) = newest
            && let Ok(bytes) = self.places[k].0.get_mapped_range(..)
        {
            read(&bytes);
            taken = true;
            self.tally.taken += 1;
        }
        for (k, place) in self.places.iter().enumerate() {
            match place.1.load(Ordering::Acquire) {
                ARRIVED => {
                    self.tally.dropped += u64::from(Some(k) != newest);
                    place.0.unmap();
                }
                FAILED => {}
                _ => continue,
            }
            // Relaxed: only this thread looks at free places.
            place.1.store(FREE, Ordering::Relaxed);
        }
        taken
    }
}
