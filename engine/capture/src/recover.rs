//! The values of a fabric that make a simulation lie nearest to a captured motion (MIRAGES 2006, "recovering cloth parameters").
//!
//! Least squares over all vertices and frames, by Levenberg and Marquardt in the logarithms of the values, which keeps them positive
//! and makes a step a part of each. Derivatives are differences of whole simulations: a simulation a value and a step.

use glam::Vec3;
use serde::Serialize;
use toile_base::numeric::linear::{Pivot, factor, solve};

/// Values that are looked for: stretch, shear, bending, damping.
pub const VALUES: usize = 4;

/// Parts of the motion that are fitted, one after the other, and the fewest frames of one.
const HORIZONS: [f64; 5] = [0.06, 0.12, 0.25, 0.5, 1.0];
const FEWEST: usize = 6;

/// Change of a logarithm by which derivatives are taken, to both sides.
const CHANGE: f64 = 0.02;

/// Longest step of a logarithm: a factor of two.
const LONGEST: f64 = 0.7;

/// Most steps, and the change of the logarithms below which none follows.
const STEPS: usize = 14;
const DONE: f64 = 2e-3;

/// Times that a step which leads away is shortened.
const SHORTENED: usize = 5;

/// What was found.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Recovered {
    /// The values, in the units of the start.
    pub values: [f64; VALUES],
    /// Standard deviation of each, as a part of it, from how far the motions lie apart and how much each value moves the cloth.
    pub sigma: [f64; VALUES],
    /// Mean distance of a vertex before and after (mm).
    pub error_mm: [f64; 2],
    /// Simulations that were run.
    pub simulations: usize,
}

/// Finds the values from a start; `simulate` gives the motion of some values over so many frames (m).
///
/// A cloth that folds otherwise at one moment moves otherwise ever after, so that the whole motion has many hollows. The first frames
/// are fitted first, and each time more of them.
///
/// # Errors
/// As `simulate`.
pub fn recover<E>(
    start: [f64; VALUES],
    observed: &[Vec<Vec3>],
    mut simulate: impl FnMut(&[f64; VALUES], usize) -> Result<Vec<Vec<Vec3>>, E>,
) -> Result<Recovered, E> {
    let mut search = Search {
        p: start.map(f64::ln),
        observed,
        simulate: &mut simulate,
        simulations: 0,
        covariance: [[0.0; VALUES]; VALUES],
    };
    let first = mean(&search.at(&search.p.clone(), observed.len())?);
    for share in HORIZONS {
        let frames = ((observed.len() as f64 * share) as usize).clamp(FEWEST.min(observed.len()), observed.len());
        search.descend(frames)?;
    }
    let last = mean(&search.at(&search.p.clone(), observed.len())?);
    // The vertices of a frame err together: a frame counts as one.
    let together = observed.first().map_or(1.0, |f| f.len() as f64);
    let sigma = std::array::from_fn(|k| (search.covariance[k][k] * together).sqrt());
    Ok(Recovered { values: search.p.map(f64::exp), sigma, error_mm: [first, last], simulations: search.simulations })
}

/// A search on its way.
struct Search<'a, F> {
    /// Logarithms of the values.
    p: [f64; VALUES],
    observed: &'a [Vec<Vec3>],
    simulate: &'a mut F,
    simulations: usize,
    covariance: [[f64; VALUES]; VALUES],
}

