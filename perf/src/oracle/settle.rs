//! The solver: rounds of the method of multipliers around Newton's method, and one step of implicit Euler by it.

use glam::DVec3;
use toile_base::fabric::link_curve::LinkCurve;

use super::energy::TotalEnergy;
use super::energy::contact::Contact;
use super::energy::friction::Friction;
use super::energy::links::Springs;
use super::energy::load::Load;
use super::error::OracleError;
use super::leap::Leaps;
use super::link_curve;
use super::newton::{self, NewtonState, StopRule};
use super::options::{OracleOptions, OracleStep};
use super::problem::{Problem, expect};
use super::solids::Solids;
use super::solution::{SolveReport, Solved, State, Violation};
use super::system::System;

/// Residual of the first round (N); later rounds ask for [`SHARPER`] of the one before.
const FIRST_RESIDUAL_N: f64 = 1e-5;

/// Residual of each round after the first, as a share of the one before (1); see [`FIRST_RESIDUAL_N`].
const SHARPER: f64 = 0.01;

/// How much stiffer the multipliers of links and contact are than what they hold: of the order of how many links lie in
/// series, squared, in a step, in which they start from those of the step before.
const STEP_STIFFER: [f64; 2] = [4_000.0, 100.0];

/// Least factor of that kind.
const LEAST_STIFFER: f64 = 10.0;

/// Roundings of a position that add up to the residual of a particle.
const ROUNDINGS: f64 = 8.0;

/// The solver of one problem. It remembers the last solution's forces, from which the next step starts: they change how
/// long that takes and, below its tolerances, its digits.
#[derive(Debug)]
pub struct Oracle {
    problem: Problem,
    system: System,
    /// What counts as solved.
    pub options: OracleOptions,
    tension: Vec<f64>,
    pressure: Vec<f64>,
}

/// What one solution is made with.
pub(super) struct SolveTask {
    /// Weight or inertia.
    pub load: Load,
    /// Where to start from (m).
    pub from: Vec<DVec3>,
    /// Stiffness with which the load resists at links and at particles (N/m).
    pub held: [f64; 2],
    /// How much stiffer than that multipliers are to be.
    pub stiffer: [f64; 2],
    /// First shift of the Hessian (1/s2).
    pub shift: f64,
    /// Curves of the links as they act in it `[links]`, or empty.
    pub link_curves: Vec<LinkCurve>,
}

impl Oracle {
    /// Analyses a problem, with the usual options.
    ///
    /// # Errors
    /// Where the problem's arrays or figures cannot be used.
    pub fn new(problem: Problem) -> Result<Self, OracleError> {
        problem.check()?;
        let system = System::new(&problem);
        let tension = vec![0.0; problem.links.len()];
        Ok(Self { problem, system, options: OracleOptions::default(), tension, pressure: Vec::new() })
    }

    /// The problem that is solved.
    pub fn problem(&self) -> &Problem {
        &self.problem
    }

    /// Forgets the forces of the last solution.
    pub fn forget(&mut self) {
        self.tension.fill(0.0);
        self.pressure.clear();
    }

    /// x* of one implicit Euler step from a state: what the engine's substep approximates. Where links rub, they stick from then on
    /// where the step has left them.
    ///
    /// # Errors
    /// Where the figures cannot be used, or no solution is found.
    pub fn step(&mut self, state: &State, step: &OracleStep) -> Result<Solved, OracleError> {
        self.check_step(state, step)?;
        let [dt, per_dt2] = [step.dt, (step.dt * step.dt).recip()];
        let p = &self.problem;
        let mut target = state.x.clone();
        for (i, x) in target.iter_mut().enumerate().filter(|(i, _)| !p.pinned(*i)) {
            *x += (state.v[i] + p.gravity * dt) * (step.kept * dt);
        }
        let pinned = (0..p.particles()).filter(|i| p.pinned(*i));
        pinned.zip(&step.pins).for_each(|(i, pin)| target[i] = *pin);
        let mut from = state.x.clone();
        (0..p.particles()).filter(|i| p.pinned(*i)).for_each(|i| from[i] = target[i]);
        let held = [heaviest_link(p) * per_dt2, p.mass.iter().copied().fold(0.0, f64::max) * per_dt2];
        let link_curves = link_curve::from_state(&p.links, &p.link_curves, &state.x);
        let load = Load::Inertia { target, per_dt2 };
        let task = SolveTask { load, from, held, stiffer: STEP_STIFFER, shift: 0.0, link_curves };
        let slip_m = self.options.creep_m_s * dt;
        let both = || [step.solids[0].shapes(), step.solids[1].shapes()];
        let friction = (p.friction > 0.0).then(|| Friction::new(p.friction, slip_m, &state.x, both()));
        let mut solved = self.solve(task, &step.solids[1], friction)?;
        let v = solved.state.x.iter().zip(&state.x).map(|(after, before)| (*after - *before) / dt).collect();
        solved.state.v = v;
        link_curve::follow(&self.problem.links, &mut self.problem.link_curves, &solved.state.x);
        Ok(solved)
    }

    /// Many steps; `around(k)` says what the surroundings do in step k. Gives the solution of each.
    ///
    /// # Errors
    /// As [`Self::step`], at the first step that fails.
    pub fn trajectory(
        &mut self,
        start: &State,
        steps: usize,
        mut around: impl FnMut(usize) -> OracleStep,
    ) -> Result<Vec<Solved>, OracleError> {
        let mut out: Vec<Solved> = Vec::with_capacity(steps);
        for k in 0..steps {
            let solved = self.step(out.last().map_or(start, |s| &s.state), &around(k))?;
            out.push(solved);
        }
        Ok(out)
    }

