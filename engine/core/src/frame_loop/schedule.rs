//! Schedule: the step that is due, its delay, and the number of dropped steps if too many are due.

use toile_base::clock::SECOND_NS;

/// Most steps that a late wake-up makes up for: 33 ms of a body's motion. More would take time from the next steps too,
/// and a shopper before a mirror wants to see the present rather than the past.
pub const MOST_CATCH_UP: u64 = 4;

/// Times at a fixed rate, on a clock in ns. Counted in ticks, so that no error accumulates.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Schedule {
    origin_ns: u64,
    hz: u64,
    /// The next tick, counted from the origin.
    next: u64,
    dropped: u64,
}

/// Answer of a schedule.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Due {
    /// Nothing is due before this time (ns).
    At(u64),
    /// This tick is due now.
    Now(Tick),
}

/// One tick that is due.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Tick {
    /// When it was due (ns).
    pub scheduled_ns: u64,
    /// When the one after it is (ns).
    pub next_ns: u64,
    /// How late it is (ns).
    pub late_ns: u64,
    /// Ticks before it that were given up.
    pub dropped: u64,
}

impl Schedule {
    /// A first tick at the origin (ns), then so many a second.
    pub fn new(origin_ns: u64, hz: u32) -> Self {
        Self { origin_ns, hz: u64::from(hz), next: 0, dropped: 0 }
    }

    /// What is due at a time. A tick that is given out is not given out again.
    pub fn due(&mut self, now_ns: u64) -> Due {
        let at = self.time(self.next);
        if now_ns < at {
            return Due::At(at);
        }
        let behind = self.tick(now_ns) - self.next;
        let dropped = behind.saturating_sub(MOST_CATCH_UP);
        self.next += dropped;
        self.dropped += dropped;
        let scheduled_ns = self.time(self.next);
        self.next += 1;
        let (next_ns, late_ns) = (self.time(self.next), now_ns - scheduled_ns);
        Due::Now(Tick { scheduled_ns, next_ns, late_ns, dropped })
    }

    /// When the next tick is due (ns).
    pub fn next_ns(&self) -> u64 {
        self.time(self.next)
    }

    /// Ticks given up so far.
    pub fn dropped(&self) -> u64 {
        self.dropped
    }

    /// Time of a tick: rounded up, so that [`Self::tick`] gives the same back.
    fn time(&self, tick: u64) -> u64 {
        self.origin_ns + tick / self.hz * SECOND_NS + (tick % self.hz * SECOND_NS).div_ceil(self.hz)
    }

    /// The tick that is running at a time.
    fn tick(&self, ns: u64) -> u64 {
        let ns = ns - self.origin_ns;
        ns / SECOND_NS * self.hz + ns % SECOND_NS * self.hz / SECOND_NS
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PERIOD: u64 = 8_333_334;

    fn now(schedule: &mut Schedule, ns: u64) -> Tick {
        match schedule.due(ns) {
            Due::Now(tick) => tick,
            Due::At(at) => panic!("nothing due at {ns} before {at}"),
        }
    }

    #[test]
    fn a_year_of_ticks_is_a_year_and_none_comes_early_or_twice() {
        let day = 86_400 * SECOND_NS;
        for uptime in [0, 3 * day, 50 * day, 414 * day] {
            let mut schedule = Schedule::new(uptime, 120);
            for tick in 0..1_000 {
                let at = schedule.next_ns();
                assert_eq!(at, uptime + (tick * SECOND_NS).div_ceil(120));
                if tick > 0 {
                    assert_eq!(schedule.due(at - 1), Due::At(at));
                }
                let due = now(&mut schedule, at);
                assert_eq!((due.scheduled_ns, due.late_ns, due.dropped), (at, 0, 0));
                assert_eq!(schedule.due(at), Due::At(due.next_ns));
            }
        }
        let mut schedule = Schedule::new(0, 120);
        schedule.next = 365 * 86_400 * 120;
        assert_eq!(schedule.next_ns(), 365 * day);
    }

    #[test]
    fn a_late_wake_up_makes_up_for_some_steps_and_drops_the_rest() {
        let mut schedule = Schedule::new(0, 120);
        now(&mut schedule, 0);
        // Ticks 1 to 3 are due; all are made up for.
        let late = 3 * PERIOD + 10;
        let times: Vec<u64> = (0..3).map(|_| now(&mut schedule, late).scheduled_ns).collect();
        assert_eq!(times, [8_333_334, 16_666_667, 25_000_000]);
        assert_eq!((schedule.dropped(), matches!(schedule.due(late), Due::At(_))), (0, true));
        // Then a second is lost: 120 steps are due, of which the last five are made.
        let late = late + SECOND_NS;
        let first = now(&mut schedule, late);
        assert_eq!(first.dropped, 120 - 1 - MOST_CATCH_UP);
        let rest = (0..MOST_CATCH_UP).map(|_| now(&mut schedule, late)).inspect(|t| assert_eq!(t.dropped, 0)).last();
        assert!(rest.unwrap().late_ns < PERIOD && matches!(schedule.due(late), Due::At(_)));
        assert_eq!(schedule.dropped(), 115);
    }

    #[test]
    fn steps_that_are_always_too_long_run_late_by_a_bound() {
        let (mut schedule, mut clock, mut steps) = (Schedule::new(0, 120), 0, 0);
        while clock < 10 * SECOND_NS {
            let tick = now(&mut schedule, clock);
            assert!(tick.late_ns < (MOST_CATCH_UP + 1) * PERIOD);
            clock += 2 * PERIOD;
            steps += 1;
        }
        assert_eq!(steps, 600, "each step took the time of two");
        assert!(schedule.dropped() + steps + MOST_CATCH_UP + 2 >= 1_200, "{} dropped", schedule.dropped());
    }
}
