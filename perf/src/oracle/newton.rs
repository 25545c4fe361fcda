//! Newton's method with a shifted Hessian and a line search.
//!
//! The exact Hessian is tried first. Where it is not positive definite, as in cloth that is about to fold, the one whose
//! elements are projected takes its place for a while: it always is, but it converges slowly where forces compress. To
//! either a multiple of the masses is added, which makes a step of it an implicit step of `1 / sqrt(shift)` seconds from
//! rest: it grows where the line search has to cut steps short and goes away where it need not.

use glam::DVec3;

use super::energy::Landscape;
use super::system::System;

/// Share of the slope that a step has to gain (Nocedal & Wright 2006, eq. 3.4).
const ARMIJO: f64 = 1e-4;

/// Halvings of a step before it is given up.
const HALVINGS: usize = 30;

/// Rounding of an energy, relative to its size.
const ROUNDING: f64 = 1e-14;

/// A shift below this (1/s2) is none: an implicit step of half a minute.
const NO_SHIFT: f64 = 1e-3;

/// The largest shift (1/s2): an implicit step of a microsecond.
const MOST_SHIFT: f64 = 1e12;

/// Longest wait before the exact Hessian is tried again (iterations).
const MOST_WAIT: u32 = 8;

/// What carries over from iteration to iteration and from round to round.
#[derive(Debug, Clone, Copy)]
pub struct Stance {
    /// Multiple of the masses added to the Hessian (1/s2).
    pub shift: f64,
    /// Iterations so far.
    pub iterations: usize,
    wait: u32,
    waiting: u32,
}

impl Stance {
    /// Nothing known yet.
    pub fn new(shift: f64) -> Self {
        Self { shift, iterations: 0, wait: 1, waiting: 0 }
    }
}

/// When to stop.
#[derive(Debug, Clone, Copy)]
pub struct Aim {
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
    landscape: &Landscape<'_>,
    system: &mut System,
    x: &mut Vec<DVec3>,
    stance: &mut Stance,
    aim: Aim,
) -> f64 {
    let mut gradient = landscape.gradient(x);
    let mut left = residual(&gradient);
    while left > aim.residual_n && stance.iterations < aim.most {
        stance.iterations += 1;
        let Some(step) = direction(landscape, system, x, &gradient, stance) else { break };
        let Some((next, share)) = search(landscape, x, &gradient, &step) else {
            if stance.shift >= MOST_SHIFT {
                break;
            }
            stance.shift = (stance.shift * 100.0).max(1.0);
            continue;
        };
        *x = next;
        stance.shift = match share {
            s if s >= 1.0 => stance.shift * 0.2,
            s if s < 0.25 => (stance.shift * 4.0).clamp(1.0, MOST_SHIFT),
            _ => stance.shift,
        };
        if stance.shift < NO_SHIFT {
            stance.shift = 0.0;
        }
        gradient = landscape.gradient(x);
        left = residual(&gradient);
    }
    left
}

/// The step of the exact Hessian if it is positive definite, else that of the projected one.
fn direction(
    landscape: &Landscape<'_>,
    system: &mut System,
    x: &[DVec3],
    gradient: &[DVec3],
    stance: &mut Stance,
) -> Option<Vec<DVec3>> {
    if stance.waiting == 0 {
        landscape.hessian(x, true, stance.shift, system);
        if let Some(step) = system.solve(gradient) {
            stance.wait = 1;
            return Some(step);
        }
        stance.waiting = stance.wait;
        stance.wait = (stance.wait * 2).min(MOST_WAIT);
    } else {
        stance.waiting -= 1;
    }
    while stance.shift < MOST_SHIFT {
        landscape.hessian(x, false, stance.shift, system);
        let step = system.solve(gradient);
        if step.is_some() {
            return step;
        }
        stance.shift = (stance.shift * 10.0).max(1.0);
    }
    None
}

/// The longest of some shares of a step that lowers the energy enough; where energies no longer tell, that lowers the
/// residual.
fn search(landscape: &Landscape<'_>, x: &[DVec3], gradient: &[DVec3], step: &[DVec3]) -> Option<(Vec<DVec3>, f64)> {
    let slope: f64 = gradient.iter().zip(step).map(|(g, d)| g.dot(*d)).sum();
    let along = |t: f64| -> Vec<DVec3> { x.iter().zip(step).map(|(p, d)| *p + *d * t).collect() };
    let before = landscape.value(x);
    let noise = ROUNDING * (before.abs() + 1e-9);
    let mut share = 1.0;
    for _ in 0..HALVINGS {
        if -slope * share < 1e3 * noise {
            break;
        }
        let next = along(share);
        let value = landscape.value(&next);
        if value <= before + ARMIJO * share * slope {
            return Some((next, share));
        }
        // The least of the parabola through both values and the slope.
        let best = if value.is_finite() { -slope * share / (2.0 * (value - before - slope * share)) } else { 0.1 };
        share *= best.clamp(0.1, 0.5);
    }
    let left = residual(gradient);
    let mut share = 1.0;
    for _ in 0..8 {
        let next = along(share);
        if residual(&landscape.gradient(&next)) < left {
            return Some((next, share));
        }
        share *= 0.5;
    }
    None
}
