//! The oracle: an independent f64 solver of the engine's discretisation, by which the engine's solver error is measured.
//!
//! Reads: a [`Problem`] (particles, links, stencils of a baked garment) and [`Solids`]. Writes: x* of one implicit Euler
//! step or of statics, with tensions, contact forces and what is left of every residual.
//! Budget: a Newton iteration of 4,096 particles well below a second; never inside the frame.
//! Thread: the caller's; it shares no solver code with the engine.
//!
//! x* is where the sum of inertia or weight, stretch, bending, contact and friction is at its least: Newton's method with
//! a line search (`newton`) on a sparse Cholesky factorisation (`system`), inside rounds of the method of multipliers
//! for what does not stretch and for contact (`energy`), so that neither needs a stiffness without bound.
//!
//! ```
//! use toile_perf::oracle::{Oracle, Problem, Solids, State, Step};
//! # use glam::DVec3;
//! # use toile_perf::oracle::Link;
//! // `Problem::of(&garment)`, or plain data: a mass that hangs from a pin by 1 m of thread.
//! let problem = Problem {
//!     mass: vec![0.0, 0.01],
//!     start: vec![DVec3::ZERO, DVec3::X],
//!     links: vec![Link { ends: [0, 1], rest: 1.0, compliance: 0.0 }],
//!     gravity: DVec3::new(0.0, -9.81, 0.0),
//!     ..Problem::default()
//! };
//! let start = State::at_rest(&problem.start);
//! let mut oracle = Oracle::new(problem)?;
//! let fallen = oracle.step(&start, &Step::of(1.0 / 120.0))?;
//! assert!(fallen.state.x[1].y < 0.0 && fallen.report.residual_n < 1e-10);
//! let hanging = oracle.equilibrium(&start.x, &Solids::default())?;
//! assert!((hanging.tension_n[0] - 0.0981).abs() < 1e-9 && hanging.report.stable);
//! # Ok::<(), toile_perf::oracle::OracleError>(())
//! ```

pub mod adapter;
mod cholesky;
mod energy;
mod equilibrium;
mod leap;
pub mod measure;
mod newton;
mod problem;
mod settle;
mod solids;
mod system;
#[cfg(test)]
mod tests;

use std::fmt;

use glam::DVec3;
use thiserror::Error;

pub use energy::Violation;
pub use energy::contact::Touch;
pub use problem::{Bend, Link, Problem};
pub use settle::Oracle;
pub use solids::{Ball, Plane, Solids};

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

/// One implicit Euler step and what the surroundings do in it.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Step {
    /// Length (s).
    pub dt: f64,
    /// Share of the velocity that the air leaves, as the engine takes it in each substep: v = (v + g dt) kept, with
    /// kept = exp(-damping_per_s dt). 1 is no damping.
    pub kept: f64,
    /// Where the pinned particles are at the end (m), in the order of their numbers; empty where they stay `[pinned]`.
    pub pins: Vec<DVec3>,
    /// The solids at the start and at the end.
    pub solids: [Solids; 2],
}

impl Step {
    /// A step without air, solids or motion of the pins.
    pub fn of(dt: f64) -> Self {
        Self { dt, kept: 1.0, ..Self::default() }
    }
}

/// What counts as solved, and how much may be tried.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Options {
    /// Largest force that may be left on any particle (N); times the weight of the garment where that is above 1 N.
    pub residual_n: f64,
    /// Strain by which a stiff link may be off the length that its tension asks for (1).
    pub strain: f64,
    /// Penetration, or gap under a contact force, that may be left (m).
    pub gap_m: f64,
    /// Change of a friction force's limit from round to round that may be left (N); times the weight as above.
    pub friction_n: f64,
    /// Links stiffer than this are solved by multipliers with this stiffness (N/m), or a higher one where masses and
    /// time step ask for it.
    pub link_stiffness_n_m: f64,
    /// Stiffness of the multipliers of contact (N/m), or a higher one likewise.
    pub contact_stiffness_n_m: f64,
    /// Speed below which friction is not yet whole (m/s): what sticks creeps with less.
    pub creep_m_s: f64,
    /// Newton iterations in all.
    pub most_iterations: usize,
    /// Rounds of the method of multipliers.
    pub most_rounds: usize,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            residual_n: 1e-10,
            strain: 1e-8,
            gap_m: 1e-8,
            friction_n: 1e-8,
            link_stiffness_n_m: 2e4,
            contact_stiffness_n_m: 1e3,
            creep_m_s: 1e-5,
            most_iterations: 3_000,
            most_rounds: 200,
        }
    }
}

/// How a solution was reached, and how exact it is.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Report {
    /// Newton iterations.
    pub iterations: usize,
    /// Rounds of the method of multipliers.
    pub rounds: usize,
    /// Sparse factorisations.
    pub factorisations: usize,
    /// Largest force left on any particle (N).
    pub residual_n: f64,
    /// What is left of the constraints.
    pub violation: Violation,
    /// Whether the exact Hessian is positive definite there: a minimum, not a saddle.
    pub stable: bool,
}

/// A solution.
#[derive(Clone, PartialEq, Default)]
pub struct Solved {
    /// Positions, and velocities: 0 in statics.
    pub state: State,
    /// Tension of each link (N), positive where it pulls `[links]`.
    pub tension_n: Vec<f64>,
    /// What is pressed against the solids.
    pub touches: Vec<Touch>,
    /// How exact it is.
    pub report: Report,
}

impl fmt::Debug for Solved {
    /// How it was reached; the numbers of thousands of particles say little.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Solved").field("report", &self.report).finish_non_exhaustive()
    }
}

/// Why there is no solution.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum OracleError {
    /// Arrays that do not fit together.
    #[error("{what} has {got} entries, but {expected} are needed; give one for each particle that it is about")]
    Length {
        /// The array.
        what: &'static str,
        /// Its length.
        got: usize,
        /// What is needed.
        expected: usize,
    },
    /// A figure that cannot be used.
    #[error("{what} {at} has a figure that is not finite or out of range; correct it")]
    Unusable {
        /// What it is a figure of.
        what: &'static str,
        /// Which of them.
        at: usize,
    },
    /// Iterations ran out, or nothing more could be gained.
    #[error(
        "no solution after {} Newton iterations: {:.1e} N are left on a particle; start nearer or allow more iterations",
        .0.report.iterations, .0.report.residual_n
    )]
    NotConverged(
        /// The best that was found; not a solution.
        Box<Solved>,
    ),
}
