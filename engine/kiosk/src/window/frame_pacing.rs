//! Frame pacing: the time of the next picture. A graphics card draws each time that one is due; a driver that draws on the processor is
//! held to a share of its core, so that the physics' worker and the sensor, which live there too, find it free.

use std::time::{Duration, Instant};

/// Share of its core that drawing on the processor may take.
const SOFTWARE_SHARE: f64 = 0.5;

/// Longest time between two pictures that were drawn on the processor: a finger wants its answer.
const LONGEST: Duration = Duration::from_millis(250);

/// Time between two looks at a hidden window.
const HIDDEN: Duration = Duration::from_millis(200);

/// Decides when the next picture may be drawn.
#[derive(Debug, Default)]
pub struct FramePacer {
    due: Option<Instant>,
}

impl FramePacer {
    /// Whether a picture may be drawn.
    pub fn is_due(&self, now: Instant) -> bool {
        self.due.is_none_or(|due| now >= due)
    }

    /// A picture took from `begun` to `now`; a renderer on the processor rests in proportion.
    pub fn drawn(&mut self, begun: Instant, now: Instant, software: bool) {
        let took = now.duration_since(begun);
        self.due = software.then(|| now + took.mul_f64(1.0 / SOFTWARE_SHARE - 1.0).min(LONGEST));
    }

    /// The window is hidden.
    pub fn hidden(&mut self, now: Instant) {
        self.due = Some(now + HIDDEN);
    }

    /// The screen was touched: the answer does not wait.
    pub fn hurry(&mut self) {
        self.due = None;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_card_draws_each_time_and_a_driver_on_the_processor_rests_as_long_as_it_worked() {
        let (mut pacer, begun) = (FramePacer::default(), Instant::now());
        let ended = begun + Duration::from_millis(40);
        assert!(pacer.is_due(begun));
        pacer.drawn(begun, ended, false);
        assert!(pacer.is_due(ended));
        pacer.drawn(begun, ended, true);
        assert!(!pacer.is_due(ended + Duration::from_millis(39)) && pacer.is_due(ended + Duration::from_millis(40)));
        pacer.drawn(begun, begun + Duration::from_secs(3), true);
        assert!(pacer.is_due(begun + Duration::from_secs(3) + LONGEST), "but never for long");
        pacer.hidden(ended);
        assert!(!pacer.is_due(ended));
        pacer.hurry();
        assert!(pacer.is_due(ended));
    }
}
