//! The pose that a sensor reports for a person who stands at ease, learned while the sensor watches them.
//!
//! Sensors put the joints of trunk, neck and shoulders where their makers thought best, so that a relaxed person seems
//! to bow or to shrug by up to 30 degrees, always the same way. In front of a mirror people mostly stand at ease: what
//! is shown most of the time is taken for the sensor's habit, and only what differs from it for the person's doing.

use glam::Vec3;

use super::smooth::fraction;

/// Time constant of learning (s); a plain mean until as much was seen.
const TAU: f32 = 10.0;

/// How far from the habit (rad) a moment may be to count fully; beyond it counts a tenth: a bow is no habit.
const AT_EASE: f32 = 0.35;

/// A habit: a small vector of angles (rad).
#[derive(Debug, Clone, Copy, Default)]
pub struct Neutral {
    value: Option<Vec3>,
    watched: f32,
}

impl Neutral {
    /// Learns from `shown` (rad), `dt` (s) after the last time, and returns the habit.
    pub fn learn(&mut self, shown: Vec3, dt: f32) -> Vec3 {
        let value = self.value.get_or_insert(shown);
        let weight = if shown.distance(*value) < AT_EASE { 1.0 } else { 0.1 };
        let mean = if self.watched < TAU { dt / (self.watched + dt).max(1e-6) } else { 0.0 };
        *value += (shown - *value) * weight * mean.max(fraction(dt, TAU));
        self.watched += dt * weight;
        *value
    }

    /// The habit; none where nothing was seen.
    pub fn value(&self) -> Vec3 {
        self.value.unwrap_or_default()
    }
}
