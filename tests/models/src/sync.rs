//! The models' counterpart of the engine's `sync`: loom's atomics, threads and cells. The model ends when a thread writes a cell
//! while another reads it.

use std::time::Duration;

pub use loom::sync::atomic::{AtomicBool, AtomicPtr, AtomicU64, AtomicUsize};
pub use loom::thread::{self, JoinHandle};

/// A model tries the pool with its helper.
pub const HAS_THREADS: bool = true;

/// One look, as more of them are the same to a model.
pub const LOOKS_BEFORE_TAKING: u32 = 1;

/// Lets the others run: without it a model of a waiting thread has no end.
pub fn pause(_looks: u32) {
    thread::yield_now();
}

/// A thread without work is tired at once: a model knows no time.
pub struct Idle;

impl Idle {
    /// Ignores the time: a model has none.
    pub fn until(_awake: Duration) -> Self {
        Self
    }

    /// True at once: a model has no time.
    pub fn is_over(&self, _looks: u32) -> bool {
        true
    }
}

/// A value that its users keep apart by other means, which the model checks.
pub struct Slot<T>(loom::cell::UnsafeCell<T>);

impl<T: Copy> Slot<T> {
    /// With a first value.
    pub fn new(value: T) -> Self {
        Self(loom::cell::UnsafeCell::new(value))
    }

    /// The value.
    ///
    /// # Safety
    /// No thread writes it meanwhile, and the last write happened before.
    pub unsafe fn read(&self) -> T {
        // SAFETY: the caller keeps all writes apart from this read. Otherwise loom's cell ends the model here.
        self.0.with(|value| unsafe { *value })
    }

    /// Puts another value there.
    ///
    /// # Safety
    /// No thread reads or writes it meanwhile, and all earlier reads and writes happened before.
    pub unsafe fn write(&self, new: T) {
        // SAFETY: the caller keeps all other accesses apart from this write. Otherwise loom's cell ends the model here.
        self.0.with_mut(|value| unsafe { *value = new });
    }
}
