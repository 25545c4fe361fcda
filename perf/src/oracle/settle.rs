//! Steps and statics: rounds of the method of multipliers around Newton's method.

use glam::DVec3;

use super::energy::contact::Contact;
use super::energy::friction::Friction;
use super::energy::links::Springs;
use super::energy::load::Load;
use super::energy::{Landscape, Violation};
use super::newton::{self, Aim, Stance};
use super::problem::{Problem, expect};
use super::system::System;
use super::{Options, OracleError, Report, Solids, Solved, State, Step};

/// Residual of the first round (N); later rounds ask for [`SHARPER`] of the one before.
const FIRST_RESIDUAL_N: f64 = 1e-5;

/// See [`FIRST_RESIDUAL_N`].
const SHARPER: f64 = 0.01;

/// Shift that statics start with (1/s2): an implicit step of a tenth of a second.
const FIRST_SHIFT: f64 = 100.0;

/// How much stiffer multipliers are than what they hold.
const STIFFER: f64 = 10.0;

/// Length over which a contact yields to the weight at most (m).
const CONTACT_M: f64 = 0.1;

/// How far particles are put from a saddle (m).
const NUDGE_M: f64 = 1e-5;

/// How often a saddle is left.
const MOST_NUDGES: u64 = 6;

/// Length of the step that tells how hard particles press (s).
const PRESSING_S: f64 = 0.01;

/// Motion below which friction is not yet whole in statics (m).
const STATIC_SLIP_M: f64 = 1e-6;

/// The solver of one problem. It remembers the last solution's forces, from which the next one starts: they change how
/// long a solution takes and, below its tolerances, its digits.
#[derive(Debug)]
pub struct Oracle {
    problem: Problem,
    system: System,
    /// What counts as solved.
    pub options: Options,
    tension: Vec<f64>,
    pressure: Vec<f64>,
}

/// What one solution is made with.
struct Task {
    load: Load,
    /// Where to start from (m).
    from: Vec<DVec3>,
    /// Stiffness of what the load holds in place of links and particles (N/m).
    held: [f64; 2],
    shift: f64,
}

impl Oracle {
    /// Analyses a problem, with the usual options.
    ///
    /// # Errors
    /// Where the problem's arrays or figures cannot be used.
    pub fn new(problem: Problem) -> Result<Self, OracleError> {
        problem.check()?;
        let system = System::new(&problem)?;
        let tension = vec![0.0; problem.links.len()];
        Ok(Self { problem, system, options: Options::default(), tension, pressure: Vec::new() })
    }

    /// What is solved.
    pub fn problem(&self) -> &Problem {
        &self.problem
    }

    /// Forgets the forces of the last solution.
    pub fn forget(&mut self) {
        self.tension.fill(0.0);
        self.pressure.clear();
    }

