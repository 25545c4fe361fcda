//! The energies whose sum is at its least in a solution, each with value, gradient and Hessian.

pub mod bends;
pub mod contact;
pub mod friction;
pub mod links;
pub mod load;

use glam::{DMat3, DVec3};

use super::problem::Problem;
use super::solution::Violation;
use super::system::System;
use contact::Contact;
use friction::Friction;
use links::Springs;
use load::Load;

/// The sum of all.
#[derive(Debug)]
pub struct TotalEnergy<'a> {
    /// The problem that is solved.
    pub problem: &'a Problem,
    /// Weight or inertia.
    pub load: Load,
    /// Stretch of all links.
    pub springs: Springs<'a>,
    /// Contact of particles with solids.
    pub contact: Contact<'a>,
    /// Friction, where there is any.
    pub friction: Option<Friction<'a>>,
}

impl TotalEnergy<'_> {
    /// Energy (J), with what multipliers add.
    pub fn value(&self, x: &[DVec3]) -> f64 {
        let friction = self.friction.as_ref().map_or(0.0, |f| f.value(x));
        let elastic = self.springs.value(x) + bends::value(&self.problem.bends, x);
        self.load.value(&self.problem.mass, x) + elastic + self.contact.value(x) + friction
    }

    /// Gradient (N), 0 at pinned particles.
    pub fn gradient(&self, x: &[DVec3]) -> Vec<DVec3> {
        let mut g = vec![DVec3::ZERO; x.len()];
        self.load.gradient(&self.problem.mass, x, &mut g);
        self.springs.gradient(x, &mut g);
        bends::gradient(&self.problem.bends, x, &mut g);
        self.contact.gradient(x, &mut g);
        if let Some(friction) = &self.friction {
            friction.gradient(x, &mut g);
        }
        g.iter_mut().zip(&self.problem.mass).filter(|(_, m)| **m <= 0.0).for_each(|(g, _)| *g = DVec3::ZERO);
        g
    }

    /// Writes the Hessian (N/m), or where it is not to be `exact` what of it is positive, and `shift` (1/s2) times the
    /// masses.
    pub fn hessian(&self, x: &[DVec3], exact: bool, shift: f64, to: &mut System) {
        to.clear();
        self.load.hessian(&self.problem.mass, to);
        self.springs.hessian(x, exact, to);
        bends::hessian(&self.problem.bends, to);
        self.contact.hessian(x, exact, to);
        if let Some(friction) = &self.friction {
            friction.hessian(x, to);
        }
        if shift > 0.0 {
            self.problem.mass.iter().enumerate().for_each(|(i, m)| to.add(i, &(DMat3::IDENTITY * (m * shift))));
        }
    }

    /// Takes the forces at `x` for those of the next round.
    pub fn update(&mut self, x: &[DVec3]) -> Violation {
        let strain = self.springs.strain_off(x);
        self.springs.update(x);
        let touches = self.contact.touches(x);
        let friction_n = self.friction.as_mut().map_or(0.0, |f| f.update(x, &touches));
        let [penetration_m, gap_m] = self.contact.update(x);
        Violation { strain, penetration_m, gap_m, friction_n }
    }
}
