//! A check, in debug builds, that the shares of a job run in the order of its phases.
//!
//! Unsafe code hands out data by the phase and the share that a worker is in. It is right only if no share of a phase runs beside one
//! of another phase, and if no share runs twice. The callers answer for that; this check finds one that does not keep it.

#[cfg(debug_assertions)]
use std::sync::atomic::Ordering::Relaxed;

#[cfg(debug_assertions)]
use crate::sync::AtomicU64;

/// The phase that is under way, with the shares of it that have begun and that have ended. Empty in release builds.
#[derive(Default)]
pub struct PhaseCheck {
    /// 16 times the phase, 4 times the shares that have begun (one bit each), the shares that have ended.
    #[cfg(debug_assertions)]
    under_way: AtomicU64,
}

/// A share that has begun; dropped as it ends, also by a panic.
pub struct RunningShare<'a> {
    #[cfg(debug_assertions)]
    check: &'a PhaseCheck,
    #[cfg(debug_assertions)]
    share: usize,
    #[cfg(not(debug_assertions))]
    _check: std::marker::PhantomData<&'a PhaseCheck>,
}

impl PhaseCheck {
    /// Begins a share of a phase, both counted from 0.
    ///
    /// # Panics
    /// In debug builds, where the share has begun before, or where a share of the phase before has not ended.
    #[cfg(debug_assertions)]
    pub fn begin(&self, phase: usize, share: usize) -> RunningShare<'_> {
        // Relaxed: the barriers between phases order what the shares do; the check only counts.
        let begun = self.under_way.fetch_update(Relaxed, Relaxed, |state| after_begin(state, phase, share));
        assert!(begun.is_ok(), "share {share} of phase {phase} began out of order ({begun:?})");
        RunningShare { check: self, share }
    }

    /// Begins a share of a phase, both counted from 0.
    #[cfg(not(debug_assertions))]
    #[inline(always)]
    pub fn begin(&self, _phase: usize, _share: usize) -> RunningShare<'_> {
        RunningShare { _check: std::marker::PhantomData }
    }
}

#[cfg(debug_assertions)]
impl Drop for RunningShare<'_> {
    fn drop(&mut self) {
        // Relaxed: as in `begin`.
        self.check.under_way.fetch_or(1 << self.share, Relaxed);
    }
}

/// The state once a share has begun; none where it may not begin.
#[cfg(debug_assertions)]
fn after_begin(state: u64, phase: usize, share: usize) -> Option<u64> {
    let (at, begun, ended) = (state >> 4, state >> 2 & 3, state & 3);
    let (phase, bit) = (phase as u64, 1 << share);
    if phase == at && begun & bit == 0 {
        Some(state | bit << 2)
    } else if phase == at + 1 && ended == 3 {
        Some(phase << 4 | bit << 2)
    } else {
        None
    }
}

#[cfg(all(test, debug_assertions))]
mod tests {
    use std::panic::{AssertUnwindSafe, catch_unwind};

    use super::*;

    #[test]
    fn phases_follow_each_other() {
        let check = PhaseCheck::default();
        for phase in 0..3 {
            let [first, second] = [1, 0].map(|share| check.begin(phase, share));
            drop(second);
            drop(first);
        }
        // One worker does one share after the other.
        (0..2).for_each(|share| drop(check.begin(3, share)));
    }

    #[test]
    fn shares_out_of_order_are_found() {
        let refused = |check: &PhaseCheck, phase, share| {
            catch_unwind(AssertUnwindSafe(|| drop(check.begin(phase, share)))).is_err()
        };
        let check = PhaseCheck::default();
        assert!(refused(&check, 1, 0), "a phase was left out");
        let running = check.begin(0, 0);
        drop(check.begin(0, 1));
        assert!(refused(&check, 1, 1), "a share of the phase before still runs");
        assert!(refused(&check, 0, 1), "it was done already");
        drop(running);
        drop(check.begin(1, 1));
        assert!(refused(&check, 0, 0), "its phase is over");
    }
}
