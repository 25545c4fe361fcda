//! The oracle: an independent f64 solver of the engine's discretisation, by which the engine's solver error is measured.
//! It shares no solver code with the engine.
//!
//! x* is where the sum of inertia or weight, stretch, bending, contact and friction is at its least: Newton's method with
//! a line search (`newton`) on a sparse Cholesky factorisation (`system`), inside rounds of the method of multipliers
//! for what does not stretch and for contact (`energy`), so that neither needs a stiffness without bound.
//!
//! ```
//! use toile_perf::oracle::{Oracle, Problem, Solids, State, OracleStep};
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
//! let fallen = oracle.step(&start, &OracleStep::of(1.0 / 120.0))?;
//! assert!(fallen.state.x[1].y < 0.0 && fallen.report.residual_n < 1e-10);
//! let hanging = oracle.equilibrium(&start.x, &Solids::default())?;
//! assert!((hanging.tension_n[0] - 0.0981).abs() < 1e-9 && hanging.report.stable);
//! # Ok::<(), toile_perf::oracle::OracleError>(())
//! ```

pub mod adapter;
mod cholesky;
mod energy;
mod equilibrium;
mod error;
mod leap;
mod link_curve;
pub mod measure;
mod newton;
mod options;
mod problem;
mod settle;
mod solids;
mod solution;
mod system;
#[cfg(test)]
mod tests;

pub use error::OracleError;
pub use options::{OracleOptions, OracleStep};
pub use problem::{Bend, Link, Problem};
pub use settle::Oracle;
pub use solids::{Ball, Plane, Solids};
pub use solution::{SolveReport, Solved, State, Touch, Violation};
