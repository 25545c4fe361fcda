//! Events that the loop reports to its caller through a bounded queue.

use super::quality_control::QualityChange;

/// Events that wait to be read: half a second in which every step has four.
pub const EVENTS: usize = 256;

/// Name of this capacity in reports and warnings.
pub const EVENTS_NAME: &str = "EVENTS (queue of the loop's events)";

/// A gap between two sensor frames from which on the sensor counts as lost (ns): 15 frames of 30 Hz.
pub const SENSOR_LOST_NS: u64 = 500_000_000;

/// What happened, in the step of this number.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Event {
    /// Number of the step.
    pub tick: u64,
    /// When the step was due (ns).
    pub scheduled_ns: u64,
    /// What happened in it.
    pub what: EventKind,
}

/// Kinds of event.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum EventKind {
    /// Quality control gave up quality, or gave it back.
    Quality(QualityChange),
    /// So many steps were given up before this one, because the thread woke too late.
    Dropped(u64),
    /// The step was not published within its period.
    Missed(Miss),
    /// Time for which the thread was ready to run but had no core (ns), since the loop last looked. It comes after late steps, from
    /// the first step that leaves enough time to look.
    Waited(u64),
    /// No sensor frame has come for [`SENSOR_LOST_NS`].
    SensorLost,
    /// It has come back.
    SensorBack,
    /// Another scene is stepped from this step on: its number.
    Changed(u64),
    /// A worker panicked; the garments kept their last places.
    Broken,
    /// A garment ended a step with NaN or infinity and was put back.
    RolledBack,
}

/// A missed deadline and what the thread's own counters say of it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Miss {
    /// From when the step was due until it was published (ns).
    pub total_ns: u64,
    /// From when it was due until it began (ns): woken late, or the step before was long.
    pub late_ns: u64,
    /// From begin to publication (ns).
    pub step_ns: u64,
    /// What the thread's counters grew by since the end of the step before.
    pub counted: Counters,
}

/// What a system counts of a thread; all 0 where it does not say.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Counters {
    /// Time on a core (ns).
    pub cpu_ns: u64,
    /// Times that its core was taken away.
    pub preempted: u64,
    /// Page faults: memory that had to be brought in first.
    pub faults: u64,
}

impl Counters {
    /// What they grew by since earlier ones.
    #[must_use]
    pub fn since(&self, earlier: &Self) -> Self {
        Self {
            cpu_ns: self.cpu_ns.saturating_sub(earlier.cpu_ns),
            preempted: self.preempted.saturating_sub(earlier.preempted),
            faults: self.faults.saturating_sub(earlier.faults),
        }
    }
}

/// Reads the calling thread's counters, allocating nothing.
pub trait CounterSource: Send {
    /// Opens the files of the calling thread's counters, before its first step.
    fn begin(&mut self) {}

    /// Returns the counters that cost no file access.
    fn counters(&mut self) -> Counters;

    /// Returns the time for which the thread was ready to run but had no core (ns). It may read a file, so the loop asks only in the
    /// time that a step leaves.
    fn waited_ns(&mut self) -> u64 {
        0
    }
}

/// Counts nothing: for systems without such counters, and for tests.
#[derive(Debug, Clone, Copy, Default)]
pub struct NoCounters;

impl CounterSource for NoCounters {
    fn counters(&mut self) -> Counters {
        Counters::default()
    }
}
