//! Time as the loop sees it: nanoseconds of a monotonic clock, real or simulated.
//!
//! A look may take 30 ns, on any thread. Work that is scheduled against a simulated clock gives the same bits in every run.

use std::sync::Arc;
use std::sync::atomic::AtomicU64;
use std::sync::atomic::Ordering::Relaxed;
use std::thread;
use std::time::{Duration, Instant};

/// A monotonic clock in `u64` nanoseconds, which last 584 years.
pub trait Clock {
    /// Time now, since an origin of the clock's own (ns).
    fn now_ns(&self) -> u64;

    /// Waits until then, or longer: a system wakes no thread before its time, and often late.
    fn sleep_until(&self, ns: u64);
}

/// The system's monotonic clock, counted from where it was made. Copies agree.
#[derive(Debug, Clone, Copy)]
pub struct RealClock {
    origin: Instant,
    origin_ns: u64,
}

impl RealClock {
    /// A clock that shows so much now (ns): an uptime, to see whether anything depends on it.
    pub fn starting_at(origin_ns: u64) -> Self {
        Self { origin: Instant::now(), origin_ns }
    }
}

impl Default for RealClock {
    fn default() -> Self {
        Self::starting_at(0)
    }
}

impl Clock for RealClock {
    fn now_ns(&self) -> u64 {
        self.origin_ns + self.origin.elapsed().as_nanos() as u64
    }

    fn sleep_until(&self, ns: u64) {
        let now = self.now_ns();
        if ns > now {
            thread::sleep(Duration::from_nanos(ns - now));
        }
    }
}

/// A clock that stands still until it is moved: sleeping moves it, and work moves it by what it is said to cost. Copies
/// share their time.
///
/// Relaxed throughout: one thread plays all parts, one after the other.
#[derive(Debug, Clone, Default)]
pub struct SimClock {
    now: Arc<AtomicU64>,
    oversleep: Arc<AtomicU64>,
}

impl SimClock {
    /// A clock that shows this (ns).
    pub fn starting_at(ns: u64) -> Self {
        let clock = Self::default();
        clock.now.store(ns, Relaxed);
        clock
    }

    /// Work takes so long (ns).
    pub fn spend(&self, ns: u64) {
        self.now.fetch_add(ns, Relaxed);
    }

    /// The next sleep ends so much too late (ns).
    pub fn oversleep_once(&self, ns: u64) {
        self.oversleep.store(ns, Relaxed);
    }
}

impl Clock for SimClock {
    fn now_ns(&self) -> u64 {
        self.now.load(Relaxed)
    }

    fn sleep_until(&self, ns: u64) {
        if ns > self.now_ns() {
            let late = self.oversleep.swap(0, Relaxed);
            self.now.fetch_max(ns + late, Relaxed);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_simulated_clock_moves_only_when_told() {
        let clock = SimClock::starting_at(50);
        let copy = clock.clone();
        clock.spend(7);
        copy.sleep_until(40);
        assert_eq!(copy.now_ns(), 57, "what is past is not waited for");
        clock.oversleep_once(3);
        clock.sleep_until(60);
        clock.sleep_until(61);
        assert_eq!(copy.now_ns(), 63, "late once");
    }

    #[test]
    fn real_clock_never_goes_back_or_wakes_early() {
        let clock = RealClock::starting_at(414 * 86_400 * 1_000_000_000);
        let copy = clock;
        let before = clock.now_ns();
        clock.sleep_until(before + 2_000_000);
        assert!(copy.now_ns() >= before + 2_000_000);
    }
}
