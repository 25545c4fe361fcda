//! Open or closed, decided over several frames.

use toile_base::clock::seconds_between;

use super::{Gesture, LONGEST_GAP_NS};

/// Openness is averaged over this time (s): four frames at 30 Hz, two at 15 Hz.
const SETTLE_S: f32 = 0.12;

/// A hand whose mean openness rises above the second is open, below the first closed; in between it stays what it was.
const HYSTERESIS: [f32; 2] = [0.35, 0.65];

/// A hand must be seen this long before it is called open or closed (ns).
const FIRST_NS: u64 = 200_000_000;

/// After a change no other is given for this long (ns): people do not open and close a hand on purpose faster.
const COOL_DOWN_NS: u64 = 300_000_000;

/// The grip of one hand.
#[derive(Debug, Clone)]
pub(super) struct Grip {
    openness: f32,
    since_ns: u64,
    seen_ns: Option<u64>,
    open: Option<bool>,
    quiet_until_ns: u64,
}

impl Grip {
    /// A hand that was not seen yet.
    pub(super) const fn new() -> Self {
        Self { openness: 0.5, since_ns: 0, seen_ns: None, open: None, quiet_until_ns: 0 }
    }

    /// One frame: how open the hand is, `None` where it is not seen. Gives a change; the first state is not one.
    pub(super) fn step(&mut self, now: u64, openness: Option<f32>) -> Option<Gesture> {
        let lost = self.seen_ns.is_some_and(|seen| now - seen > LONGEST_GAP_NS);
        if lost {
            *self = Self { quiet_until_ns: self.quiet_until_ns, ..Self::new() };
        }
        let openness = openness?;
        let Some(last) = self.seen_ns.replace(now) else {
            (self.openness, self.since_ns) = (openness, now);
            return None;
        };
        let dt = seconds_between(last, now);
        self.openness += (openness - self.openness) * (1.0 - (-dt / SETTLE_S).exp());
        let open = match self.openness {
            o if o < HYSTERESIS[0] => false,
            o if o > HYSTERESIS[1] => true,
            _ => return None,
        };
        if now - self.since_ns < FIRST_NS || now < self.quiet_until_ns || self.open == Some(open) {
            return None;
        }
        let changed = self.open.replace(open).is_some();
        self.quiet_until_ns = now.saturating_add(COOL_DOWN_NS);
        changed.then_some(if open { Gesture::Opened } else { Gesture::Closed })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The events of a series of opennesses at 30 Hz.
    fn events(series: impl IntoIterator<Item = Option<f32>>) -> Vec<(usize, Gesture)> {
        let mut grip = Grip::new();
        let step = |(i, o)| grip.step(i as u64 * 33_333_333, o).map(|g| (i, g));
        series.into_iter().enumerate().filter_map(step).collect()
    }

    #[test]
    fn a_hand_that_closes_and_opens_gives_both_once_and_within_a_quarter_second() {
        let series = |i: usize| Some(if (30..60).contains(&i) { 0.0 } else { 1.0 });
        let found = events((0..90).map(series));
        let [(closed, Gesture::Closed), (opened, Gesture::Opened)] = found[..] else { panic!("{found:?}") };
        assert!((30..38).contains(&closed) && (60..68).contains(&opened), "{found:?}");
    }

    #[test]
    fn a_wild_frame_a_short_loss_and_what_is_seen_first_are_no_change() {
        assert_eq!(events((0..60).map(|i| Some(if i == 30 { 0.0 } else { 1.0 }))), []);
        assert_eq!(events((0..60).map(|i| (i % 9 > 3).then_some(0.0))), []);
        // Lost for a second, and back as something else: that was not seen happening.
        assert_eq!(events((0..90).map(|i| (!(30..60).contains(&i)).then_some(if i < 30 { 0.0 } else { 1.0 }))), []);
    }

    #[test]
    fn between_open_and_closed_it_stays_what_it_was() {
        assert_eq!(events((0..200).map(|i| Some(if i % 2 == 0 { 0.35 } else { 0.65 }))), []);
    }
}
