//! Counters of the system for the physics thread, from which the cause of a late step follows.
//!
//! Each step costs two system calls that touch no file: `getrusage(RUSAGE_THREAD)` for faults and lost cores, and the
//! thread's CPU clock. Together they take less than a microsecond. Linux states in `/proc/thread-self/schedstat` alone how long
//! the thread waited for a core while it was ready. The thread opens that file at its start. It reads the file only in the
//! time that a step leaves: ten times a second, and after late steps.

use toile_engine::frame_loop::event::{CounterSource, Counters, Event, EventKind, Miss};
use toile_engine::meter::PERIOD_NS;

use super::report::{Attributed, Cause};

/// Faults of one step from which on they are its cause: each takes one or two microseconds.
const MANY_FAULTS: u64 = 200;

/// Share of the period that a thread must have waited for a core for that to be the cause.
const LONG_WAIT_NS: u64 = PERIOD_NS / 8;

/// Share of the period that a step must have computed for that to be the cause.
const LONG_WORK_NS: u64 = PERIOD_NS * 3 / 4;

/// The calling thread's counters on Linux; nothing elsewhere.
#[derive(Debug, Default)]
pub struct ThreadAccount {
    #[cfg(target_os = "linux")]
    schedstat: Option<std::fs::File>,
    last: Counters,
}

impl ThreadAccount {
    /// Counters of whichever thread calls them first.
    pub fn new() -> Self {
        Self::default()
    }
}

#[cfg(target_os = "linux")]
impl CounterSource for ThreadAccount {
    fn begin(&mut self) {
        self.schedstat = std::fs::File::open("/proc/thread-self/schedstat").ok();
    }

    fn counters(&mut self) -> Counters {
        use nix::sys::resource::{UsageWho, getrusage};
        use nix::time::{ClockId, clock_gettime};
        if let Ok(usage) = getrusage(UsageWho::RUSAGE_THREAD) {
            self.last.preempted = usage.involuntary_context_switches() as u64;
            self.last.faults = (usage.minor_page_faults() + usage.major_page_faults()) as u64;
        }
        if let Ok(cpu) = clock_gettime(ClockId::CLOCK_THREAD_CPUTIME_ID) {
            self.last.cpu_ns = cpu.tv_sec() as u64 * 1_000_000_000 + cpu.tv_nsec() as u64;
        }
        self.last
    }

    fn waited_ns(&mut self) -> u64 {
        self.schedstat.as_ref().and_then(waited_ns).unwrap_or(0)
    }
}

/// Time that the thread of a file was ready and had no core (ns).
#[cfg(target_os = "linux")]
fn waited_ns(schedstat: &std::fs::File) -> Option<u64> {
    use std::os::unix::fs::FileExt;
    let mut text = [0; 96];
    let count = schedstat.read_at(&mut text, 0).ok()?;
    second_number(&text[..count])
}

#[cfg(not(target_os = "linux"))]
impl CounterSource for ThreadAccount {
    fn counters(&mut self) -> Counters {
        self.last
    }
}

/// The second of the numbers of a text.
#[cfg_attr(not(target_os = "linux"), expect(dead_code, reason = "only Linux has the text"))]
fn second_number(text: &[u8]) -> Option<u64> {
    std::str::from_utf8(text).ok()?.split_ascii_whitespace().nth(1)?.parse().ok()
}

/// Returns why a step was late. `before` is the cause of the step before, if that was late too. A delay that no counter of the step
/// explains has the cause [`Cause::Other`]: a timer, the firmware, or a hypervisor that ran another machine.
fn cause(miss: &Miss, before: Option<Cause>) -> Cause {
    let counted = &miss.counted;
    // It only began late because the one before ended late.
    if let Some(before) = before
        && miss.step_ns < LONG_WORK_NS
    {
        return before;
    }
    if counted.cpu_ns.min(miss.step_ns) > LONG_WORK_NS {
        Cause::Solver
    } else if counted.faults > MANY_FAULTS {
        Cause::PageFault
    } else if counted.preempted > 0 {
        Cause::Preempted
    } else {
        Cause::Other
    }
}

/// Adds up why steps were late, from the loop's events.
#[derive(Debug, Clone, Copy, Default)]
pub struct LatenessAttribution {
    /// Late steps whose cause is known, by cause.
    known: Attributed,
    /// Late steps that no counter explains, until the loop reports how long its thread waited for a core.
    open: u64,
    /// The last late step and its cause.
    before: Option<(u64, Cause)>,
    /// Steps that were dropped before one whose cause is not known yet.
    dropped: u64,
}

