//! Axes: from values to places between 0 and 1, and the values that are written beside them.

/// One axis of a chart.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Axis {
    /// Its label, with the unit.
    pub label: &'static str,
    /// Whether equal factors are equally long.
    pub log: bool,
    /// Least and largest value that is shown.
    pub range: [f64; 2],
}

/// Fewest decades for which powers of ten alone are written.
const SPARSE_DECADES: f64 = 2.5;

/// Ticks that a linear axis has at most.
const MOST_TICKS: f64 = 7.0;

impl Axis {
    /// An axis around some values, with a little room at both ends. What a logarithm cannot show is passed over.
    pub fn around(label: &'static str, log: bool, values: impl Iterator<Item = f64>) -> Self {
        let shown = values.filter(|v| v.is_finite() && (!log || *v > 0.0));
        let [low, high] = shown.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], v| [a.min(v), b.max(v)]);
        let range = match (low <= high, log) {
            (false, _) => [1.0, 10.0],
            (true, true) => [low / 1.3, high * 1.3],
            (true, false) => {
                let room = 0.05 * (high - low).max(1e-9 * high.abs().max(1.0));
                [low - room, high + room]
            }
        };
        Self { label, log, range }
    }

    /// Where a value lies, 0 at the least and 1 at the largest; nothing where it cannot be shown.
    pub fn place(&self, value: f64) -> Option<f64> {
        let [low, high] = self.range;
        let part = if self.log { (value / low).ln() / (high / low).ln() } else { (value - low) / (high - low) };
        (part.is_finite() && (-0.001..=1.001).contains(&part)).then_some(part)
    }

    /// Values that are written.
    pub fn ticks(&self) -> Vec<f64> {
        let [low, high] = self.range;
        if self.log {
            let decades = (high / low).log10();
            let steps: &[f64] = if decades >= SPARSE_DECADES { &[1.0] } else { &[1.0, 2.0, 5.0] };
            let powers = low.log10().floor() as i32..=high.log10().ceil() as i32;
            let all = powers.flat_map(|k| steps.iter().map(move |s| s * 10f64.powi(k)));
            return all.filter(|v| (low..=high).contains(v)).collect();
        }
        let rough = (high - low) / MOST_TICKS;
        let power = 10f64.powf(rough.log10().floor());
        let step = [1.0, 2.0, 5.0, 10.0].map(|s| s * power).into_iter().find(|s| *s >= rough).unwrap_or(rough);
        let [first, last] = [(low / step).ceil() as i64, (high / step).floor() as i64];
        (first..=last).map(|k| k as f64 * step).collect()
    }
}

/// A tick's value as it is written: with as few digits as it takes.
pub fn figure(value: f64) -> String {
    let size = value.abs();
    if value != 0.0 && !(1e-3..1e5).contains(&size) {
        return format!("{value:.0e}");
    }
    let text = format!("{value:.4}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}
