//! One Euro filter (Casiez, Roussel and Vogel 2012) of one joint: a low pass whose cutoff rises with speed.
//!
//! ```text
//! v' = v + a(1 Hz) ((m - x)/dt - v)      speed, smoothed
//! fc = mincutoff + beta |v'|             cutoff (Hz)
//! x' = x + a(fc) (m - x)                 a(f) = 1 / (1 + 1/(2 pi f dt))
//! ```

use std::f32::consts::TAU;

use glam::Vec3;

/// Cutoff of the speed's own low pass (Hz), as published.
const SPEED_CUTOFF: f32 = 1.0;

/// How much to smooth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OneEuroSettings {
    /// Cutoff at rest (Hz): less is smoother.
    pub min_cutoff: f32,
    /// How much a metre a second raises the cutoff (Hz s/m): more follows faster.
    pub beta: f32,
}

impl Default for OneEuroSettings {
    fn default() -> Self {
        Self { min_cutoff: 1.0, beta: 10.0 }
    }
}

/// State of one joint.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct OneEuro {
    /// Smoothed position (m).
    pub level: Vec3,
    /// Smoothed velocity (m/s).
    pub velocity: Vec3,
}

impl OneEuro {
    /// Smoothed velocity (m/s) once a measurement `dt` seconds after the one before is taken in.
    fn next_velocity(&self, measured: Vec3, dt: f32) -> Vec3 {
        self.velocity + ((measured - self.level) / dt - self.velocity) * gain(SPEED_CUTOFF, dt)
    }

    /// How fast the joint is with a measurement (m/s).
    pub fn speed(&self, measured: Vec3, dt: f32) -> f32 {
        if dt > 0.0 { self.next_velocity(measured, dt).length() } else { self.velocity.length() }
    }

    /// Takes a measurement `dt` seconds after the one before, smoothed as for a joint of that speed (m/s).
    pub fn update(&mut self, measured: Vec3, dt: f32, speed: f32, settings: &OneEuroSettings) {
        if dt > 0.0 {
            self.velocity = self.next_velocity(measured, dt);
            self.level += (measured - self.level) * gain(settings.min_cutoff + settings.beta * speed, dt);
        }
    }
}

/// Share of the newest measurement in a low pass of a cutoff (Hz).
fn gain(cutoff: f32, dt: f32) -> f32 {
    let turned = TAU * cutoff * dt;
    turned / (1.0 + turned)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_step_is_reached_without_overshoot_and_rest_stays() {
        let mut joint = OneEuro::default();
        let settings = OneEuroSettings::default();
        let mut last = 0.0;
        for _ in 0..60 {
            let speed = joint.speed(Vec3::X, 1.0 / 30.0);
            joint.update(Vec3::X, 1.0 / 30.0, speed, &settings);
            assert!(joint.level.x >= last && joint.level.x <= 1.0);
            last = joint.level.x;
        }
        assert!(last > 0.999, "{last}");
        let rest = joint;
        joint.update(Vec3::splat(9.0), 0.0, 0.0, &settings);
        assert_eq!(joint, rest, "no time, no change");
    }
}
