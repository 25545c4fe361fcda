//! The watchdog: fed only while both physics and render make progress.

use std::sync::atomic::AtomicU64;
use std::sync::atomic::Ordering::Relaxed;
use std::time::Duration;

/// Longest time between two feedings (ns), however patient the manager is: a state page shows that it is alive.
const LONGEST_NS: u64 = 5_000_000_000;

/// What the loop's threads count up while they get on.
///
/// Relaxed: numbers to look at, which order nothing.
#[derive(Debug, Default)]
pub struct Progress {
    steps: AtomicU64,
    pictures: AtomicU64,
}

impl Progress {
    /// A step was published.
    pub fn step(&self) {
        self.steps.fetch_add(1, Relaxed);
    }

    /// So many pictures were taken so far.
    pub fn pictures(&self, count: u64) {
        self.pictures.store(count, Relaxed);
    }

    /// Steps and pictures so far.
    pub fn count(&self) -> [u64; 2] {
        [self.steps.load(Relaxed), self.pictures.load(Relaxed)]
    }
}

/// Decides when to feed.
#[derive(Debug, Clone)]
pub struct Watchdog {
    every_ns: u64,
    due_ns: u64,
    fed_at: [u64; 2],
}

impl Watchdog {
    /// One whose manager waits at most this long; it is fed three times in that. None is no watchdog.
    pub fn new(patience: Option<Duration>, now_ns: u64) -> Option<Self> {
        let every_ns = (patience?.as_nanos() as u64 / 3).clamp(1, LONGEST_NS);
        Some(Self { every_ns, due_ns: now_ns, fed_at: [0; 2] })
    }

    /// Whether it is to be fed now: it is time, and both counts have grown since it was fed last. Where one has not, the next
    /// look decides.
    pub fn look(&mut self, now_ns: u64, count: [u64; 2]) -> bool {
        let grown = count.iter().zip(&self.fed_at).all(|(now, then)| now > then);
        if now_ns < self.due_ns || !grown {
            return false;
        }
        (self.due_ns, self.fed_at) = (now_ns + self.every_ns, count);
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Feedings in three seconds, a look each 10 ms, in which steps or pictures stand still from these times on (ms).
    fn feedings(steps_end: u64, pictures_end: u64) -> Vec<u64> {
        let mut dog = Watchdog::new(Some(Duration::from_millis(300)), 0).unwrap();
        let at = |ms: &u64| dog.look(ms * 1_000_000, [(*ms).min(steps_end) / 8, (*ms).min(pictures_end) / 16]);
        (0..3_000).step_by(10).filter(at).collect()
    }

    #[test]
    fn it_is_fed_three_times_in_its_patience_while_both_get_on() {
        let fed = feedings(3_000, 3_000);
        assert_eq!(fed[0], 20, "not before the first step and the first picture");
        assert!(fed.windows(2).all(|w| w[1] - w[0] == 100) && fed.len() == 30, "{fed:?}");
    }

    #[test]
    fn it_starves_where_physics_stands_still_and_where_render_does() {
        for fed in [feedings(1_000, 3_000), feedings(3_000, 1_000), feedings(1_000, 1_000)] {
            let last = *fed.last().unwrap();
            assert!((900..=1_120).contains(&last), "{last}");
        }
        assert!(feedings(3_000, 0).is_empty() && feedings(0, 3_000).is_empty());
    }

    #[test]
    fn without_a_request_nothing_is_fed() {
        assert!(Watchdog::new(None, 0).is_none());
    }
}