    /// x* of one implicit Euler step from a state: what the engine's substep approximates.
    ///
    /// # Errors
    /// Where the figures cannot be used, or no solution is found.
    pub fn step(&mut self, state: &State, step: &Step) -> Result<Solved, OracleError> {
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
        let task = Task { load: Load::Inertia { target, per_dt2 }, from, held, shift: 0.0 };
        let slip_m = self.options.creep_m_s * dt;
        let both = || [step.solids[0].shapes(), step.solids[1].shapes()];
        let friction = (p.friction > 0.0).then(|| Friction::new(p.friction, slip_m, &state.x, both()));
        let mut solved = self.solve(task, &step.solids[1], friction)?;
        let v = solved.state.x.iter().zip(&state.x).map(|(after, before)| (*after - *before) / dt).collect();
        solved.state.v = v;
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
        mut around: impl FnMut(usize) -> Step,
    ) -> Result<Vec<Solved>, OracleError> {
        let mut out: Vec<Solved> = Vec::with_capacity(steps);
        for k in 0..steps {
            let solved = self.step(out.last().map_or(start, |s| &s.state), &around(k))?;
            out.push(solved);
        }
        Ok(out)
    }

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
        let (weight, mu) = (weight(&self.problem), self.problem.friction);
        let task = |from: Vec<DVec3>, problem: &Problem| Task {
            load: Load::Weight { gravity: problem.gravity, from: start.to_vec() },
            from,
            held: [weight / shortest(problem), weight / CONTACT_M],
            shift: FIRST_SHIFT,
        };
        let grip = || {
            let both = [solids.shapes(), solids.shapes()];
            (held && mu > 0.0).then(|| Friction::new(mu, STATIC_SLIP_M, start, both))
        };
        if held {
            // How hard each particle presses, before the first round lets any slide.
            let step = Step { solids: [solids.clone(), solids.clone()], ..Step::of(PRESSING_S) };
            self.step(&State::at_rest(start), &step)?;
        }
        let mut solved = self.solve(task(start.to_vec(), &self.problem), solids, grip())?;
        for seed in 0..MOST_NUDGES {
            if solved.report.stable {
                break;
            }
            let before = solved.report;
            let from = nudged(&self.problem, &solved.state.x, seed);
            solved = self.solve(task(from, &self.problem), solids, grip())?;
            solved.report.iterations += before.iterations;
            solved.report.rounds += before.rounds;
            solved.report.factorisations += before.factorisations;
        }
        Ok(solved)
    }

    fn check(&self, state: &State, solids: &Solids) -> Result<(), OracleError> {
        expect("positions", state.x.len(), self.problem.particles())?;
        expect("velocities", state.v.len(), self.problem.particles())?;
        let bad = (0..state.x.len()).find(|&i| !(state.x[i].is_finite() && state.v[i].is_finite()));
        if let Some(at) = bad {
            return Err(OracleError::Unusable { what: "particle", at });
        }
        if solids.is_sound() { Ok(()) } else { Err(OracleError::Unusable { what: "solids", at: 0 }) }
    }

    fn check_step(&self, state: &State, step: &Step) -> Result<(), OracleError> {
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
    fn solve(&mut self, task: Task, solids: &Solids, friction: Option<Friction<'_>>) -> Result<Solved, OracleError> {
        let options = self.options;
        let weight = weight(&self.problem).max(1.0);
        let rho = [options.link_stiffness_n_m, options.contact_stiffness_n_m];
        let rho = [0, 1].map(|k| rho[k].max(STIFFER * task.held[k]));
        let mut landscape = Landscape {
            problem: &self.problem,
            load: task.load,
            springs: Springs::new(&self.problem.links, rho[0], std::mem::take(&mut self.tension)),
            contact: Contact::new(&self.problem, solids.shapes(), rho[1], std::mem::take(&mut self.pressure)),
            friction,
        };
        let mut x = task.from;
        if let Some(friction) = &mut landscape.friction {
            friction.update(&x, &landscape.contact.touches(&x));
        }
        let mut stance = Stance::new(task.shift);
        let factored = self.system.factored;
        let goal = options.residual_n * weight;
        let mut aim = Aim { residual_n: goal.max(FIRST_RESIDUAL_N * weight), most: options.most_iterations };
        let mut report = Report::default();
        let mut done = false;
        let (mut tension_n, mut touches) = (Vec::new(), Vec::new());
        while !done && report.rounds < options.most_rounds && stance.iterations < options.most_iterations {
            report.rounds += 1;
            report.residual_n = newton::minimise(&landscape, &mut self.system, &mut x, &mut stance, aim);
            tension_n = landscape.springs.tensions(&x);
            touches = landscape.contact.touches(&x);
            report.violation = landscape.update(&x);
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
        if done { Ok(solved) } else { Err(OracleError::NotConverged(Box::new(solved))) }
    }
}

/// Whether constraints are met.
fn within(v: &Violation, options: &Options, weight: f64) -> bool {
    let apart = v.penetration_m.max(v.gap_m) <= options.gap_m;
    v.strain <= options.strain && apart && v.friction_n <= options.friction_n * weight
}

/// Weight of all that is free (N).
fn weight(problem: &Problem) -> f64 {
    problem.free_mass() * problem.gravity.length()
}

/// The largest mass that a link moves by itself (kg).
fn heaviest_link(problem: &Problem) -> f64 {
    let weight = |i: u32| if problem.pinned(i as usize) { 0.0 } else { problem.mass[i as usize].recip() };
    let moved = problem.links.iter().map(|l| weight(l.ends[0]) + weight(l.ends[1]));
    moved.filter(|w| *w > 0.0).map(f64::recip).fold(0.0, f64::max)
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
