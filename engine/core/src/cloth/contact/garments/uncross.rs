//! Untangling: edges of a garment that pass through its own faces are drawn out again.
//!
//! Where cloth passes through itself its faces meet in a curve. Each edge and face that it runs through are moved so that the
//! curve becomes shorter, until there is none (Volino and Magnenat-Thalmann 2006, "Resolving surface collisions through
//! intersection contour minimization", section 3). It remembers nothing and needs no inside, so it also removes crossings whose
//! begin was not detected. It is slow, so that it never throws anything.

use glam::Vec3A;
use toile_base::numeric::portable;

use super::contact::LayerContact;
use super::contact_list::ContactList;
use crate::bounded::BoundedVec;
use crate::cloth::state::get;
use crate::lanes::WriteColumn;
use crate::surface::SurfaceMesh;

/// Crossings that one worker keeps of a garment at once: a tenth of what a garment of 10,000 particles has when all of it is
/// crushed. Of more those are kept whose edges reach least far through, then those of the lowest index; the others are left for a
/// later step, and counted.
pub const MOST_CROSSINGS: usize = 1024;

/// Every so many steps the edges of two particles are tried: 66 ms.
const TRIED_STEPS: u64 = 8;

/// Number of steps after the last crossing of one of its edges in which a particle keeps apart from no other.
const UNSURE_STEPS: u8 = 32;

/// Fastest that a crossing is drawn apart (m/s).
const APART_M_S: f32 = 0.1;

/// Length of a gradient under which the way out is not clear, and slower (1).
const CLEAR: f32 = 0.5;

/// Smallest cosine between an edge and the normal of the face that it crosses.
const LEAST_COSINE: f32 = 0.05;

/// An edge and a face that it passes through, and where.
#[derive(Debug, Clone, Copy)]
struct Crossing {
    edge: [u32; 2],
    triangle: u32,
    hit: Hit,
}

/// Where an edge passes through a face.
#[derive(Debug, Clone, Copy)]
struct Hit {
    /// How far along the edge (1).
    along: f32,
    /// Length of the shorter part of the edge (m): so far it reaches through.
    through: f32,
    /// Shares of the corners.
    shares: [f32; 3],
}

impl Crossing {
    /// What is lower is kept rather: no length is below 0, so that its bits are in its order.
    fn order(&self) -> (u32, [u32; 2], u32) {
        (self.hit.through.to_bits(), self.edge, self.triangle)
    }

    fn is(&self, edge: [u32; 2], triangle: u32) -> bool {
        (self.edge, self.triangle) == (edge, triangle)
    }
}

/// The crossings of one worker's half of a garment.
#[derive(Debug, Clone)]
pub struct Uncross {
    active: BoundedVec<Crossing>,
    /// Number of steps for which each particle keeps apart from no other `[particles]`.
    unsure: Box<[u8]>,
    /// Most crossings that were kept at once.
    pub most: usize,
    /// Crossings that there was no room for, summed over the steps.
    pub left_out: u64,
}

/// A garment as crossings are looked for.
#[derive(Clone, Copy)]
pub struct Tangle<'a> {
    /// Where the particles are (m).
    pub x: [WriteColumn<'a>; 3],
    /// Their triangles.
    pub mesh: &'a SurfaceMesh,
    /// Number of the step.
    pub tick: u64,
}

impl Uncross {
    /// Room for a garment of so many particles. At load.
    pub fn new(particles: usize) -> Self {
        Self { active: BoundedVec::new(MOST_CROSSINGS), unsure: vec![0; particles].into(), most: 0, left_out: 0 }
    }

    /// Whether none of a particle's edges has crossed anything lately.
    pub fn is_sure(&self, particle: u32) -> bool {
        self.unsure[particle as usize] == 0
    }

    /// Most contacts that it makes in a step: two for each crossing.
    pub const fn most_contacts() -> usize {
        2 * MOST_CROSSINGS
    }

    /// Begins a step: forgets what crosses no more.
    pub fn begin_step(&mut self, tangle: Tangle<'_>) {
        self.unsure.iter_mut().for_each(|u| *u = u.saturating_sub(1));
        self.active.retain_mut(|crossing| {
            let hit = tangle.hit(crossing.edge, crossing.triangle);
            hit.inspect(|hit| crossing.hit = *hit).is_some()
        });
    }

    /// Adds contacts that draw apart what crosses. `told` says of a particle and a triangle whether the parts of the body tell where
    /// the particle belongs: then their contact knows better.
    pub fn draw_out(&mut self, tangle: Tangle<'_>, told: impl Fn(u32, u32) -> bool, contacts: &mut ContactList) {
        self.most = self.most.max(self.active.len());
        let Self { active, unsure, .. } = self;
        for crossing in active.iter().filter(|c| !c.edge.iter().any(|&i| told(i, c.triangle))) {
            let hit = crossing.hit;
            crossing.edge.iter().for_each(|&i| unsure[i as usize] = UNSURE_STEPS);
            if let Some(way) = tangle.way_out(crossing) {
                let corners = tangle.mesh.corners(crossing.triangle);
                let ends = crossing.edge.into_iter().zip([1.0 - hit.along, hit.along]);
                for (particle, share) in ends.filter(|(_, share)| *share > 0.01) {
                    let drawn = (way * (APART_M_S * share)).length();
                    let contact = LayerContact::drawn_from(particle, corners, hit.shares, drawn);
                    contacts.push(contact, way.normalize_or_zero());
                }
            }
        }
    }

    /// Tries the edges of each of two particles against the triangles of the other, every so many steps.
    pub fn try_pair(&mut self, tangle: Tangle<'_>, [i, j]: [u32; 2]) {
        if (u64::from(i) + tangle.tick).is_multiple_of(TRIED_STEPS) {
            self.try_edges(tangle, i, j);
            self.try_edges(tangle, j, i);
        }
    }

