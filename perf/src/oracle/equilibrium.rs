//! Statics: the state at which nothing moves.
//!
//! The shift of Newton's method starts as an implicit step of a tenth of a second and goes away as the cloth comes to
//! rest, so that a start far from rest is a fall through air that takes all speed.

use glam::DVec3;

use super::energy::friction::Friction;
use super::energy::load::Load;
use super::error::OracleError;
use super::link_curve;
use super::options::OracleStep;
use super::problem::Problem;
use super::settle::{Oracle, SolveTask, weight};
use super::solids::Solids;
use super::solution::{Solved, State};

/// Shift that statics start with (1/s2): an implicit step of a tenth of a second.
const FIRST_SHIFT: f64 = 100.0;

/// How much stiffer the multipliers of links and contact are than the weight; more would narrow the way.
const STATICS_STIFFER: [f64; 2] = [10.0, 10.0];

/// Length over which a contact yields to the weight at most (m).
const CONTACT_M: f64 = 0.1;

/// How far particles are put from a saddle (m).
const NUDGE_M: f64 = 1e-5;

/// How often a saddle is left.
const MOST_NUDGES: u64 = 6;

/// Length of the step that shows how hard particles press (s).
const PRESSING_S: f64 = 0.01;

/// Motion below which friction is not yet whole in statics (m).
const STATIC_SLIP_M: f64 = 1e-6;

impl Oracle {
    /// x* of statics without friction: the minimum of weight, stretch, bending and contact that is reached downhill from
    /// `start`, in which pinned particles already are where they are to stay. Cloth that folds has many; one that is only
    /// a saddle is left in a fixed direction.
    ///
    /// # Errors
    /// Where the figures cannot be used, or no solution is found.
    pub fn equilibrium(&mut self, start: &[DVec3], solids: &Solids) -> Result<Solved, OracleError> {
        self.statics(start, solids, false)
    }

    /// The same with friction that holds every particle to the point of the surface where it is at `start`, until more
    /// than Coulomb's limit pulls at it: where cloth that came to lie at `start` by sliding stays.
    ///
    /// # Errors
    /// As [`Self::equilibrium`].
    pub fn held_equilibrium(&mut self, start: &[DVec3], solids: &Solids) -> Result<Solved, OracleError> {
        self.statics(start, solids, true)
    }

    fn statics(&mut self, start: &[DVec3], solids: &Solids, held: bool) -> Result<Solved, OracleError> {
        self.check(&State::at_rest(start), solids)?;
        // What is found depends on the start alone.
        self.forget();
        let (weight, mu) = (weight(self.problem()), self.problem().friction);
        let task = |from: Vec<DVec3>, problem: &Problem| SolveTask {
            load: Load::Weight { gravity: problem.gravity, from: start.to_vec() },
            from,
            held: [weight / shortest(problem), weight / CONTACT_M],
            stiffer: STATICS_STIFFER,
            shift: FIRST_SHIFT,
            link_curves: link_curve::from_state(&problem.links, &problem.link_curves, start),
        };
        let grip = || {
            let both = [solids.shapes(), solids.shapes()];
            (held && mu > 0.0).then(|| Friction::new(mu, STATIC_SLIP_M, start, both))
        };
        if held {
            // How hard each particle presses, before the first round lets any slide.
            let step = OracleStep { solids: [solids.clone(), solids.clone()], ..OracleStep::of(PRESSING_S) };
            self.step(&State::at_rest(start), &step)?;
        }
        let mut solved = self.solve(task(start.to_vec(), self.problem()), solids, grip())?;
        for seed in 0..MOST_NUDGES {
            if solved.report.stable {
                break;
            }
            let before = solved.report;
            let from = nudged(self.problem(), &solved.state.x, seed);
            solved = self.solve(task(from, self.problem()), solids, grip())?;
            solved.report.iterations += before.iterations;
            solved.report.rounds += before.rounds;
            solved.report.factorisations += before.factorisations;
        }
        Ok(solved)
    }
}

/// The shortest link (m).
fn shortest(problem: &Problem) -> f64 {
    let least = problem.links.iter().map(|l| l.rest).fold(f64::INFINITY, f64::min);
    if least.is_finite() { least } else { 1.0 }
}

/// Free particles moved a little, each in a direction of its own (splitmix64, Steele et al. 2014).
fn nudged(problem: &Problem, x: &[DVec3], seed: u64) -> Vec<DVec3> {
    let mut s = seed.wrapping_mul(0xD1B5_4A32_D192_ED03);
    let mut unit = || {
        s = s.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let z = (s ^ (s >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    };
    let mut moved = |i: usize, p: &DVec3| {
        let by = DVec3::new(unit(), unit(), unit());
        if problem.pinned(i) { *p } else { *p + by * NUDGE_M }
    };
    x.iter().enumerate().map(|(i, p)| moved(i, p)).collect()
}
