//! Planted feet: which foot stands, by the speed and height of its ankle.
//!
//! Both thresholds adapt, as they must to sensors and their places (Gultepe 2013, algorithm 3): the height is counted from
//! where ankles [usually are](super::ground), and the speed from how fast an ankle seems to move that stands, which is the
//! sensor's noise. Two thresholds each, one to plant and one to let go, keep a foot from flickering between both. Neither
//! foot need stand: while the body is in the air both are free.

use glam::Vec3;

use super::ground::Ground;
use super::smooth::{fraction, ramp};

/// Speed of a seen ankle (m/s) up to which it is planted, and from which it is let go, for a sensor without noise.
const SPEED: [f32; 2] = [0.15, 0.4];

/// The same over the noise's speed, and the most that either becomes (m/s): a slow walker's swinging foot.
const OVER_NOISE: [f32; 2] = [2.0, 4.0];
const MOST_SPEED: [f32; 2] = [0.35, 0.8];

/// Lift of a seen ankle (m) up to which it is planted, and from which it is let go.
const LIFT: [f32; 2] = [0.04, 0.08];

/// Time constant of an ankle's measured velocity (s): two sensor frames.
const SPEED_TAU: f32 = 0.07;

/// Share of the time in which a person's foot moves slower than its noise, and rate at which the noise is learned (m/s a
/// second): a walker's foot stands 0.6 of the time.
const QUIET: f32 = 0.3;
const LEARNING: f32 = 0.1;

/// State of one foot.
#[derive(Debug, Clone, Copy, Default)]
pub struct Plant {
    /// Where the ankle was last seen (m), and how fast it moves (m/s).
    ankle: Option<Vec3>,
    velocity: Vec3,
    /// Speed that an ankle shows which stands (m/s).
    noise: f32,
    planted: bool,
}

impl Plant {
    /// Takes in where the ankle is seen, `dt` (s) after the last time; one that is not seen is taken to stand still.
    pub fn watch(&mut self, ankle: Option<Vec3>, ground: &Ground, dt: f32) {
        let Some(ankle) = ankle else {
            *self = Self { noise: self.noise, planted: !ground.flies(), ..Self::default() };
            return;
        };
        if let Some(last) = self.ankle
            && dt > 0.0
        {
            self.velocity += ((ankle - last) / dt - self.velocity) * fraction(dt, SPEED_TAU);
        }
        self.ankle = Some(ankle);
        let (speed, lift) = (self.velocity.length(), ground.lift(ankle.y));
        // A running quantile (Robbins and Monro 1951): up by its share, down by the rest.
        let step = if speed > self.noise { QUIET } else { QUIET - 1.0 };
        self.noise = (self.noise + step * LEARNING * dt).max(0.0);
        let [plants, frees] = self.speeds();
        self.planted = !ground.flies()
            && if self.planted { speed < frees && lift < LIFT[1] } else { speed < plants && lift < LIFT[0] };
    }

    /// Speeds (m/s) to plant and to let go.
    fn speeds(&self) -> [f32; 2] {
        [0, 1].map(|k| SPEED[k].max(OVER_NOISE[k] * self.noise).min(MOST_SPEED[k]))
    }

    /// Whether the foot stands.
    pub fn is_planted(&self) -> bool {
        self.planted
    }

    /// How much the foot stands, 0 to 1, without a step: for what is shared between both feet.
    pub fn share(&self, ground: &Ground) -> f32 {
        let Some(ankle) = self.ankle else { return 1.0 };
        (1.0 - ramp(self.speeds(), self.velocity.length())) * (1.0 - ramp(LIFT, ground.lift(ankle.y)))
    }
}
