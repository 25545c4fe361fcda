//! Dynamic relaxation: the cloth's energy goes down in small damped steps until it rests.
//!
//! Each step is one sweep of XPBD (Macklin et al. 2016, "XPBD: position-based simulation of compliant constrained dynamics",
//! equation 18) over threads, shear and bending. Steps so short that a sweep solves them are worth more than longer ones
//! with more sweeps (Macklin et al. 2019, "Small steps in physics simulation"). Time has no meaning here: motion is kept from
//! step to step while it lowers the energy, and is damped so that it dies out.

use glam::Vec3;

use super::limits::{BAND_M, CONTACT_M, FRICTION};
use super::place::MIDDLE_M;
use super::skin_field::SkinField;
use super::springs::Springs;

/// How a run of steps goes.
#[derive(Debug, Clone, Copy)]
pub struct RelaxRun {
    /// Number of steps.
    pub steps: usize,
    /// Length of one step (s), of no clock: it weighs gravity against stiffness.
    pub step_s: f32,
    /// Acceleration downwards (m/s2).
    pub gravity: f32,
    /// Part of the motion that a step keeps (0 to 1).
    pub kept: f32,
    /// Part of the gap of an open seam that a step closes, at the end of the run (0 to 1).
    pub seam: f32,
    /// How much softer shear is than threads, in the inverse masses of its ends (1): cloth shears before it crumples. With the
    /// fabric's own stiffness both are all but rigid in a step, and what is left of either is for the other to take up.
    pub shear: f32,
    /// Whether the distance to the skin is exact rather than interpolated.
    pub exact: bool,
}

/// Farthest that a vertex moves in a step (m): a fifth of the band in which the skin is felt.
const MOST_M: f32 = 0.2 * BAND_M;

/// Steps after which the middles of edges are looked at: there are four times as many as vertices.
const EDGES_EVERY: usize = 8;

/// How far the middle of an edge is kept from the skin (m).
const EDGE_CONTACT_M: f32 = 0.5 * CONTACT_M;

/// A mesh under way.
pub struct Relaxation<'a> {
    /// Where each vertex is (m) `[vertices]`.
    pub at: Vec<Vec3>,
    /// What holds it together.
    pub springs: &'a Springs,
    /// The skin.
    pub field: &'a SkinField,
    /// The side of the body's middle that vertices of legs stay on, true at the left `[vertices]`.
    pub sides: &'a [Option<bool>],
    /// What does not move `[vertices]`.
    pub held: &'a [bool],
}

impl Relaxation<'_> {
    /// Takes the steps of a run.
    pub fn run(&mut self, run: &RelaxRun) {
        let mut before = self.at.clone();
        let weight: Vec<f32> =
            self.springs.inverse_mass.iter().zip(self.held).map(|(w, held)| if *held { 0.0 } else { *w }).collect();
        for step in 0..run.steps {
            let progress = (step + 1) as f32 / run.steps as f32;
            for (i, x) in self.at.iter_mut().enumerate() {
                let motion = (*x - before[i]) * run.kept - Vec3::Y * (run.gravity * run.step_s * run.step_s);
                before[i] = *x;
                if weight[i] > 0.0 {
                    *x += motion.clamp_length_max(MOST_M);
                }
            }
            self.close_seams(run.seam * progress);
            self.solve_links(&weight, run, step % 2 == 1);
            self.solve_bends(&weight, run.step_s);
            if run.exact && step % EDGES_EVERY == 0 {
                self.touch_edges(&weight);
            }
            self.touch(&before, &weight, run.exact);
        }
    }

    fn close_seams(&mut self, share: f32) {
        for &[a, b] in &self.springs.seams {
            let gap = (self.at[b as usize] - self.at[a as usize]) * (0.5 * share);
            let gap = gap.clamp_length_max(MOST_M);
            self.at[a as usize] += gap;
            self.at[b as usize] -= gap;
        }
    }

    fn solve_links(&mut self, weight: &[f32], run: &RelaxRun, backwards: bool) {
        let scale = (run.step_s * run.step_s).recip();
        let links = &self.springs.links;
        for k in 0..links.len() {
            let link = &links[if backwards { links.len() - 1 - k } else { k }];
            let [a, b] = link.ends.map(|v| v as usize);
            let sum = weight[a] + weight[b];
            let along = self.at[b] - self.at[a];
            let length = along.length();
            if sum == 0.0 || length < 1e-9 {
                continue;
            }
            let soft = if link.thread { 0.0 } else { run.shear * sum };
            let push = along * ((length - link.rest) / (length * (sum + soft + link.compliance * scale)));
            self.at[a] += push * weight[a];
            self.at[b] -= push * weight[b];
        }
    }

    fn solve_bends(&mut self, weight: &[f32], step_s: f32) {
        let scale = (step_s * step_s).recip();
        for bend in &self.springs.bends {
            let (mut sum, mut stiff) = (Vec3::ZERO, scale / bend.k);
            for (&v, &c) in bend.v.iter().zip(&bend.c) {
                sum += self.at[v as usize] * c;
                stiff += weight[v as usize] * c * c;
            }
            let push = sum / stiff;
            for (&v, &c) in bend.v.iter().zip(&bend.c) {
                self.at[v as usize] -= push * (c * weight[v as usize]);
            }
        }
    }

    /// Puts edges whose middle is in the skin outside of it: over a ridge, both ends can be outside.
    fn touch_edges(&mut self, weight: &[f32]) {
        for link in &self.springs.links {
            let [a, b] = link.ends.map(|v| v as usize);
            let middle = 0.5 * (self.at[a] + self.at[b]);
            let (distance, normal) = self.field.sample(middle);
            if distance < EDGE_CONTACT_M {
                let push = normal * (EDGE_CONTACT_M - distance).min(MOST_M);
                [a, b].into_iter().filter(|v| weight[*v] > 0.0).for_each(|v| self.at[v] += push);
            }
        }
    }

    /// Puts what is in the skin outside of it, with friction, and what belongs to a leg on its side.
    fn touch(&mut self, before: &[Vec3], weight: &[f32], exact: bool) {
        for (i, x) in self.at.iter_mut().enumerate() {
            if weight[i] == 0.0 {
                continue;
            }
            let step = *x - before[i];
            if step.length_squared() > MOST_M * MOST_M {
                *x = before[i] + step.clamp_length_max(MOST_M);
            }
            let (mut distance, mut normal) = self.field.sample(*x);
            if exact
                && distance < 2.0 * CONTACT_M
                && let Some(point) = self.field.nearest(*x)
            {
                (distance, normal) = (point.distance, point.normal);
            }
            if distance < CONTACT_M {
                let depth = (CONTACT_M - distance).min(MOST_M);
                let step = *x - before[i];
                let slip = step - normal * step.dot(normal);
                let grip = (FRICTION * depth / slip.length().max(1e-9)).min(1.0);
                *x += normal * depth - slip * grip;
            }
            if let Some(left) = self.sides[i] {
                x.x = if left { x.x.max(MIDDLE_M) } else { x.x.min(-MIDDLE_M) };
            }
        }
    }
}
