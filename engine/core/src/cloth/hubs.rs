//! Bending over whole rings, for uneven meshes: the same force as [`super::bending`], d = sum c_i x_i and -c_i d, with up to
//! three sums over the same particles, which are read and pushed once for all of them.
//!
//! Vertices beside each other share particles and lie in no order, so that this goes one hub after the other.

use std::ops::Range;

use toile_assets::garment::layout::{HubGroup, Hubs};

use crate::lanes::{Kernel, Lanes, V3, WriteColumn};

/// Adds to each particle the bound on dt^2 omega^2 that the hubs put on it.
pub fn add_load(hubs: &Hubs, weights: &[f32], dt: f32, load: &mut [f32]) {
    hubs.for_each(|_, particles, coefficients| {
        let sums = coefficients.len() / particles.len();
        for sum in 0..sums {
            let own = |k: usize| coefficients[k * sums + sum].abs();
            let all: f32 = (0..particles.len()).map(own).sum();
            for (k, &i) in particles.iter().enumerate() {
                load[i as usize] += dt * dt * weights[i as usize] * own(k) * all;
            }
        }
    });
}

/// Writes for each hub the share of its stiffness that can be carried where `limit` is the bound, 1 where all of it; the
/// least is given back.
pub fn weaken(hubs: &Hubs, load: &[f32], limit: f32, scale: &mut [f32]) -> f32 {
    let mut least = 1.0f32;
    hubs.for_each(|number, particles, _| {
        let most = particles.iter().map(|&i| load[i as usize]).fold(0.0, f32::max);
        scale[number] = if most > limit { limit / most } else { 1.0 };
        least = least.min(scale[number]);
    });
    least
}

/// Adds the bending forces of some groups to the velocities, or whatever is bent to whatever is pushed.
pub struct BendHubs<'a> {
    /// Inverse masses (1/kg).
    pub w: WriteColumn<'a>,
    /// All hubs of the garment.
    pub hubs: &'a Hubs,
    /// Groups of the owner, a range of [`Hubs::groups`].
    pub groups: Range<u32>,
    /// What is bent: the positions (m).
    pub from: [WriteColumn<'a>; 3],
    /// What is pushed: the velocities (m/s).
    pub to: [WriteColumn<'a>; 3],
    /// How much: the length of the substep (s).
    pub by: f32,
    /// What [`weaken`] made, where anything had to be weakened.
    pub scale: Option<&'a [f32]>,
}

impl Kernel for BendHubs<'_> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(mut self) {
        let len = self.w.len();
        for axis in 0..3 {
            (self.from[axis], self.to[axis]) = (self.from[axis].cut(len), self.to[axis].cut(len));
        }
        for group in &self.hubs.groups[self.groups.start as usize..self.groups.end as usize] {
            match group.sums {
                1 => self.group::<1>(group),
                2 => self.group::<2>(group),
                _ => self.group::<3>(group),
            }
        }
    }
}

impl BendHubs<'_> {
    /// Hubs of so many sums.
    #[inline(always)]
    fn group<const SUMS: usize>(&self, group: &HubGroup) {
        let points = group.points as usize;
        let particles = &self.hubs.particles[group.particles as usize..][..points * group.count as usize];
        let (coefficients, _) = self.hubs.coefficients[group.coefficients as usize..].as_chunks::<SUMS>();
        let coefficients = &coefficients[..particles.len()];
        let each = particles.chunks_exact(points).zip(coefficients.chunks_exact(points));
        for (hub, (v, c)) in each.enumerate() {
            let by = self.scale.map_or(self.by, |s| self.by * s[group.number as usize + hub]);
            self.hub(v, c, by);
        }
    }

    #[inline(always)]
    fn hub<const SUMS: usize>(&self, v: &[u32], c: &[[f32; SUMS]], by: f32) {
        let mut d = [V3::<f32>::splat(glam::Vec3A::ZERO); SUMS];
        for (&i, c) in v.iter().zip(c) {
            let x = V3::<f32>::load(self.from, i as usize, 1);
            for sum in 0..SUMS {
                d[sum] = d[sum] + x * c[sum];
            }
        }
        for d in &mut d {
            *d = *d * by;
        }
        for (&i, c) in v.iter().zip(c) {
            let mut push = d[0] * c[0];
            for sum in 1..SUMS {
                push = push + d[sum] * c[sum];
            }
            let i = i as usize;
            (V3::<f32>::load(self.to, i, 1) - push * self.w.get(i)).store(self.to, i, 1);
        }
    }
}
