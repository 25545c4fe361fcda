//! A state, a solution, and its error.

use std::fmt;

use glam::DVec3;

/// Positions and velocities.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct State {
    /// World position (m) `[particles]`.
    pub x: Vec<DVec3>,
    /// Velocity (m/s) `[particles]`.
    pub v: Vec<DVec3>,
}

impl State {
    /// At rest at these positions (m).
    pub fn at_rest(x: &[DVec3]) -> Self {
        Self { x: x.to_vec(), v: vec![DVec3::ZERO; x.len()] }
    }
}

/// A particle that is pressed against a solid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Touch {
    /// Index of the particle.
    pub particle: usize,
    /// The solid, cones first.
    pub solid: usize,
    /// Force along the normal (N).
    pub force_n: f64,
}

/// How far a state is from what the multipliers are to bring about.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Violation {
    /// Strain by which a stiff link is off the length that its tension asks for (1).
    pub strain: f64,
    /// Deepest penetration (m).
    pub penetration_m: f64,
    /// Widest gap across which a contact force acts (m).
    pub gap_m: f64,
    /// Change of a friction force's limit since the round before (N).
    pub friction_n: f64,
}

/// How a solution was reached, and how exact it is.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SolveReport {
    /// Iterations of Newton's method, over all rounds.
    pub iterations: usize,
    /// Rounds of the method of multipliers.
    pub rounds: usize,
    /// Factorisations of a sparse matrix.
    pub factorisations: usize,
    /// Largest force left on any particle (N).
    pub residual_n: f64,
    /// What is left of the constraints.
    pub violation: Violation,
    /// Whether the exact Hessian is positive definite there: a minimum, not a saddle.
    pub stable: bool,
}

/// The solution of a problem, with its forces and how exact it is.
#[derive(Clone, PartialEq, Default)]
pub struct Solved {
    /// Positions, and velocities: 0 in statics.
    pub state: State,
    /// Tension of each link (N), positive where it pulls `[links]`.
    pub tension_n: Vec<f64>,
    /// What is pressed against the solids.
    pub touches: Vec<Touch>,
    /// How exact it is.
    pub report: SolveReport,
}

impl fmt::Debug for Solved {
    /// How it was reached; the numbers of thousands of particles say little.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Solved").field("report", &self.report).finish_non_exhaustive()
    }
}
