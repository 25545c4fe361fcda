//! A histogram of times over a logarithmic axis: bars as high as the logarithm of their counts, so that a single late one
//! is seen.

use super::axis::Axis;
use super::{Anchor, BLACK, Drawing, Mark, PALE, RULE, SERIES_COLOURS};

/// Times and how many were near them.
#[derive(Debug, Clone, PartialEq)]
pub struct Histogram<'a> {
    /// Title above the chart.
    pub title: &'a str,
    /// Upper bound (us) and count of each bar.
    pub bars: &'a [(f64, u64)],
    /// Bars a decade.
    pub bars_per_decade: f64,
    /// What the time may be at most (us), where it has a budget.
    pub budget_us: Option<f64>,
}

/// Shortest and longest time (us): all histograms have the same axis.
const RANGE_US: [f64; 2] = [1.0, 1_000_000.0];

/// Width and height (px), and the room at the left, the right, the top and the bottom.
const SIZE: [f64; 2] = [720.0, 150.0];
const ROOM: [f64; 4] = [60.0, 20.0, 26.0, 30.0];

impl Histogram<'_> {
    /// The histogram laid out.
    pub fn draw(&self) -> Drawing {
        let ([width, height], [left, right, top, bottom]) = (SIZE, ROOM);
        let axis = Axis { label: "us", log: true, range: RANGE_US };
        let span = width - left - right;
        let across = |us: f64| left + span * axis.place(us.clamp(RANGE_US[0], RANGE_US[1])).unwrap_or(0.0);
        let floor = height - bottom;
        let most = self.bars.iter().map(|b| b.1).max().unwrap_or(1).max(10) as f64;
        let up = |count: f64| floor - (floor - top) * ((1.0 + count).ln() / (1.0 + most).ln());
        let mut marks = vec![Mark::text([left, 12.0], Anchor::Left, self.title)];
        for us in axis.ticks() {
            marks.push(Mark::line([across(us), top], [across(us), floor], PALE));
            marks.push(Mark::text([across(us), floor + 14.0], Anchor::Middle, time(us)));
        }
        let bar = span / (RANGE_US[1] / RANGE_US[0]).log10() / self.bars_per_decade;
        for (us, count) in self.bars {
            let at = [across(*us) - bar, up(*count as f64)];
            let hint = Some(format!("up to {us:.1} us: {count}"));
            marks.push(Mark::Box { at, size: [bar - 1.0, floor - at[1]], colour: SERIES_COLOURS[0], hint });
        }
        if let Some(us) = self.budget_us {
            let points = vec![[across(us), top], [across(us), floor]];
            marks.push(Mark::Line { points, colour: RULE, width: 1.5, dashed: true });
            marks.push(Mark::text([across(us), 12.0], Anchor::Middle, format!("budget {us} us")));
        }
        marks.push(Mark::line([left, floor], [width - right, floor], BLACK));
        marks.push(Mark::text([left - 6.0, top + 4.0], Anchor::Right, format!("{most:.0}")));
        Drawing { size: SIZE.map(|s| s as u32), marks }
    }
}

/// A time as its axis says it.
fn time(us: f64) -> String {
    match us {
        ..1e3 => format!("{us} us"),
        ..1e6 => format!("{} ms", us / 1e3),
        _ => format!("{} s", us / 1e6),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plot::svg;

    #[test]
    fn a_single_late_one_is_seen() {
        let bars = [(100.0, 10_000), (10_000.0, 1)];
        let drawing = Histogram { title: "step", bars: &bars, bars_per_decade: 12.0, budget_us: Some(4_000.0) }.draw();
        let heights: Vec<f64> = drawing
            .marks
            .iter()
            .filter_map(|m| if let Mark::Box { size, .. } = m { Some(size[1]) } else { None })
            .collect();
        assert!(heights.len() == 2 && heights[1] > 5.0 && heights[0] > heights[1], "{heights:?}");
        let text = svg::text(&drawing);
        for words in ["up to 10000.0 us: 1", "budget 4000 us", "100 ms"] {
            assert!(text.contains(words), "{words} is not in {text}");
        }
    }
}
