//! Contact without friction: no particle nearer to a solid than the offset, by the method of multipliers.
//!
//! For the gap C = distance - offset >= 0 with the force N >= 0 of the round before, the energy is
//! (rho / 2) max(0, N / rho - C)^2 (Rockafellar 1973; Nocedal & Wright 2006, eq. 17.65): once continuously
//! differentiable, one-sided, and where N no longer changes, C = 0 under every force, whatever rho is.
//!
//! Gradient: -F n with F = rho max(0, N / rho - C). Hessian: rho n n^T - F H with H, the distance's own second derivative,
//! positive semi-definite because solids are convex; so the second term is negative and the projection leaves it out.

use glam::DVec3;

use super::super::problem::Problem;
use super::super::solids::{SolidSurface, outer};
use super::super::solution::Touch;
use super::super::system::System;

/// All pairs of particle and solid.
#[derive(Debug)]
pub struct Contact<'a> {
    problem: &'a Problem,
    /// Distance functions of the solids, cones first.
    pub surfaces: Vec<SolidSurface>,
    rho: f64,
    /// Force of the round before (N) `[particles][solids]`.
    pub multiplier: Vec<f64>,
}

impl<'a> Contact<'a> {
    /// Contact with multipliers that start at `multiplier`, or at 0 where they are of another length.
    pub fn new(problem: &'a Problem, surfaces: Vec<SolidSurface>, rho: f64, multiplier: Vec<f64>) -> Self {
        let pairs = problem.particles() * surfaces.len();
        let multiplier = if multiplier.len() == pairs { multiplier } else { vec![0.0; pairs] };
        Self { problem, surfaces, rho, multiplier }
    }

    /// Whether a particle can meet a solid at all.
    fn meets(&self, particle: usize, solid: usize) -> bool {
        let open =
            self.problem.reach.is_empty() || solid >= 32 || matches!(self.surfaces[solid], SolidSurface::Plane(_));
        !self.problem.pinned(particle) && (open || self.problem.reach[particle] >> solid & 1 == 1)
    }

    /// Calls `each(particle, solid, gap, force)` for every pair that pushes.
    fn for_each(&self, x: &[DVec3], mut each: impl FnMut(usize, usize, f64, f64)) {
        let solids = self.surfaces.len();
        for (i, p) in x.iter().enumerate() {
            for (s, surface) in self.surfaces.iter().enumerate().filter(|(s, _)| self.meets(i, *s)) {
                let gap = surface.distance(*p) - self.problem.offset_m;
                let force = self.multiplier[i * solids + s] - self.rho * gap;
                if force > 0.0 {
                    each(i, s, gap, force);
                }
            }
        }
    }

    /// Energy (J), with what the multipliers add.
    pub fn value(&self, x: &[DVec3]) -> f64 {
        let mut sum = 0.0;
        self.for_each(x, |_, _, _, force| sum += 0.5 * force * force / self.rho);
        sum
    }

    /// Adds the gradient (N).
    pub fn gradient(&self, x: &[DVec3], to: &mut [DVec3]) {
        self.for_each(x, |i, s, _, force| to[i] -= self.surfaces[s].sight(x[i]).normal * force);
    }

    /// Adds the Hessian (N/m), or where it is not to be `exact` what of it is positive.
    pub fn hessian(&self, x: &[DVec3], exact: bool, to: &mut System) {
        self.for_each(x, |i, s, _, force| {
            let sight = self.surfaces[s].sight(x[i]);
            let bent = if exact { force } else { 0.0 };
            to.add(i, &(outer(sight.normal, sight.normal) * self.rho - sight.curvature * bent));
        });
    }

    /// Takes the forces at `x` for those of the next round. Gives the deepest penetration (m) and the largest gap across
    /// which a force acts (m): both 0 in the end.
    pub fn update(&mut self, x: &[DVec3]) -> [f64; 2] {
        let solids = self.surfaces.len();
        let (mut deepest, mut widest) = (0.0f64, 0.0f64);
        let mut next = vec![0.0; self.multiplier.len()];
        self.for_each(x, |i, s, gap, force| {
            (deepest, widest) = (deepest.max(-gap), widest.max(gap));
            next[i * solids + s] = force;
        });
        self.multiplier = next;
        [deepest, widest]
    }

    /// Every pair that pushes.
    pub fn touches(&self, x: &[DVec3]) -> Vec<Touch> {
        let mut out = Vec::new();
        self.for_each(x, |particle, solid, _, force_n| out.push(Touch { particle, solid, force_n }));
        out
    }
}