    /// Tries the edges of a particle against the triangles of another.
    fn try_edges(&mut self, tangle: Tangle<'_>, i: u32, other: u32) {
        for &own in tangle.mesh.fan(i) {
            let corners = tangle.mesh.corners(own);
            let turn = corners.iter().position(|c| *c == i).unwrap_or(0);
            // Each edge of the fan once, but for those of borders.
            let j = corners[(turn + 1) % 3];
            for &triangle in tangle.mesh.fan(other) {
                let edge = [i.min(j), i.max(j)];
                if let Some(hit) = tangle.hit(edge, triangle)
                    && !self.active.iter().any(|c| c.is(edge, triangle))
                {
                    self.keep(Crossing { edge, triangle, hit });
                }
            }
        }
    }

    /// Keeps a crossing, if need be in place of the one that reaches farthest through.
    fn keep(&mut self, crossing: Crossing) {
        if self.active.push(crossing) {
            return;
        }
        self.left_out += 1;
        if let Some(worst) = self.active.iter_mut().max_by_key(|c| c.order())
            && crossing.order() < worst.order()
        {
            *worst = crossing;
        }
    }

    /// Memory that it holds (bytes).
    pub fn bytes(&self) -> usize {
        self.active.bytes() + self.unsure.len()
    }
}

impl Tangle<'_> {
    fn at(&self, i: u32) -> Vec3A {
        get(self.x, i as usize)
    }

    /// Where an edge passes through a face, if it does (Moeller, Trumbore 1997, "Fast, minimum storage ray/triangle
    /// intersection"). What has a corner in common does not.
    fn hit(&self, edge: [u32; 2], triangle: u32) -> Option<Hit> {
        let corners = self.mesh.corners(triangle);
        if edge.iter().any(|e| corners.contains(e)) {
            return None;
        }
        let [p, q] = edge.map(|e| self.at(e));
        let [a, b, c] = corners.map(|v| self.at(v));
        let (way, ab, ac) = (q - p, b - a, c - a);
        let across = portable::cross(way, ac);
        let volume = ab.dot(across);
        let inverse = volume.recip();
        let from = p - a;
        let v = from.dot(across) * inverse;
        let up = portable::cross(from, ab);
        let w = way.dot(up) * inverse;
        let along = ac.dot(up) * inverse;
        // Not so where anything is not a number.
        let inside = v >= 0.0 && w >= 0.0 && v + w <= 1.0 && (0.0..=1.0).contains(&along);
        let through = along.min(1.0 - along).max(0.0) * way.length();
        (inside && volume != 0.0).then_some(Hit { along, through, shares: [1.0 - v - w, v, w] })
    }

    /// Which way an edge is to go against a face for the curve that they meet in to become shorter, up to 1 long.
    fn way_out(&self, crossing: &Crossing) -> Option<Vec3A> {
        let [p, q] = crossing.edge.map(|e| self.at(e));
        let edge = (q - p).normalize_or_zero();
        let normal = self.face(crossing.triangle)?;
        let cosine = edge.dot(normal);
        if cosine.abs() < LEAST_COSINE {
            return None;
        }
        let mut sum = Vec3A::ZERO;
        let [i, j] = crossing.edge;
        for &t in self.mesh.fan(i).iter().filter(|t| self.mesh.corners(**t).contains(&j)) {
            let Some(face) = self.face(t) else { continue };
            let curve = portable::cross(normal, face).normalize_or_zero();
            let corners = self.mesh.corners(t);
            // Into the face: towards the corner that is not the edge's.
            let third = corners.into_iter().find(|c| *c != i && *c != j).unwrap_or(i);
            let curve = if curve.dot(self.at(third) - p) < 0.0 { -curve } else { curve };
            sum += curve - normal * (2.0 * edge.dot(curve) / cosine);
        }
        let way = sum / (sum.length_squared() + CLEAR * CLEAR).sqrt();
        way.is_finite().then_some(way)
    }

    fn face(&self, triangle: u32) -> Option<Vec3A> {
        let [a, b, c] = self.mesh.corners(triangle).map(|v| self.at(v));
        portable::cross(b - a, c - a).try_normalize()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn crossing(k: u32) -> Crossing {
        // Some are equal in how far they reach.
        let through = (k % 100) as f32 * 1e-4;
        Crossing { edge: [k, k + 1], triangle: k, hit: Hit { along: 0.5, through, shares: [1.0, 0.0, 0.0] } }
    }

    #[test]
    fn what_reaches_least_far_through_is_kept_whatever_comes_first() {
        let count = MOST_CROSSINGS as u32 + 500;
        let kept = |order: &dyn Fn(u32) -> u32| {
            let mut uncross = Uncross::new(0);
            (0..count).for_each(|k| uncross.keep(crossing(order(k))));
            let mut all: Vec<_> = uncross.active.iter().map(Crossing::order).collect();
            all.sort_unstable();
            (all, uncross.left_out, uncross.active.usage().capacity as usize)
        };
        let (first, left_out, capacity) = kept(&|k| k);
        assert_eq!((first.len(), left_out, capacity), (MOST_CROSSINGS, 500, MOST_CROSSINGS));
        let mut all: Vec<_> = (0..count).map(|k| crossing(k).order()).collect();
        all.sort_unstable();
        assert_eq!(first, all[..MOST_CROSSINGS]);
        assert_eq!(kept(&|k| count - 1 - k).0, first);
        // 7 has no factor in common with the count, so that each comes once.
        assert_eq!(kept(&|k| k * 7 % count).0, first);
    }
}
