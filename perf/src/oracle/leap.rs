//! Multipliers by Newton's method: what the next round would have to start with for its links to be right.
//!
//! A round changes each multiplier by what it is off, which leaves whatever whole rows of links can do together for many
//! rounds. How all of them answer to each other is known, though: with the Hessian's factors one answer costs one
//! substitution, and conjugate gradients (Hestenes & Stiefel 1952) need few, because most links answer by themselves.
//! This is Newton's method on the dual of the method of multipliers (Bertsekas 1982, "Constrained Optimization and Lagrange
//! Multiplier Methods", section 2.3.2).

use glam::DVec3;

use super::energy::TotalEnergy;
use super::system::System;

/// Substitutions at most.
const MOST: usize = 40;

/// Part of the lag that may be left.
const LEFT: f64 = 1e-4;

/// Links have to be as near as this to their lengths (1) before the first order can be believed: from farther away, cloth
/// is thrown into other folds.
const NEAR: f64 = 2e-5;

/// Which rounds end with a leap.
#[derive(Debug, Default)]
pub struct Leaps {
    /// Strain left at the end of the round before, where it ended with a leap (1).
    before: Option<f64>,
    /// Whether a leap has not been worth its while: then there are no more.
    failed: bool,
}

impl Leaps {
    /// The multipliers of the next round, where a leap is due: links are near, but more than `goal` off.
    pub fn take(
        &mut self,
        landscape: &TotalEnergy<'_>,
        system: &mut System,
        x: &[DVec3],
        goal: f64,
    ) -> Option<Vec<f64>> {
        let off = landscape.springs.strain_off(x);
        self.failed |= self.before.is_some_and(|before| off > 0.5 * before);
        let due = !self.failed && off > goal && off < NEAR;
        let multipliers = if due { leap(landscape, system, x) } else { None };
        self.before = multipliers.is_some().then_some(off);
        multipliers
    }
}

/// Multipliers that would do away with what links are off at `x`, to first order; nothing where the exact Hessian is not
/// positive definite there.
fn leap(landscape: &TotalEnergy<'_>, system: &mut System, x: &[DVec3]) -> Option<Vec<f64>> {
    let springs = &landscape.springs;
    let mut left = springs.lag(x);
    let size = dot(&left, &left);
    if size == 0.0 {
        return None;
    }
    landscape.hessian(x, true, 0.0, system);
    if !system.factor() {
        return None;
    }
    let mut change = vec![0.0; left.len()];
    let mut along = left.clone();
    let mut norm = size;
    for _ in 0..MOST {
        let answer = springs.answer(x, system, &along)?;
        let bend = dot(&along, &answer);
        if bend <= 0.0 {
            break;
        }
        let by = norm / bend;
        add(&mut change, by, &along);
        add(&mut left, -by, &answer);
        let next = dot(&left, &left);
        if next <= LEFT * LEFT * size {
            break;
        }
        along.iter_mut().zip(&left).for_each(|(d, r)| *d = r + *d * (next / norm));
        norm = next;
    }
    change.iter().all(|c| c.is_finite()).then(|| springs.multiplier.iter().zip(change).map(|(m, c)| m + c).collect())
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn add(to: &mut [f64], by: f64, what: &[f64]) {
    to.iter_mut().zip(what).for_each(|(t, w)| *t += by * w);
}
