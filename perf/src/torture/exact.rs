//! A trial's cloth stepped by the oracle: exact implicit Euler steps in f64, as long as the engine's substeps.
//!
//! What does not come back here does not come back by solving more exactly; what does come back here and not by the engine is the
//! engine's own error.

use glam::{DVec3, Vec3A};
use toile_base::garment::Garment;
use toile_engine::cloth::{Cloth, Settings};
use toile_engine::colliders::Colliders;

use crate::oracle::{Ball, Oracle, OracleError, OracleOptions, OracleStep, Plane, Problem, Solids, State, adapter};

/// What counts as solved: a force of 1e-7 N moves the lightest particle of a piece by a nanometre in a substep.
const OPTIONS: OracleOptions = OracleOptions {
    residual_n: 1e-7,
    strain: 1e-6,
    gap_m: 1e-6,
    friction_n: 1e-5,
    link_stiffness_n_m: 2e4,
    contact_stiffness_n_m: 1e3,
    creep_m_s: 1e-5,
    most_iterations: 120,
    most_rounds: 12,
};

/// The oracle's own state of a cloth.
#[derive(Debug)]
pub struct ExactStepper {
    oracle: Oracle,
    state: State,
    /// What it last gave to the cloth (m): what is elsewhere was put there.
    given: Vec<Vec3A>,
    /// Substeps that were not solved as exactly as asked for.
    pub unsolved: u64,
}

impl ExactStepper {
    /// The oracle of a garment, as its cloth is.
    ///
    /// # Errors
    /// Where the garment's figures cannot be used.
    pub fn new(garment: &Garment, settings: &Settings, cloth: &Cloth) -> Result<Self, OracleError> {
        let gravity = glam::Vec3::from(settings.gravity).as_dvec3();
        let mut oracle = Oracle::new(Problem { gravity, ..Problem::of(garment) })?;
        oracle.options = OPTIONS;
        let given = vec![Vec3A::NAN; cloth.positions.len()];
        let state = State::at_rest(&adapter::positions(&cloth.positions));
        Ok(Self { oracle, state, given, unsolved: 0 })
    }

    /// Takes over what was put elsewhere since it last stepped.
    pub fn take(&mut self, cloth: &Cloth) {
        for (i, given) in self.given.iter().enumerate() {
            if cloth.positions[i] != *given {
                self.state.x[i] = cloth.positions[i].as_dvec3();
                self.state.v[i] = cloth.velocity(i).as_dvec3();
            }
        }
    }

    /// Steps a cloth once more that the engine has stepped: pins go where they went there.
    pub fn step(&mut self, cloth: &mut Cloth, garment: &Garment, settings: &Settings, colliders: &Colliders) {
        let substeps = settings.substeps_of(garment.substeps);
        let dt = f64::from(settings.step_seconds) / f64::from(substeps);
        let kept = (-f64::from(garment.fabric.damping_per_s) * dt).exp();
        let pins = |x: &dyn Fn(usize) -> DVec3| garment.fixed.iter().map(|&i| x(i as usize)).collect::<Vec<_>>();
        let [from, to] = [pins(&|i| self.state.x[i]), pins(&|i| cloth.positions[i].as_dvec3())];
        let around = adapter::solids(colliders);
        for substep in 0..substeps {
            let [begin, end] = [substep, substep + 1].map(|s| f64::from(s) / f64::from(substeps));
            let pins = from.iter().zip(&to).map(|(a, b)| a.lerp(*b, end)).collect();
            let solids = [begin, end].map(|at| between(&around, at));
            self.substep(&OracleStep { dt, kept, pins, solids }, f64::from(settings.max_speed));
        }
        for (i, w) in garment.inverse_mass.iter().enumerate() {
            if *w > 0.0 {
                cloth.disturb(i, self.state.x[i].as_vec3a(), self.state.v[i].as_vec3a());
            }
            self.given[i] = cloth.positions[i];
        }
    }

    /// One substep, within the speed limit, as the engine keeps it.
    fn substep(&mut self, step: &OracleStep, max_speed: f64) {
        let solved = match self.oracle.step(&self.state, step) {
            Ok(solved) => solved.state.x,
            Err(OracleError::NotConverged(near)) => {
                self.unsolved += 1;
                near.state.x
            }
            // Nothing that can be stepped: it stays, and is seen not to come back.
            Err(_) => {
                self.unsolved += 1;
                return;
            }
        };
        let free = |i: usize| !self.oracle.problem().pinned(i);
        for (i, x) in solved.into_iter().enumerate() {
            let way = x - self.state.x[i];
            let held = if free(i) { way.clamp_length_max(max_speed * step.dt) } else { way };
            self.state.x[i] += held;
            self.state.v[i] = held / step.dt;
        }
    }
}

/// Solids on their way from the start to the end of a step.
fn between([start, end]: &[Solids; 2], at: f64) -> Solids {
    let ball = |a: &Ball, b: &Ball| Ball {
        centre: a.centre.lerp(b.centre, at),
        radius: a.radius + (b.radius - a.radius) * at,
    };
    let cones = start.cones.iter().zip(&end.cones).map(|(a, b)| [ball(&a[0], &b[0]), ball(&a[1], &b[1])]).collect();
    Solids { cones, planes: start.planes.iter().map(|p| Plane { ..*p }).collect() }
}
