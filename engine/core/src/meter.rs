//! Meters: how long the stages of a step take, always on, against what each of them may take.
//!
//! Reads: durations. Writes: histograms of a fixed size, made at load.
//! Budget: 10 ns a value; 24 KiB a meter. Thread: the one whose stages are metered.

use hdrhistogram::Histogram;
use toile_assets::limits::STEP_HZ;

/// Time between two steps (ns), rounded down.
pub const PERIOD_NS: u64 = 1_000_000_000 / STEP_HZ as u64;

/// Longest time that a meter tells apart from a longer one (ns).
pub const LONGEST_NS: u64 = 10_000_000_000;

/// Digits that a meter keeps of a value: 1 % of it.
const DIGITS: u8 = 2;

/// A stage of a step and what it may take.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct StageBudget {
    /// Its name, as reports have it.
    pub name: &'static str,
    /// What it may take in a step (us).
    pub budget_us: u64,
}

/// The stages of a step, in their order. Together they may take half of the step of 8,333 us, so that one late wake-up or
/// one step of twice the usual length is still in time.
pub const STAGES: [StageBudget; 6] = [
    // The newest joints, and where they are at the step's own time.
    StageBudget { name: "intake", budget_us: 10 },
    // Joint rotations within limits, and bone matrices.
    StageBudget { name: "pose", budget_us: 60 },
    // 15,000 vertices.
    StageBudget { name: "skin", budget_us: 150 },
    // Spheres and capsules.
    StageBudget { name: "place", budget_us: 10 },
    // All garments of an outfit.
    StageBudget { name: "cloth", budget_us: 3_700 },
    // Copies into the snapshot.
    StageBudget { name: "publish", budget_us: 100 },
];

/// Place of each stage in [`STAGES`].
pub const INTAKE: usize = 0;
/// Place of this stage in [`STAGES`].
pub const POSE: usize = 1;
/// Place of this stage in [`STAGES`].
pub const SKIN: usize = 2;
/// Place of this stage in [`STAGES`].
pub const PLACE: usize = 3;
/// Place of this stage in [`STAGES`].
pub const CLOTH: usize = 4;
/// Place of this stage in [`STAGES`].
pub const PUBLISH: usize = 5;

/// What a whole step may take (us): the sum of its stages.
pub const STEP_BUDGET_US: u64 = {
    let (mut sum, mut i) = (0, 0);
    while i < STAGES.len() {
        sum += STAGES[i].budget_us;
        i += 1;
    }
    sum
};

const _: () = assert!(STEP_BUDGET_US * 1_000 * 2 <= PERIOD_NS, "the stages take more than half of a step");

/// A distribution of times.
#[derive(Debug, Clone)]
pub struct Meter(Histogram<u64>);

impl Meter {
    /// Nothing metered yet. At load.
    pub fn new() -> Self {
        // Constants that the histogram accepts.
        Self(Histogram::new_with_bounds(1, LONGEST_NS, DIGITS).expect("constant bounds are valid"))
    }

    /// Adds a time (ns); one beyond [`LONGEST_NS`] counts as that.
    pub fn add(&mut self, ns: u64) {
        self.0.saturating_record(ns.min(LONGEST_NS));
    }

    /// The distribution (ns).
    pub fn histogram(&self) -> &Histogram<u64> {
        &self.0
    }

    /// Forgets all times.
    pub fn clear(&mut self) {
        self.0.reset();
    }
}

impl Default for Meter {
    fn default() -> Self {
        Self::new()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_meter_keeps_one_percent_of_every_time_and_its_size() {
        let mut meter = Meter::new();
        for ns in [1, 900, 8_333_333, 39_000_000, u64::MAX] {
            meter.add(ns);
        }
        let h = meter.histogram();
        assert_eq!((h.len(), h.max() >= LONGEST_NS), (5, true));
        let median = h.value_at_quantile(0.5) as f64;
        assert!((median / 8_333_333.0 - 1.0).abs() < 0.01, "{median}");
        assert!(h.distinct_values() * 8 <= 40 * 1024, "{} counters", h.distinct_values());
        meter.clear();
        assert_eq!(meter.histogram().len(), 0);
    }

    #[test]
    fn places_are_those_of_the_names() {
        let places = [INTAKE, POSE, SKIN, PLACE, CLOTH, PUBLISH];
        assert_eq!(places.map(|i| STAGES[i].name), ["intake", "pose", "skin", "place", "cloth", "publish"]);
    }
}
