//! Results of a run of the loop, as reports have them.

use serde::Serialize;
use toile_engine::frame_loop::queue::Capacity;
use toile_engine::frame_loop::thread_roles::RolePlacement;
use toile_engine::meter::Meter;

/// A distribution of times (us).
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct Quantiles {
    /// Median time of a step or stage (us).
    pub p50: f64,
    /// 99th percentile (us).
    pub p99: f64,
    /// 99.9th percentile (us).
    pub p999: f64,
    /// Longest time (us).
    pub max: f64,
    /// Number of times that were measured.
    pub count: u64,
}

impl Quantiles {
    /// The distribution that a meter holds.
    pub fn of(meter: &Meter) -> Self {
        let h = meter.histogram();
        let us = |ns: u64| (ns as f64 * 1e-2).round() * 0.1;
        let at = |q: f64| us(h.value_at_quantile(q).min(h.max()));
        Self { p50: at(0.5), p99: at(0.99), p999: at(0.999), max: us(h.max()), count: h.len() }
    }
}

/// Why a step was late.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Cause {
    /// Its core was taken away, or none was free.
    Preempted,
    /// Memory was not there yet.
    PageFault,
    /// The step itself computed for too long.
    Solver,
    /// None of what is counted: a timer, the firmware, a hypervisor.
    Other,
}

/// Late steps by their causes, the dropped ones included.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
pub struct Attributed {
    /// Steps whose thread was preempted: [`Cause::Preempted`].
    pub preempted: u64,
    /// Steps with page faults: [`Cause::PageFault`].
    pub page_fault: u64,
    /// Steps whose solve took long: [`Cause::Solver`].
    pub solver: u64,
    /// Steps that are late for no known cause: [`Cause::Other`].
    pub other: u64,
}

impl Attributed {
    /// Adds so many of a cause.
    pub fn add(&mut self, cause: Cause, count: u64) {
        *match cause {
            Cause::Preempted => &mut self.preempted,
            Cause::PageFault => &mut self.page_fault,
            Cause::Solver => &mut self.solver,
            Cause::Other => &mut self.other,
        } += count;
    }
}

/// Where a thread ran.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct ThreadPlacement {
    /// Name of the thread.
    pub thread: &'static str,
    /// The core that it was pinned to.
    pub core: Option<usize>,
    /// Real-time priority of the thread.
    pub priority: Option<u8>,
    /// What it did not get, and the cure.
    pub refused: Vec<String>,
}

impl From<RolePlacement> for ThreadPlacement {
    fn from(p: RolePlacement) -> Self {
        Self { thread: p.role.name(), core: p.core, priority: p.priority, refused: p.refused }
    }
}

/// How full something bounded was.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct QueueUse {
    /// Name of the constant that bounds it, and what it bounds in brackets.
    pub constant: &'static str,
    /// The most that it can hold.
    pub bound: usize,
    /// The most that was in it.
    pub high_water: usize,
    /// Number of entries that did not fit.
    pub lost: u64,
}

impl From<Capacity> for QueueUse {
    fn from(c: Capacity) -> Self {
        Self { constant: c.constant, bound: c.bound, high_water: c.high_water, lost: c.lost }
    }
}
