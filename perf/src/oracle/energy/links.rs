//! Stretch: (1/2) k (C + o)^2 of C = |b - a| - rest.
//!
//! A link that is soft enough has k = 1 / compliance and o = 0. A stiffer one, and one that does not stretch at all, is
//! solved by the method of multipliers (Hestenes 1969; Powell 1969; Nocedal & Wright 2006, "Numerical Optimization",
//! chapter 17.3): k = 1 / (compliance + 1 / rho) and o = T / rho with the tension T of the round before. Where T no longer
//! changes, T = k (C + o) is C / compliance, or for an inextensible link C = 0, whatever rho is; so rho can be small
//! enough for the Hessian to stay well conditioned.
//!
//! A link of several slopes, or one that rubs ([`link_curve`]), has T(C) in place of C / compliance, and o and k of the line that
//! it is on.
//!
//! Gradient: T n. Hessian of the difference b - a: k n n^T + (T / l) (I - n n^T). Its eigenvalues are k > 0 along the
//! link and, twice, T / l across it, negative where the link is compressed: the projection leaves those out.

use glam::{DMat3, DVec3};
use toile_base::fabric::link_curve::LinkCurve;

use super::super::link_curve;
use super::super::problem::Link;
use super::super::solids::outer;
use super::super::system::System;

/// Stretch energy of all links, the stiffest by multipliers.
#[derive(Debug)]
pub struct Springs<'a> {
    links: &'a [Link],
    /// Curves of the links `[links]`; empty if every link has one slope.
    link_curves: Vec<LinkCurve>,
    /// 1 / rho of each (m/N), 0 where the link is soft enough.
    give: Vec<f64>,
    /// Tension of the round before (N).
    pub multiplier: Vec<f64>,
}

/// A link as it lies.
struct Pull {
    /// Unit vector from its first end to its second.
    n: DVec3,
    length: f64,
    /// Growth of the tension with the length (N/m).
    k: f64,
    tension: f64,
    /// What the link itself is longer by under that tension (m).
    longer: f64,
}

impl<'a> Springs<'a> {
    /// Links with those stiffer than `rho` (N/m) solved by multipliers, which start at `multiplier`.
    pub fn new(links: &'a [Link], link_curves: Vec<LinkCurve>, rho: f64, multiplier: Vec<f64>) -> Self {
        let softest = |(e, l): (usize, &Link)| {
            link_curves.get(e).map_or(l.compliance, |link_curve| l.rest / link_curve::steepest(link_curve))
        };
        let give = links.iter().enumerate().map(|l| if softest(l) * rho < 1.0 { rho.recip() } else { 0.0 }).collect();
        Self { links, link_curves, give, multiplier }
    }

    fn pull(&self, e: usize, x: &[DVec3]) -> Pull {
        let link = &self.links[e];
        let gap = x[link.ends[1] as usize] - x[link.ends[0] as usize];
        let length = gap.length().max(1e-9 * link.rest);
        let n = gap / length;
        let whole = length - link.rest + self.multiplier[e] * self.give[e];
        if let Some(link_curve) = self.link_curves.get(e) {
            let found = link_curve::answer(link_curve, whole / link.rest, self.give[e] / link.rest);
            let (k, longer) = (found.slope / link.rest, found.strain * link.rest);
            return Pull { n, length, k, tension: found.force, longer };
        }
        let k = (link.compliance + self.give[e]).recip();
        let tension = k * whole;
        Pull { n, length, k, tension, longer: link.compliance * tension }
    }

    /// Tension of each link (N), positive where it pulls.
    pub fn tensions(&self, x: &[DVec3]) -> Vec<f64> {
        (0..self.links.len()).map(|e| self.pull(e, x).tension).collect()
    }

    /// Energy (J), with what the multipliers add.
    pub fn value(&self, x: &[DVec3]) -> f64 {
        let one = |e: usize| {
            let Pull { k, tension, longer, .. } = self.pull(e, x);
            let rest = self.links[e].rest;
            match self.link_curves.get(e) {
                Some(link_curve) => {
                    rest * link_curve::energy(link_curve, longer / rest) + 0.5 * self.give[e] * tension * tension
                }
                None => 0.5 * tension * tension / k,
            }
        };
        (0..self.links.len()).map(one).sum()
    }

