//! What drives the cloth: its weight at rest, or its inertia over one implicit Euler step.

use glam::{DMat3, DVec3};

use super::super::system::System;

/// One of both, over the free particles.
#[derive(Debug)]
pub enum Load {
    /// Potential -m g . (x - from): statics.
    Weight {
        /// Acceleration of gravity (m/s2).
        gravity: DVec3,
        /// Where the potential is 0 (m) `[particles]`: near the state, so that no digits are lost.
        from: Vec<DVec3>,
    },
    /// (1/2) m |x - target|^2 / dt^2 (Martin et al. 2011, "Example-based elastic materials", eq. 4): its minimum together
    /// with the potentials is one step of implicit Euler. Gravity is within the target.
    Inertia {
        /// Where each particle would be if nothing held it (m) `[particles]`.
        target: Vec<DVec3>,
        /// 1 / dt^2 (1/s2).
        per_dt2: f64,
    },
}

impl Load {
    /// Energy of weight or inertia (J).
    pub fn value(&self, mass: &[f64], x: &[DVec3]) -> f64 {
        match self {
            Self::Weight { gravity, from } => {
                -mass.iter().zip(x).zip(from).map(|((m, x), f)| m * gravity.dot(*x - *f)).sum::<f64>()
            }
            Self::Inertia { target, per_dt2 } => {
                let each = mass.iter().zip(x).zip(target).map(|((m, x), t)| 0.5 * m * (*x - *t).length_squared());
                per_dt2 * each.sum::<f64>()
            }
        }
    }

    /// Adds the gradient (N).
    pub fn gradient(&self, mass: &[f64], x: &[DVec3], to: &mut [DVec3]) {
        match self {
            Self::Weight { gravity, .. } => to.iter_mut().zip(mass).for_each(|(g, m)| *g -= *gravity * *m),
            Self::Inertia { target, per_dt2 } => {
                let pulls = mass.iter().zip(x).zip(target).map(|((m, x), t)| (*x - *t) * (m * per_dt2));
                to.iter_mut().zip(pulls).for_each(|(g, pull)| *g += pull);
            }
        }
    }

    /// Adds the Hessian (N/m).
    pub fn hessian(&self, mass: &[f64], to: &mut System) {
        if let Self::Inertia { per_dt2, .. } = self {
            mass.iter().enumerate().for_each(|(i, m)| to.add(i, &(DMat3::IDENTITY * (m * per_dt2))));
        }
    }
}
