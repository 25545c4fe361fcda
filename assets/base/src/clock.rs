//! Time: physics ticks and nanoseconds, both `u64`, converted without drift.
//!
//! A seconds counter in `f32` that advances by 1/120 s stops for good at 72.8 h; `u64` ticks last five billion years.

use crate::limits::STEP_HZ;

/// Nanoseconds in a second.
pub const SECOND_NS: u64 = 1_000_000_000;

const HZ: u64 = STEP_HZ as u64;

/// The first nanosecond of a tick: rounded up, so that [`ns_to_ticks`] gives the same tick back.
pub const fn ticks_to_ns(ticks: u64) -> u64 {
    (ticks / HZ) * SECOND_NS + ((ticks % HZ) * SECOND_NS).div_ceil(HZ)
}

/// The tick that is running at a time.
pub const fn ns_to_ticks(ns: u64) -> u64 {
    (ns / SECOND_NS) * HZ + (ns % SECOND_NS) * HZ / SECOND_NS
}

/// Seconds between two times (s), negative where `to` lies before `from`; for differences only, never a clock.
pub fn seconds_between(from_ns: u64, to_ns: u64) -> f32 {
    let difference = i128::from(to_ns) - i128::from(from_ns);
    (difference as f64 * 1e-9) as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_tick_returns_from_nanoseconds() {
        let long = 120 * 3600 * 24 * 365;
        for tick in (0..100_000).chain(long..long + 1000) {
            assert_eq!(ns_to_ticks(ticks_to_ns(tick)), tick);
            assert_eq!(ns_to_ticks(ticks_to_ns(tick + 1) - 1), tick);
        }
    }

    #[test]
    fn a_year_of_ticks_is_a_year_of_nanoseconds() {
        let year = 3600 * 24 * 365;
        assert_eq!(ticks_to_ns(year * HZ), year * SECOND_NS);
    }

    #[test]
    fn seconds_keep_their_sign() {
        assert_eq!(seconds_between(2 * SECOND_NS, SECOND_NS), -1.0);
        assert_eq!(seconds_between(u64::MAX - 500_000_000, u64::MAX), 0.5);
    }
}
