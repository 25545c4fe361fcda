//! Options of the oracle: a step, and the condition that counts as solved.

use glam::DVec3;

use super::solids::Solids;

/// One implicit Euler step and what the surroundings do in it.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct OracleStep {
    /// Length of the step (s).
    pub dt: f64,
    /// Share of the velocity that the air leaves, as the engine takes it in each substep: v = (v + g dt) kept, with
    /// kept = exp(-damping_per_s dt). 1 is no damping.
    pub kept: f64,
    /// Where the pinned particles are at the end (m), in the order of their numbers; empty where they stay `[pinned]`.
    pub pins: Vec<DVec3>,
    /// The solids at the start and at the end.
    pub solids: [Solids; 2],
}

impl OracleStep {
    /// A step without air, solids or motion of the pins.
    pub fn of(dt: f64) -> Self {
        Self { dt, kept: 1.0, ..Self::default() }
    }
}

/// What counts as solved, and how much may be tried.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OracleOptions {
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

impl Default for OracleOptions {
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