    pub(super) fn check(&self, state: &State, solids: &Solids) -> Result<(), OracleError> {
        expect("positions", state.x.len(), self.problem.particles())?;
        expect("velocities", state.v.len(), self.problem.particles())?;
        let bad = (0..state.x.len()).find(|&i| !(state.x[i].is_finite() && state.v[i].is_finite()));
        if let Some(at) = bad {
            return Err(OracleError::Unusable { what: "particle", at });
        }
        if solids.is_sound() { Ok(()) } else { Err(OracleError::Unusable { what: "solids", at: 0 }) }
    }

    fn check_step(&self, state: &State, step: &OracleStep) -> Result<(), OracleError> {
        self.check(state, &step.solids[0])?;
        self.check(state, &step.solids[1])?;
        expect("solids at the start", step.solids[0].len(), step.solids[1].len())?;
        if !step.pins.is_empty() {
            let pinned = (0..self.problem.particles()).filter(|i| self.problem.pinned(*i)).count();
            expect("pins", step.pins.len(), pinned)?;
        }
        let sound = step.dt.is_finite() && step.dt > 0.0 && (0.0..=1.0).contains(&step.kept);
        let sound = sound && step.pins.iter().all(|p| p.is_finite());
        if sound { Ok(()) } else { Err(OracleError::Unusable { what: "step", at: 0 }) }
    }

    /// Rounds until residual and constraints are within their tolerances.
    pub(super) fn solve(
        &mut self,
        task: SolveTask,
        solids: &Solids,
        friction: Option<Friction<'_>>,
    ) -> Result<Solved, OracleError> {
        let options = self.options;
        let weight = weight(&self.problem).max(1.0);
        let asked = options.residual_n * weight;
        let rho = stiffness(&options, &task, asked);
        let goal = asked.max(rounding(&task.from) * rho[0].max(rho[1]));
        let mut landscape = TotalEnergy {
            problem: &self.problem,
            load: task.load,
            springs: Springs::new(&self.problem.links, task.link_curves, rho[0], std::mem::take(&mut self.tension)),
            contact: Contact::new(&self.problem, solids.shapes(), rho[1], std::mem::take(&mut self.pressure)),
            friction,
        };
        let mut x = task.from;
        if let Some(friction) = &mut landscape.friction {
            friction.update(&x, &landscape.contact.touches(&x));
        }
        let mut stance = NewtonState::new(task.shift);
        let factored = self.system.factored;
        let mut aim = StopRule { residual_n: goal.max(FIRST_RESIDUAL_N * weight), most: options.most_iterations };
        let mut report = SolveReport::default();
        let mut done = false;
        let mut leaps = Leaps::default();
        let (mut tension_n, mut touches) = (Vec::new(), Vec::new());
        while !done && report.rounds < options.most_rounds && stance.iterations < options.most_iterations {
            report.rounds += 1;
            report.residual_n = newton::minimise(&landscape, &mut self.system, &mut x, &mut stance, aim);
            tension_n = landscape.springs.tensions(&x);
            touches = landscape.contact.touches(&x);
            let multipliers = leaps.take(&landscape, &mut self.system, &x, options.strain);
            report.violation = landscape.update(&x);
            if let Some(multipliers) = multipliers {
                landscape.springs.multiplier = multipliers;
            }
            done = report.residual_n <= goal && within(&report.violation, &options, weight);
            aim.residual_n = goal.max(aim.residual_n * SHARPER);
        }
        landscape.hessian(&x, true, 0.0, &mut self.system);
        report.stable = self.system.factor();
        report.iterations = stance.iterations;
        report.factorisations = self.system.factored - factored;
        let solved = Solved { tension_n, touches, state: State::at_rest(&x), report };
        self.tension = landscape.springs.multiplier;
        self.pressure = landscape.contact.multiplier;
        if done {
            return Ok(solved);
        }
        self.forget();
        Err(OracleError::NotConverged(Box::new(solved)))
    }
}

/// Stiffness of the multipliers of links and contact (N/m): so much that few rounds are needed, but not so much that the
/// rounding of positions alone is a force above the goal (N).
fn stiffness(options: &OracleOptions, task: &SolveTask, goal: f64) -> [f64; 2] {
    let most = goal / rounding(&task.from);
    let least = [options.link_stiffness_n_m, options.contact_stiffness_n_m];
    [0, 1].map(|k| {
        let wanted = (task.stiffer[k] * task.held[k]).min(most);
        wanted.max(least[k]).max(LEAST_STIFFER * task.held[k])
    })
}

/// What the rounding of positions can add up to at one particle (m).
fn rounding(x: &[DVec3]) -> f64 {
    ROUNDINGS * f64::EPSILON * x.iter().map(|p| p.abs().max_element()).fold(1.0, f64::max)
}

/// Whether constraints are met.
fn within(v: &Violation, options: &OracleOptions, weight: f64) -> bool {
    let apart = v.penetration_m.max(v.gap_m) <= options.gap_m;
    v.strain <= options.strain && apart && v.friction_n <= options.friction_n * weight
}

/// Weight of all that is free (N).
pub(super) fn weight(problem: &Problem) -> f64 {
    problem.free_mass() * problem.gravity.length()
}

/// The largest mass that a link moves by itself (kg).
fn heaviest_link(problem: &Problem) -> f64 {
    let weight = |i: u32| if problem.pinned(i as usize) { 0.0 } else { problem.mass[i as usize].recip() };
    let moved = problem.links.iter().map(|l| weight(l.ends[0]) + weight(l.ends[1]));
    moved.filter(|w| *w > 0.0).map(f64::recip).fold(0.0, f64::max)
}
