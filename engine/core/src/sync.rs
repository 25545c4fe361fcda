//! What the workers of a step synchronise by: the standard library's atomics and threads, in one place, so that the models of the
//! hand-offs (tests/models) put others in their place that try every order in which two threads can run.

use std::cell::UnsafeCell;
use std::hint::spin_loop;
use std::time::{Duration, Instant};

pub use std::sync::atomic::{AtomicBool, AtomicPtr, AtomicU64, AtomicUsize};
pub use std::thread::{self, JoinHandle};

/// Whether a pool may have a helper thread.
pub const HAS_THREADS: bool = cfg!(feature = "threads");

/// Looks at the other's progress before the caller takes over a share that was not begun: about 1 us, six times the
/// duration of a barrier.
pub const LOOKS_BEFORE_TAKING: u32 = 64;

/// Looks before a waiting thread offers its core to others at every further look: about 15 us. On a machine whose cores
/// are all busy the other worker may be waiting for this very core.
const LOOKS_BEFORE_YIELDING: u32 = 1024;

/// Looks between two looks at the clock.
const LOOKS_A_CLOCK: u32 = 64;

/// Waits a moment: longer, and generously, after many looks.
pub fn pause(looks: u32) {
    if looks < LOOKS_BEFORE_YIELDING { spin_loop() } else { thread::yield_now() }
}

/// How long a thread without work has been awake.
pub struct Idle(Instant);

impl Idle {
    /// From now on, for so long.
    pub fn until(awake: Duration) -> Self {
        Self(Instant::now() + awake)
    }

    /// Whether that time is over; looks at the clock only now and then.
    pub fn is_over(&self, looks: u32) -> bool {
        looks.is_multiple_of(LOOKS_A_CLOCK) && Instant::now() >= self.0
    }
}

/// A value that its users keep apart by other means.
pub struct Slot<T>(UnsafeCell<T>);

impl<T: Copy> Slot<T> {
    /// With a first value.
    pub fn new(value: T) -> Self {
        Self(UnsafeCell::new(value))
    }

    /// The value.
    ///
    /// # Safety
    /// No thread writes it meanwhile, and the last write happened before.
    pub unsafe fn read(&self) -> T {
        // SAFETY: the caller keeps all writes apart from this read, as `# Safety` asks, so the copy is of a whole value.
        unsafe { *self.0.get() }
    }

    /// Puts another value there.
    ///
    /// # Safety
    /// No thread reads or writes it meanwhile, and all earlier reads and writes happened before.
    pub unsafe fn write(&self, value: T) {
        // SAFETY: the caller keeps all other accesses apart from this write, as `# Safety` asks. `T` is `Copy`, so nothing is dropped.
        unsafe { *self.0.get() = value };
    }
}
