//! Counters of the system for the physics thread, from which the cause of a late step follows.
//!
//! Each step costs two system calls that touch no file: `getrusage(RUSAGE_THREAD)` for faults and lost cores, and the
//! thread's CPU clock; together under a microsecond. How long the thread waited for a core while it was ready stands only in
//! `/proc/thread-self/schedstat`: it is read behind steps that were late already, and ten times a second in the time
//! that a step leaves.

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
    fn counters(&mut self, closely: bool) -> Counters {
        use nix::sys::resource::{UsageWho, getrusage};
        use nix::time::{ClockId, clock_gettime};
        if let Ok(usage) = getrusage(UsageWho::RUSAGE_THREAD) {
            self.last.preempted = usage.involuntary_context_switches() as u64;
            self.last.faults = (usage.minor_page_faults() + usage.major_page_faults()) as u64;
        }
        if let Ok(cpu) = clock_gettime(ClockId::CLOCK_THREAD_CPUTIME_ID) {
            self.last.cpu_ns = cpu.tv_sec() as u64 * 1_000_000_000 + cpu.tv_nsec() as u64;
        }
        if closely && let Some(waited) = self.waited() {
            self.last.waited_ns = waited;
        }
        self.last
    }
}

#[cfg(target_os = "linux")]
impl ThreadAccount {
    /// Time that the thread was ready and had no core (ns).
    fn waited(&mut self) -> Option<u64> {
        use std::os::unix::fs::FileExt;
        if self.schedstat.is_none() {
            self.schedstat = std::fs::File::open("/proc/thread-self/schedstat").ok();
        }
        let mut text = [0; 96];
        let count = self.schedstat.as_ref()?.read_at(&mut text, 0).ok()?;
        second_number(&text[..count])
    }
}

#[cfg(not(target_os = "linux"))]
impl CounterSource for ThreadAccount {
    fn counters(&mut self, _closely: bool) -> Counters {
        self.last
    }
}

/// The second of the numbers of a text.
#[cfg_attr(not(target_os = "linux"), expect(dead_code, reason = "only Linux has the text"))]
fn second_number(text: &[u8]) -> Option<u64> {
    std::str::from_utf8(text).ok()?.split_ascii_whitespace().nth(1)?.parse().ok()
}

/// Why a step was late; `before` is the cause of the step before, where that was late too. What is due to none of what is
/// counted is some other's: a timer, the firmware, a hypervisor that ran another machine.
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
    } else if counted.preempted > 0 || counted.waited_ns > LONG_WAIT_NS {
        Cause::Preempted
    } else {
        Cause::Other
    }
}

/// Adds up why steps were late, from what the loop tells.
#[derive(Debug, Clone, Copy, Default)]
pub struct LatenessAttribution {
    /// Late steps so far, by cause.
    pub attributed: Attributed,
    /// The last late step and its cause.
    before: Option<(u64, Cause)>,
    /// Steps that were dropped before one whose cause is not known yet.
    dropped: u64,
}

impl LatenessAttribution {
    /// Something happened; what is neither late nor dropped is passed over.
    pub fn take(&mut self, event: &Event) {
        match event.what {
            EventKind::Missed(miss) => {
                let before = self.before.filter(|(tick, _)| *tick + 1 == event.tick).map(|(_, cause)| cause);
                let cause = cause(&miss, before);
                // Steps that were dropped before this one have its cause.
                self.attributed.add(cause, 1 + std::mem::take(&mut self.dropped));
                self.before = Some((event.tick, cause));
            }
            EventKind::Dropped(steps) => self.dropped += steps,
            _ => {}
        }
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
        assert_eq!(cause(&miss(2, Counters { waited_ns: 7_000_000, ..cpu(2) }), None), Cause::Preempted);
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
        assert_eq!(sums.attributed, Attributed { solver: 5, other: 1, ..Attributed::default() });
    }

    #[test]
    #[cfg(target_os = "linux")]
    fn a_thread_that_computes_is_seen_to_and_touching_memory_faults() {
        let mut account = ThreadAccount::new();
        let before = account.counters(true);
        let block = std::hint::black_box(vec![1u8; 64 << 20]);
        let sum: u64 = block.iter().map(|b| u64::from(*b)).sum();
        let grown = account.counters(true).since(&before);
        assert_eq!(sum, 64 << 20);
        assert!(grown.cpu_ns > 1_000_000, "{grown:?}");
        assert!(grown.faults > 10, "{grown:?}");
    }
}