impl<E, F: FnMut(&[f64; VALUES], usize) -> Result<Vec<Vec<Vec3>>, E>> Search<'_, F> {
    fn at(&mut self, p: &[f64; VALUES], frames: usize) -> Result<Vec<Vec3>, E> {
        self.simulations += 1;
        (self.simulate)(&p.map(f64::exp), frames).map(|motion| difference(&motion, &self.observed[..frames]))
    }

    /// Steps over the first frames until they lead nowhere.
    fn descend(&mut self, frames: usize) -> Result<(), E> {
        let mut r = self.at(&self.p.clone(), frames)?;
        let mut damping = 1e-3;
        for _ in 0..STEPS {
            let mut columns = Vec::with_capacity(VALUES);
            for k in 0..VALUES {
                let [mut up, mut down] = [self.p; 2];
                up[k] += CHANGE;
                down[k] -= CHANGE;
                let (up, down) = (self.at(&up, frames)?, self.at(&down, frames)?);
                columns
                    .push(up.iter().zip(&down).map(|(a, b)| (*a - *b) / (2.0 * CHANGE) as f32).collect::<Vec<Vec3>>());
            }
            let normal: [[f64; VALUES]; VALUES] =
                std::array::from_fn(|i| std::array::from_fn(|j| dot(&columns[i], &columns[j])));
            let right: [f64; VALUES] = std::array::from_fn(|i| -dot(&columns[i], &r));
            self.covariance = spread(&normal, dot(&r, &r) / (3 * r.len()) as f64);
            let mut moved = 0.0;
            for _ in 0..SHORTENED {
                let step = step(&normal, &right, damping);
                let next: [f64; VALUES] = std::array::from_fn(|k| self.p[k] + step[k].clamp(-LONGEST, LONGEST));
                let there = self.at(&next, frames)?;
                if dot(&there, &there) < dot(&r, &r) {
                    moved = (0..VALUES).map(|k| (next[k] - self.p[k]).abs()).fold(0.0, f64::max);
                    (self.p, r) = (next, there);
                    damping = (damping * 0.2).max(1e-9);
                    break;
                }
                damping *= 8.0;
            }
            if moved < DONE {
                break;
            }
        }
        Ok(())
    }
}

fn difference(motion: &[Vec<Vec3>], observed: &[Vec<Vec3>]) -> Vec<Vec3> {
    motion.iter().zip(observed).flat_map(|(a, b)| a.iter().zip(b).map(|(x, y)| *x - *y)).collect()
}

fn dot(a: &[Vec3], b: &[Vec3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| f64::from(a.dot(*b))).sum()
}

fn mean(r: &[Vec3]) -> f64 {
    r.iter().map(|d| f64::from(d.length())).sum::<f64>() / r.len().max(1) as f64 * 1e3
}

/// The damped step.
fn step(normal: &[[f64; VALUES]; VALUES], right: &[f64; VALUES], damping: f64) -> [f64; VALUES] {
    let mut a = *normal;
    let trace: f64 = (0..VALUES).map(|k| normal[k][k]).sum();
    for (k, row) in a.iter_mut().enumerate() {
        row[k] += damping * row[k] + 1e-12 * trace;
    }
    let mut x = *right;
    match factor(&mut a, Pivot::AtLeast(1e-30)) {
        Some(()) => solve(&a, &mut x),
        None => x = [0.0; VALUES],
    }
    x
}

/// The covariance of the logarithms where each coordinate is off by this variance (m2).
fn spread(normal: &[[f64; VALUES]; VALUES], variance: f64) -> [[f64; VALUES]; VALUES] {
    let mut a = *normal;
    match factor(&mut a, Pivot::AtLeast(1e-30)) {
        Some(()) => toile_base::numeric::linear::inverse(&a).map(|row| row.map(|v| v * variance)),
        None => [[f64::INFINITY; VALUES]; VALUES],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A motion that each value shapes in its own way.
    fn motion(p: &[f64; VALUES], frames: usize) -> Result<Vec<Vec<Vec3>>, ()> {
        let at = |f: usize, i: usize| {
            let (t, s) = (f as f64 * 0.1, i as f64 * 0.2);
            let swing = (t * p[0].sqrt()).sin() * (-p[3] * t).exp();
            Vec3::new((swing + s / p[1]) as f32, (s * s / p[2]) as f32, (swing * s) as f32) * 0.1
        };
        Ok((0..frames).map(|f| (0..9).map(|i| at(f, i)).collect()).collect())
    }

    #[test]
    fn values_come_back_from_the_motion_that_they_made() {
        let truth = [4.0, 2.0, 0.7, 0.3];
        let found = recover([5.0, 1.0, 1.4, 0.15], &motion(&truth, 40).unwrap(), motion).unwrap();
        for (v, t) in found.values.iter().zip(truth) {
            assert!((v / t - 1.0).abs() < 0.01, "{found:?}");
        }
        assert!(found.error_mm[1] < 0.1 * found.error_mm[0] && found.sigma.iter().all(|s| *s < 0.05), "{found:?}");
    }
}
