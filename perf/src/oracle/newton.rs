//! Newton's method with a shifted Hessian, a step that follows the bend of its links, and a test of what it gains.
//!
//! The exact Hessian is tried first. Where it is not positive definite, as in cloth that is about to fold, more of the
//! masses is added, which makes of the step an implicit one of `1 / sqrt(shift)` seconds from rest; where even a short one
//! is none, the Hessian whose elements are projected takes its place for a while: it always is positive definite, but
//! converges slowly where forces compress. A step that gains less than it promised is shortened by a larger shift, not
//! along itself: that would cut what stiff links need as much as what runs too far (Levenberg 1944; Marquardt 1963;
//! Nocedal & Wright 2006, algorithm 4.1 for the test).
//!
//! A long step turns stiff links, and links that turn lengthen: seen from there nothing is gained, although only the
//! second order is wrong. What the turning adds is therefore taken back with the same factors, the second-order
//! correction of sequential quadratic programming (Nocedal & Wright 2006, section 18.3). In the benchmark's skirt of
//! 1,024 particles it saves more than half of the iterations.

use glam::DVec3;

use super::energy::TotalEnergy;
use super::system::System;

/// Part of the promised gain that a step has to reach, that makes it a poor one, and a good one.
const GAIN: [f64; 3] = [0.01, 0.3, 0.7];

/// What the shift is multiplied by after a good, a poor and a refused step.
const SHIFT: [f64; 3] = [0.2, 2.0, 6.0];

/// Rounding of an energy, relative to its size, and what must stand out of it for a gain to be seen.
const ROUNDING: [f64; 2] = [1e-14, 1e3];

/// A shift below this (1/s2) is none: an implicit step of half a minute.
const NO_SHIFT: f64 = 1e-3;

/// The first shift (1/s2) where there was none: an implicit step of a second.
const SOME_SHIFT: f64 = 1.0;

/// The largest shift (1/s2): an implicit step of a microsecond.
const MOST_SHIFT: f64 = 1e12;

/// Shifts, each ten times the one before, that the exact Hessian is tried with.
const TRIES: usize = 4;

/// Longest wait before the exact Hessian is tried again (iterations).
const MOST_WAIT: u32 = 8;

/// Times that the bend of the links is followed.
const BENDS: usize = 6;

/// Steps in a row that may be refused where energies no longer say anything.
const PATIENCE: u32 = 6;

/// What carries over from iteration to iteration and from round to round.
#[derive(Debug, Clone, Copy)]
pub struct NewtonState {
    /// Multiple of the masses added to the Hessian (1/s2).
    pub shift: f64,
    /// Iterations so far.
    pub iterations: usize,
    wait: u32,
    waiting: u32,
}

impl NewtonState {
    /// A solver that has factorised nothing yet.
    pub fn new(shift: f64) -> Self {
        Self { shift, iterations: 0, wait: 1, waiting: 0 }
    }

    fn scale_shift(&mut self, by: f64) {
        let scaled = if by > 1.0 { (self.shift * by).clamp(SOME_SHIFT, MOST_SHIFT) } else { self.shift * by };
        self.shift = if scaled < NO_SHIFT { 0.0 } else { scaled };
    }
}

/// When Newton's method stops.
#[derive(Debug, Clone, Copy)]
pub struct StopRule {
    /// Largest force that may be left on a particle (N).
    pub residual_n: f64,
    /// Most iterations in all.
    pub most: usize,
}

/// The largest force that is left on a particle (N).
pub fn residual(gradient: &[DVec3]) -> f64 {
    gradient.iter().map(|g| g.length()).fold(0.0, f64::max)
}

