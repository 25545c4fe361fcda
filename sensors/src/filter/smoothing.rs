//! The smoothing of one joint's position: none, Holt's or One Euro.

use glam::Vec3;

use super::holt::{Holt, HoltSettings};
use super::one_euro::{OneEuro, OneEuroSettings};

/// Kind and strength of the smoothing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Smoothing {
    /// Positions as they are seen.
    None,
    /// Double exponential smoothing after Holt.
    Holt(HoltSettings),
    /// One Euro filter: cuts off lower, the slower the joint moves.
    OneEuro(OneEuroSettings),
}

impl Default for Smoothing {
    /// What docs/filters.md chooses, and why.
    fn default() -> Self {
        Self::Holt(HoltSettings::default())
    }
}

/// State of one joint.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Smoother {
    /// Smoothed position (m).
    pub level: Vec3,
    /// Velocity of the joint (m/s).
    pub trend: Vec3,
}

impl Smoother {
    /// Starts at a measured position, at rest.
    pub fn start(measured: Vec3) -> Self {
        Self { level: measured, trend: Vec3::ZERO }
    }

    /// What decides how far a measurement is followed: for Holt's the trust (0..1), for One Euro the speed (m/s).
    pub fn drive(&self, measured: Vec3, dt: f32, smoothing: &Smoothing) -> f32 {
        match smoothing {
            Smoothing::None => 0.0,
            Smoothing::Holt(settings) => self.holt().trust(measured, dt, settings),
            Smoothing::OneEuro(_) => self.one_euro().speed(measured, dt),
        }
    }

    /// Takes a measurement `dt` seconds after the one before, followed as `drive` says.
    pub fn update(&mut self, measured: Vec3, dt: f32, drive: f32, smoothing: &Smoothing) {
        match smoothing {
            Smoothing::None => *self = Self::start(measured),
            Smoothing::Holt(settings) => {
                let mut holt = self.holt();
                holt.update(measured, dt, drive, settings);
                *self = Self { level: holt.level, trend: holt.trend };
            }
            Smoothing::OneEuro(settings) => {
                let mut joint = self.one_euro();
                joint.update(measured, dt, drive, settings);
                *self = Self { level: joint.level, trend: joint.velocity };
            }
        }
    }

    /// Drawn position of the joint (m).
    pub fn output(&self, smoothing: &Smoothing) -> Vec3 {
        match smoothing {
            Smoothing::Holt(settings) => self.holt().output(settings),
            Smoothing::None | Smoothing::OneEuro(_) => self.level,
        }
    }

    fn holt(&self) -> Holt {
        Holt { level: self.level, trend: self.trend }
    }

    fn one_euro(&self) -> OneEuro {
        OneEuro { level: self.level, velocity: self.trend }
    }
}
