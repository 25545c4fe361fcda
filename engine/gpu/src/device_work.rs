//! Work that a step asks of a device, and the device's time for it.

use toile_engine::cloth::step::program::METERED_STAGES;

/// Work of a step on a device.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct StepWork {
    /// Dispatches, one after the other.
    pub dispatches: u64,
    /// Bytes that invocations read and write, as if there were no cache; what few of them ask for, capsules and constants, left out.
    pub bytes: u64,
}

impl std::ops::AddAssign for StepWork {
    fn add_assign(&mut self, more: Self) {
        (self.dispatches, self.bytes) = (self.dispatches + more.dispatches, self.bytes + more.bytes);
    }
}

/// Time on the device.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct StageTimes {
    /// On each of [`METERED_STAGES`] (ns).
    pub stages_ns: [f64; METERED_STAGES.len()],
    /// From the beginning of the first pass to the end of the last (ns).
    pub whole_ns: f64,
}
