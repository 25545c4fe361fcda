//! Friction as a lagged potential: mu N f(|u|) of the motion u along the surface since the step's start.
//!
//! With N, the normal and the surface's own motion held at the round before, Coulomb friction has a potential (Li et al.
//! 2020, "Incremental potential contact", section 5): f(y) = y beyond e, and y^2 / e - y^3 / (3 e^2) + e / 3 below it, so
//! that what sticks creeps with less than e in a step. Its Hessian is positive semi-definite: f'(y) / y across the motion
//! and f''(y) >= 0 along it.

use glam::{DMat3, DVec3};

use super::super::solids::{SolidSurface, outer};
use super::super::solution::Touch;
use super::super::system::System;

/// One contact as the round before left it.
#[derive(Debug, Clone, Copy)]
struct StickyContact {
    particle: usize,
    solid: usize,
    normal: DVec3,
    /// mu N (N).
    most: f64,
    /// Where the particle would be had it stayed on its point of the surface (m).
    anchor: DVec3,
}

/// Friction of all contacts.
#[derive(Debug)]
pub struct Friction<'a> {
    /// Coulomb coefficient (1).
    pub coefficient: f64,
    /// Motion below which friction is not yet whole (m).
    pub slack_m: f64,
    /// Particles at the start of the step (m).
    pub start: &'a [DVec3],
    /// The solids at the start and the end of the step.
    pub surfaces: [Vec<SolidSurface>; 2],
    grips: Vec<StickyContact>,
}

impl<'a> Friction<'a> {
    /// No contact has been seen yet.
    pub fn new(coefficient: f64, slack_m: f64, start: &'a [DVec3], surfaces: [Vec<SolidSurface>; 2]) -> Self {
        Self { coefficient, slack_m, start, surfaces, grips: Vec::new() }
    }

    fn slip(grip: &StickyContact, x: &[DVec3]) -> DVec3 {
        let moved = x[grip.particle] - grip.anchor;
        moved - grip.normal * grip.normal.dot(moved)
    }

    /// f, f' / y and f'' at y.
    fn profile(&self, y: f64) -> [f64; 3] {
        let e = self.slack_m;
        if y >= e {
            [y, y.recip(), 0.0]
        } else {
            [y * y / e * (1.0 - y / (3.0 * e)) + e / 3.0, (2.0 - y / e) / e, 2.0 * (1.0 - y / e) / e]
        }
    }

    /// Energy that friction stands for (J).
    pub fn value(&self, x: &[DVec3]) -> f64 {
        self.grips.iter().map(|g| g.most * self.profile(Self::slip(g, x).length())[0]).sum()
    }

    /// Adds the gradient (N).
    pub fn gradient(&self, x: &[DVec3], to: &mut [DVec3]) {
        for grip in &self.grips {
            let slip = Self::slip(grip, x);
            to[grip.particle] += slip * (grip.most * self.profile(slip.length())[1]);
        }
    }

    /// Adds the Hessian (N/m).
    pub fn hessian(&self, x: &[DVec3], to: &mut System) {
        for grip in &self.grips {
            let slip = Self::slip(grip, x);
            let [_, across, along] = self.profile(slip.length());
            let flat = DMat3::IDENTITY - outer(grip.normal, grip.normal);
            let way = slip.try_normalize().unwrap_or(DVec3::ZERO);
            to.add(grip.particle, &((flat * across + outer(way, way) * (along - across)) * grip.most));
        }
    }

    /// Takes the contacts at `x` for those of the next round. Gives the largest change of a friction force's limit (N).
    pub fn update(&mut self, x: &[DVec3], touches: &[Touch]) -> f64 {
        let grip = |t: &Touch| {
            let sight = self.surfaces[1][t.solid].sight(x[t.particle]);
            let carried = self.surfaces[1][t.solid].carried(&self.surfaces[0][t.solid], &sight);
            let anchor = self.start[t.particle] + carried;
            StickyContact {
                particle: t.particle,
                solid: t.solid,
                normal: sight.normal,
                most: self.coefficient * t.force_n,
                anchor,
            }
        };
        let next: Vec<StickyContact> = touches.iter().map(grip).collect();
        let change = largest_change(&self.grips, &next);
        self.grips = next;
        change
    }
}

/// Both lists are in order of particle and solid.
fn largest_change(old: &[StickyContact], new: &[StickyContact]) -> f64 {
    let key = |g: &StickyContact| (g.particle, g.solid);
    let find = |all: &[StickyContact], g: &StickyContact| {
        all.binary_search_by_key(&key(g), key).ok().map_or(DVec3::ZERO, |k| all[k].normal * all[k].most)
    };
    let changes = new.iter().map(|g| (g.normal * g.most - find(old, g)).length());
    let gone = old.iter().filter(|g| find(new, g) == DVec3::ZERO).map(|g| g.most);
    changes.chain(gone).fold(0.0, f64::max)
}