/// Moves `x` to where the gradient is as small as asked for. Gives the residual that is left (N): above that where
/// iterations ran out or nothing more can be gained.
pub fn minimise(
    landscape: &TotalEnergy<'_>,
    system: &mut System,
    x: &mut Vec<DVec3>,
    stance: &mut NewtonState,
    aim: StopRule,
) -> f64 {
    let mut gradient = landscape.gradient(x);
    let mut left = residual(&gradient);
    let mut refused = 0;
    while left > aim.residual_n && stance.iterations < aim.most {
        stance.iterations += 1;
        let Some(step) = direction(landscape, system, x, &gradient, stance) else { break };
        let trial = try_step(landscape, system, x, (&gradient, &step), stance.shift);
        if trial.gain < GAIN[0] || trial.gain.is_nan() {
            refused += u32::from(trial.faint);
            if refused > PATIENCE || stance.shift >= MOST_SHIFT {
                break;
            }
            stance.scale_shift(SHIFT[2]);
            continue;
        }
        *x = trial.next;
        refused = 0;
        match trial.gain {
            gain if gain > GAIN[2] => stance.scale_shift(SHIFT[0]),
            gain if gain < GAIN[1] => stance.scale_shift(SHIFT[1]),
            _ => {}
        }
        gradient = landscape.gradient(x);
        left = residual(&gradient);
    }
    left
}

/// The step of the exact Hessian if a shift makes it positive definite, else that of the projected one.
fn direction(
    landscape: &TotalEnergy<'_>,
    system: &mut System,
    x: &[DVec3],
    gradient: &[DVec3],
    stance: &mut NewtonState,
) -> Option<Vec<DVec3>> {
    let shift = stance.shift;
    let tries = if stance.waiting == 0 { TRIES } else { 0 };
    for _ in 0..tries {
        landscape.hessian(x, true, stance.shift, system);
        if system.factor() {
            stance.wait = 1;
            return system.solve(gradient);
        }
        stance.scale_shift(10.0);
    }
    stance.shift = shift;
    if stance.waiting == 0 {
        stance.waiting = stance.wait;
        stance.wait = (stance.wait * 2).min(MOST_WAIT);
    } else {
        stance.waiting -= 1;
    }
    loop {
        landscape.hessian(x, false, stance.shift, system);
        if system.factor() {
            return system.solve(gradient);
        }
        if stance.shift >= MOST_SHIFT {
            return None;
        }
        stance.scale_shift(10.0);
    }
}

/// A step that was tried.
struct TriedStep {
    next: Vec<DVec3>,
    /// What was gained, as part of what was promised; where rounding hides it, 1 if the residual got less, else -1.
    gain: f64,
    /// Whether rounding hides it.
    faint: bool,
}

/// Where a step, along the links' bends, leads and what it gains.
fn try_step(
    landscape: &TotalEnergy<'_>,
    system: &System,
    x: &[DVec3],
    (gradient, step): (&[DVec3], &[DVec3]),
    shift: f64,
) -> TriedStep {
    let before = landscape.value(x);
    let (next, value) = bent(landscape, system, x, step);
    let slope: f64 = gradient.iter().zip(step).map(|(g, d)| g.dot(*d)).sum();
    let moved: f64 = landscape.problem.mass.iter().zip(step).map(|(m, d)| m * d.length_squared()).sum();
    // -g.d - (1/2) d.H d, with (H + shift M) d = -g.
    let promised = 0.5 * (shift * moved - slope);
    let faint = promised < ROUNDING[0] * ROUNDING[1] * before.abs().max(f64::MIN_POSITIVE);
    let gain = if faint {
        let less = residual(&landscape.gradient(&next)) < residual(gradient);
        if less { 1.0 } else { -1.0 }
    } else {
        (before - value) / promised
    };
    TriedStep { next, gain, faint }
}

/// Positions after a step and the energy there (J), with what the turning of links adds taken back as long as that lowers
/// the energy.
fn bent(landscape: &TotalEnergy<'_>, system: &System, x: &[DVec3], step: &[DVec3]) -> (Vec<DVec3>, f64) {
    let after = |by: &[DVec3]| -> Vec<DVec3> { x.iter().zip(by).map(|(p, d)| *p + *d).collect() };
    let mut next = after(step);
    let mut value = landscape.value(&next);
    let mut by = step.to_vec();
    for _ in 0..BENDS {
        let mut bulge = vec![DVec3::ZERO; x.len()];
        landscape.springs.bulge(x, &by, &mut bulge);
        let Some(back) = system.solve(&bulge) else { break };
        by = step.iter().zip(&back).map(|(d, c)| *d + *c).collect();
        let bent = after(&by);
        let lower = landscape.value(&bent);
        if lower.is_nan() || lower >= value {
            break;
        }
        (next, value) = (bent, lower);
    }
    (next, value)
}