    /// Adds the gradient (N).
    pub fn gradient(&self, x: &[DVec3], to: &mut [DVec3]) {
        for (e, link) in self.links.iter().enumerate() {
            let Pull { n, tension, .. } = self.pull(e, x);
            to[link.ends[0] as usize] -= n * tension;
            to[link.ends[1] as usize] += n * tension;
        }
    }

    /// What the curvature of lengths adds to the gradient (N) after a step `by` from `x`, along the links as they lie at
    /// `x`: k (|b' - a'| - |b - a| - n . (d_b - d_a)) n.
    pub fn bulge(&self, x: &[DVec3], by: &[DVec3], to: &mut [DVec3]) {
        for (e, link) in self.links.iter().enumerate() {
            let Pull { n, length, k, .. } = self.pull(e, x);
            let [a, b] = link.ends.map(|i| i as usize);
            let moved = by[b] - by[a];
            let force = n * (k * ((n * length + moved).length() - length - n.dot(moved)));
            to[a] -= force;
            to[b] += force;
        }
    }

    /// Adds the Hessian (N/m), or where it is not to be `exact` what of it is positive.
    pub fn hessian(&self, x: &[DVec3], exact: bool, to: &mut System) {
        for (e, link) in self.links.iter().enumerate() {
            let Pull { n, length, k, tension, .. } = self.pull(e, x);
            let across = if exact { tension } else { tension.max(0.0) } / length;
            let along = outer(n, n);
            let block = along * k + (DMat3::IDENTITY - along) * across;
            let [a, b] = link.ends.map(|i| i as usize);
            to.add(a, &block);
            to.add(b, &block);
            to.add_pair(a, b, &-block);
        }
    }

    /// What each multiplier is off its tension at `x` (N) `[links]`: 0 where a link has none.
    pub fn lag(&self, x: &[DVec3]) -> Vec<f64> {
        let one = |e: usize| if self.give[e] > 0.0 { self.pull(e, x).tension - self.multiplier[e] } else { 0.0 };
        (0..self.links.len()).map(one).collect()
    }

    /// The largest strain by which a link with a multiplier is off the length that its tension asks for (1).
    pub fn strain_off(&self, x: &[DVec3]) -> f64 {
        let one = |e: usize| {
            let Pull { length, longer, .. } = self.pull(e, x);
            let rest = self.links[e].rest;
            (length - rest - longer).abs() / rest
        };
        (0..self.links.len()).filter(|&e| self.give[e] > 0.0).map(one).fold(0.0, f64::max)
    }

    /// How the lag answers to a change of the multipliers (N) if particles follow by the factors of the system at `x`: the
    /// symmetric matrix I - D + rho D G H^-1 G^T D times the change, with D = k / rho and G the links' directions.
    pub fn answer(&self, x: &[DVec3], system: &System, change: &[f64]) -> Option<Vec<f64>> {
        let mut push = vec![DVec3::ZERO; x.len()];
        let stiff = || (0..self.links.len()).filter(|&e| self.give[e] > 0.0);
        for e in stiff() {
            let Pull { n, k, .. } = self.pull(e, x);
            let force = n * (k * self.give[e] * change[e]);
            let [a, b] = self.links[e].ends.map(|i| i as usize);
            push[a] -= force;
            push[b] += force;
        }
        let moved = system.solve(&push)?;
        let mut out = vec![0.0; change.len()];
        for e in stiff() {
            let Pull { n, k, .. } = self.pull(e, x);
            let [a, b] = self.links[e].ends.map(|i| i as usize);
            let d = k * self.give[e];
            out[e] = (1.0 - d) * change[e] - k * n.dot(moved[b] - moved[a]);
        }
        Some(out)
    }

    /// Takes the tensions of `x` for those of the next round.
    pub fn update(&mut self, x: &[DVec3]) {
        for e in 0..self.links.len() {
            if self.give[e] > 0.0 {
                self.multiplier[e] = self.pull(e, x).tension;
            }
        }
    }
}
