//! The device's clock on the loop's: a stamp tells when a frame was taken better than its arrival does, as long as that clock
//! runs on.

/// How fast two clocks may drift apart (1): a quartz is off by 50 millionths, and this leaves room.
const DRIFT: f64 = 500e-6;

/// A device's clock that leads or lags by so much more than before has jumped (ns): no transfer takes as long.
const JUMP_NS: i64 = 500_000_000;

/// Puts stamps of a device on the loop's clock: the device's time plus the least delay that was seen, which may grow as slowly as
/// clocks drift.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct DeviceClock {
    /// From the device's clock to the loop's (ns), and when it was last corrected (ns).
    offset: Option<(i64, u64)>,
    /// The last device stamp, and what it became (ns).
    last: Option<(u64, u64)>,
    /// Times that the device's clock jumped.
    pub jumps: u64,
}

impl DeviceClock {
    /// When a frame that arrived then (ns) was taken, on the loop's clock (ns). Later than the frame before, and no later than its
    /// arrival as long as frames do not arrive at once.
    pub fn stamp(&mut self, device_ns: u64, arrived_ns: u64) -> u64 {
        let seen = arrived_ns.wrapping_sub(device_ns) as i64;
        let back = self.last.is_some_and(|(device, _)| device_ns < device);
        // A camera without a clock, or one whose clock stands still: its frames count from their arrival.
        let still = self.last.is_some_and(|(device, _)| device_ns == device);
        let offset = match self.offset {
            Some(_) if still => seen,
            Some((offset, _)) if back || seen.saturating_sub(offset).abs() > JUMP_NS => {
                self.jumps += 1;
                seen
            }
            Some((offset, then)) => {
                let drift = (arrived_ns.saturating_sub(then) as f64 * DRIFT) as i64;
                seen.min(offset.saturating_add(drift))
            }
            None => seen,
        };
        self.offset = Some((offset, arrived_ns));
        let stamp = device_ns.wrapping_add_signed(offset);
        let after = self.last.map_or(0, |(_, stamp)| stamp + 1);
        let stamp = stamp.clamp(after, arrived_ns.max(after));
        self.last = Some((device_ns, stamp));
        stamp
    }

    /// Forgets the device's clock: it was opened anew.
    pub fn restart(&mut self) {
        self.offset = None;
        self.last = self.last.map(|(_, stamp)| (0, stamp));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MS: u64 = 1_000_000;

    #[test]
    fn frames_that_arrive_late_keep_the_time_at_which_they_were_taken() {
        let mut clock = DeviceClock::default();
        // Each 33 ms by the device, each delayed by 5 ms and some of them by far more.
        let delays = [5, 5, 30, 5, 90, 6, 5];
        let stamps: Vec<u64> =
            (0..).zip(delays).map(|(i, d)| clock.stamp(i * 33 * MS, (1_000 + i * 33 + d) * MS)).collect();
        for (i, stamp) in (0..).zip(&stamps) {
            assert!(stamp.abs_diff((1_005 + i * 33) * MS) < MS, "{stamps:?}");
        }
        assert_eq!(clock.jumps, 0);
    }

    #[test]
    fn a_clock_that_jumps_back_or_ahead_is_believed_again_from_the_next_frame_on() {
        let mut clock = DeviceClock::default();
        let device = [0, 33, 66, 5, 38, 86_400_071, 86_400_104];
        let stamps: Vec<u64> = (0..).zip(device).map(|(i, d)| clock.stamp(d * MS, (500 + i * 33) * MS) / MS).collect();
        assert_eq!(stamps, [500, 533, 566, 599, 632, 665, 698]);
        assert_eq!(clock.jumps, 2);
    }

    #[test]
    fn clocks_that_drift_are_followed() {
        let mut clock = DeviceClock::default();
        // A device that loses 100 millionths: after an hour it is .36 s late, and no frame looks old for it.
        let mut off = 0;
        for i in 0..108_000u64 {
            let arrived = 1_000 * MS + i * 33_333_333;
            let device = (i as f64 * 33_333_333.0 * (1.0 - 100e-6)) as u64;
            off = arrived - clock.stamp(device, arrived);
        }
        assert!(off < MS && clock.jumps == 0, "{off}");
    }

    #[test]
    fn frames_of_a_camera_without_a_clock_count_from_their_arrival() {
        let mut clock = DeviceClock::default();
        let stamps: Vec<u64> = (0..5).map(|i| clock.stamp(0, (1_000 + i * 33) * MS) / MS).collect();
        assert_eq!(stamps, [1_000, 1_033, 1_066, 1_099, 1_132]);
        assert_eq!(clock.jumps, 0);
    }

    #[test]
    fn no_stamp_is_older_than_the_one_before() {
        let mut clock = DeviceClock::default();
        let pairs = [(0, 100), (0, 100), (50, 100), (10, 101), (u64::MAX, 102), (0, 103)];
        let stamps: Vec<u64> = pairs.map(|(device, arrived)| clock.stamp(device, arrived)).to_vec();
        assert!(stamps.windows(2).all(|w| w[0] < w[1]), "{stamps:?}");
    }
}
