//! Distributions of times, in histograms of a fixed size.

use hdrhistogram::Histogram;

/// Longest time that a meter tells apart from a longer one (ns).
pub const LONGEST_NS: u64 = 10_000_000_000;

/// Digits that a meter keeps of a value: 1 % of it.
const DIGITS: u8 = 2;

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
}
