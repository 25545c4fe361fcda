//! Recent positions of a point, and its velocity.

use glam::Vec3;
use toile_base::clock::seconds_between;

/// Places that are remembered: those of the window at the shortest step, and one more.
const PLACES: usize = 9;

/// A velocity is the slope over this time (ns): three frames at 15 Hz, five at 30 Hz, which leaves 75 mm/s of the 8 mm of
/// jitter of an unfiltered tracker.
const WINDOW_NS: u64 = 140_000_000;

/// A slope over a shorter time than this (ns) is noise.
const SHORTEST_NS: u64 = 30_000_000;

/// The last positions of a point, by time.
#[derive(Debug, Clone)]
pub(super) struct PositionHistory {
    places: [(u64, Vec3); PLACES],
    count: usize,
}

impl PositionHistory {
    pub(super) const fn new() -> Self {
        Self { places: [(0, Vec3::ZERO); PLACES], count: 0 }
    }

    /// Adds a place; times must rise.
    pub(super) fn push(&mut self, time_ns: u64, place: Vec3) {
        if self.count == PLACES {
            self.places.copy_within(1.., 0);
            self.count -= 1;
        }
        self.places[self.count] = (time_ns, place);
        self.count += 1;
    }

    /// Velocity at the newest place (units/s): the least-squares slope over the window; `None` with too short a history.
    pub(super) fn velocity(&self) -> Option<Vec3> {
        let places = &self.places[..self.count];
        let (now, _) = *places.last()?;
        let from = places.iter().position(|(t, _)| now - t <= WINDOW_NS)?;
        let places = &places[from..];
        if now - places[0].0 < SHORTEST_NS {
            return None;
        }
        let n = places.len() as f32;
        let time = |t: u64| seconds_between(now, t);
        let mean_time = places.iter().map(|(t, _)| time(*t)).sum::<f32>() / n;
        let mean = places.iter().map(|(_, p)| *p).sum::<Vec3>() / n;
        let mut slope = Vec3::ZERO;
        let mut square = 0.0;
        for (t, p) in places {
            let dt = time(*t) - mean_time;
            slope += (*p - mean) * dt;
            square += dt * dt;
        }
        Some(slope / square)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_steady_motion_has_its_velocity_at_any_rate_and_over_dropped_frames() {
        for step in [20_000_000, 33_333_333, 66_666_667, 125_000_000] {
            let mut history = PositionHistory::new();
            for i in (0..40).filter(|i| i % 7 != 3) {
                let t = i * step;
                history.push(t, Vec3::new(2.0, -1.0, 0.5) * (t as f32 * 1e-9));
                if i > 1 && i % 7 != 4 {
                    let v = history.velocity().unwrap();
                    assert!((v - Vec3::new(2.0, -1.0, 0.5)).length() < 1e-3, "{step} {i}: {v}");
                }
            }
        }
        let mut history = PositionHistory::new();
        assert_eq!(history.velocity(), None);
        history.push(5, Vec3::ONE);
        assert_eq!(history.velocity(), None);
    }
}
