//! The machine's own jitter: a thread in the physics' place that does nothing, 120 times a second, metered the same way.

use std::thread;
use std::time::Duration;

use toile_base::limits::STEP_HZ;
use toile_engine::clock::{Clock, RealClock};
use toile_engine::frame_loop::ThreadLoop;
use toile_engine::frame_loop::schedule::{Due, Schedule};
use toile_engine::frame_loop::thread_roles::ThreadRole;
use toile_engine::frame_loop::threads::{self, Stop};
use toile_engine::meter::{Meter, PERIOD_NS};

use super::error::LatencyError;

/// A loop that does nothing but wake up in time.
#[derive(Debug)]
struct EmptyLoop {
    clock: RealClock,
    schedule: Schedule,
    late: Meter,
}

impl ThreadLoop for EmptyLoop {
    fn run_due(&mut self) -> Option<u64> {
        let now = self.clock.now_ns();
        match self.schedule.due(now) {
            Due::At(ns) => Some(ns),
            Due::Now(tick) => {
                (0..=tick.dropped).for_each(|k| self.late.add(tick.late_ns + k * PERIOD_NS));
                Some(self.schedule.next_ns())
            }
        }
    }
}

/// From when an empty step is due until its thread is awake, for so long.
///
/// # Errors
/// Where the system gives no thread.
pub fn measure(length: Duration) -> Result<Meter, LatencyError> {
    let clock = RealClock::default();
    let (stop, schedule) = (Stop::default(), Schedule::new(clock.now_ns() + PERIOD_NS, STEP_HZ));
    let life = threads::start(ThreadRole::Physics, EmptyLoop { clock, schedule, late: Meter::new() }, clock, &stop)?;
    thread::sleep(length);
    stop.now();
    life.join().map(|empty| empty.late).ok_or(LatencyError::Died("jitter"))
}
