//! Measures of a state, the engine's or the oracle's own: energies and strain in f64.

use glam::DVec3;

use super::energy::bends;
use super::link_curve;
use super::problem::Problem;
use super::solution::State;

/// Energies of a state (J).
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Energies {
    /// Of motion, of the free particles.
    pub kinetic_j: f64,
    /// Of stretch and shear: (1/2) C^2 / compliance, or the energy of its curve. Inextensible links hold none; see [`strain`] for their
    /// error.
    pub stretch_j: f64,
    /// Of bending (J).
    pub bending_j: f64,
    /// In the field of gravity, 0 at the origin, of the free particles.
    pub gravity_j: f64,
}

impl Energies {
    /// All together (J).
    pub fn total_j(&self) -> f64 {
        self.kinetic_j + self.stretch_j + self.bending_j + self.gravity_j
    }
}

/// Strain of links (1), compression counted as stretch is.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct LinkStrain {
    /// Mean of the absolute values.
    pub mean: f64,
    /// Largest absolute value.
    pub max: f64,
}

/// Energies of a state.
pub fn energies(problem: &Problem, state: &State) -> Energies {
    let moving = problem.mass.iter().zip(&state.v).map(|(m, v)| 0.5 * m * v.length_squared());
    let stretch = problem.links.iter().enumerate().filter(|(_, l)| l.compliance > 0.0).map(|(e, l)| {
        let strain = strain_of(l.ends, l.rest, &state.x);
        match problem.link_curves.get(e) {
            Some(of) => l.rest * link_curve::energy(of, strain),
            None => (strain * l.rest).powi(2) * 0.5 / l.compliance,
        }
    });
    let height = problem.mass.iter().zip(&state.x).map(|(m, x)| -m * problem.gravity.dot(*x));
    Energies {
        kinetic_j: moving.sum(),
        stretch_j: stretch.sum(),
        bending_j: bends::value(&problem.bends, &state.x),
        gravity_j: height.sum(),
    }
}

/// Strain of each link (1) `[links]`.
pub fn strains(problem: &Problem, x: &[DVec3]) -> Vec<f64> {
    problem.links.iter().map(|l| strain_of(l.ends, l.rest, x)).collect()
}

/// Strain of all links together.
pub fn strain(problem: &Problem, x: &[DVec3]) -> LinkStrain {
    let each = strains(problem, x);
    let sum: f64 = each.iter().map(|s| s.abs()).sum();
    LinkStrain { mean: sum / each.len().max(1) as f64, max: each.iter().fold(0.0, |most: f64, s| most.max(s.abs())) }
}

fn strain_of(ends: [u32; 2], rest: f64, x: &[DVec3]) -> f64 {
    x[ends[0] as usize].distance(x[ends[1] as usize]) / rest - 1.0
}

/// Apart between the particles of two states (m).
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Distances {
    /// Mean over the particles.
    pub mean_m: f64,
    /// Largest over the particles (m).
    pub max_m: f64,
}

/// How far each particle of a state is from the same particle of another.
pub fn apart(a: &[DVec3], b: &[DVec3]) -> Distances {
    let each = || a.iter().zip(b).map(|(a, b)| a.distance(*b));
    Distances { mean_m: each().sum::<f64>() / a.len().max(1) as f64, max_m: each().fold(0.0, f64::max) }
}