impl LatenessAttribution {
    /// Takes an event. Events that say nothing of late, dropped or waiting steps are passed over.
    pub fn take(&mut self, event: &Event) {
        match event.what {
            EventKind::Missed(miss) => {
                let before = self.before.filter(|(tick, _)| *tick + 1 == event.tick).map(|(_, cause)| cause);
                let cause = cause(&miss, before);
                // Steps that were dropped before this one have its cause.
                let steps = 1 + std::mem::take(&mut self.dropped);
                match cause {
                    Cause::Other => self.open += steps,
                    cause => self.known.add(cause, steps),
                }
                self.before = Some((event.tick, cause));
            }
            EventKind::Waited(ns) => {
                let cause = if ns > LONG_WAIT_NS { Cause::Preempted } else { Cause::Other };
                self.known.add(cause, std::mem::take(&mut self.open));
            }
            EventKind::Dropped(steps) => self.dropped += steps,
            _ => {}
        }
    }

    /// Late steps so far, by cause. Those that nothing explains yet count as [`Cause::Other`].
    pub fn attributed(&self) -> Attributed {
        let mut all = self.known;
        all.add(Cause::Other, self.open);
        all
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn miss(step_ms: u64, counted: Counters) -> Miss {
        Miss { total_ns: 9_000_000, late_ns: 0, step_ns: step_ms * 1_000_000, counted }
    }

    #[test]
    fn causes_are_told_apart() {
        let cpu = |ms: u64| Counters { cpu_ns: ms * 1_000_000, ..Counters::default() };
        assert_eq!(cause(&miss(9, cpu(9)), None), Cause::Solver);
        assert_eq!(cause(&miss(9, Counters { preempted: 1, ..cpu(2) }), None), Cause::Preempted);
        assert_eq!(cause(&miss(9, Counters { faults: 3_000, ..cpu(5) }), None), Cause::PageFault);
        assert_eq!(cause(&miss(9, cpu(2)), None), Cause::Other);
        assert_eq!(cause(&miss(2, cpu(2)), Some(Cause::Solver)), Cause::Solver, "still late from the one before");
        assert_eq!(cause(&miss(9, cpu(9)), Some(Cause::Other)), Cause::Solver, "late of its own");
        assert_eq!(second_number(b"8965 705528 2\n"), Some(705_528));
        assert_eq!(second_number(b""), None);
    }

    #[test]
    fn dropped_steps_have_the_cause_of_the_one_in_their_place() {
        let counted = Counters { cpu_ns: 9_000_000, ..Counters::default() };
        let mut sums = LatenessAttribution::default();
        let events = [(7, EventKind::Dropped(3)), (7, EventKind::Missed(miss(9, counted))), (8, EventKind::SensorLost)];
        let late_after = [
            (8, EventKind::Missed(miss(2, Counters::default()))),
            (20, EventKind::Missed(miss(2, Counters::default()))),
        ];
        for (tick, what) in events.into_iter().chain(late_after) {
            sums.take(&Event { tick, scheduled_ns: 0, what });
        }
        assert_eq!(sums.attributed(), Attributed { solver: 5, other: 1, ..Attributed::default() });
    }

    #[test]
    fn a_wait_for_a_core_explains_late_steps() {
        let mut sums = LatenessAttribution::default();
        let mut take = |tick, what| sums.take(&Event { tick, scheduled_ns: 0, what });
        let unexplained = EventKind::Missed(miss(2, Counters::default()));
        take(3, unexplained);
        take(4, unexplained);
        take(5, EventKind::Waited(7_000_000));
        take(20, unexplained);
        take(21, EventKind::Waited(1_000));
        assert_eq!(sums.attributed(), Attributed { preempted: 2, other: 1, ..Attributed::default() });
    }

    #[test]
    #[cfg(target_os = "linux")]
    fn a_thread_that_computes_is_seen_to_and_touching_memory_faults() {
        let mut account = ThreadAccount::new();
        account.begin();
        let before = account.counters();
        let block = std::hint::black_box(vec![1u8; 64 << 20]);
        let sum: u64 = block.iter().map(|b| u64::from(*b)).sum();
        let grown = account.counters().since(&before);
        assert_eq!(sum, 64 << 20);
        assert!(grown.cpu_ns > 1_000_000, "{grown:?}");
        assert!(grown.faults > 10, "{grown:?}");
    }
}
