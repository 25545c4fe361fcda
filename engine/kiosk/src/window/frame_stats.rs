//! Frame statistics of the window: its adapter, the evenness of pictures, the time to the first one.

use std::time::Instant;

use toile_engine::meter::Meter;
use toile_fitting::live::report::Quantiles;

use crate::service::report::WindowReport;

/// Counted on the render thread.
#[derive(Debug)]
pub struct FrameStats {
    begun: Instant,
    first_ms: Option<f64>,
    last: Option<(Instant, Option<u64>)>,
    draw: Meter,
    between: Meter,
    jitter: Meter,
    /// Pictures that were presented.
    pub presented: u64,
    /// Pictures due and not drawn.
    pub rested: u64,
    /// Pictures for which the display gave no surface.
    pub refused: u64,
    /// Times that the graphics device was lost.
    pub lost: u64,
}

impl FrameStats {
    /// Of a program that was started then.
    pub fn new(begun: Instant) -> Self {
        Self {
            begun,
            first_ms: None,
            last: None,
            draw: Meter::new(),
            between: Meter::new(),
            jitter: Meter::new(),
            presented: 0,
            rested: 0,
            refused: 0,
            lost: 0,
        }
    }

    /// A picture whose painting began then was presented now.
    pub fn presented(&mut self, begun: Instant, now: Instant) {
        self.presented += 1;
        self.first_ms.get_or_insert_with(|| now.duration_since(self.begun).as_secs_f64() * 1e3);
        self.draw.add(now.duration_since(begun).as_nanos() as u64);
        let between = self.last.map(|(last, _)| now.duration_since(last).as_nanos() as u64);
        if let Some(ns) = between {
            self.between.add(ns);
            if let Some((_, Some(before))) = self.last {
                self.jitter.add(ns.abs_diff(before));
            }
        }
        self.last = Some((now, between));
    }

    /// A pause, such as a display that was off, is no jitter.
    pub fn paused(&mut self) {
        self.last = None;
    }

    /// The figures so far, with the adapter and the size of the display (pixels).
    pub fn report(&self, adapter: String, software: bool, size: [u32; 2]) -> WindowReport {
        WindowReport {
            adapter,
            software,
            size,
            first_picture_ms: self.first_ms.map(|ms| (ms * 10.0).round() / 10.0),
            presented: self.presented,
            rested: self.rested,
            refused: self.refused,
            lost: self.lost,
            draw_us: Quantiles::of(&self.draw),
            between_us: Quantiles::of(&self.between),
            jitter_us: Quantiles::of(&self.jitter),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    #[test]
    fn jitter_is_how_much_the_time_between_pictures_changes_and_a_pause_is_none() {
        let begun = Instant::now();
        let mut stats = FrameStats::new(begun);
        let at = |ms: u64| begun + Duration::from_millis(ms);
        for ms in [200, 216, 232, 258] {
            stats.presented(at(ms - 5), at(ms));
        }
        stats.paused();
        for ms in [9_000, 9_016] {
            stats.presented(at(ms - 5), at(ms));
        }
        let report = stats.report("a".into(), true, [2, 3]);
        assert_eq!((report.presented, report.first_picture_ms), (6, Some(200.0)));
        assert_eq!((report.between_us.count, report.jitter_us.count), (4, 2));
        // A meter keeps 1 % of a time.
        assert!((report.jitter_us.max - 10_000.0).abs() < 200.0 && report.between_us.max < 27_000.0);
    }
}
