//! Finding folds: which particles of a garment are near which others that are not their neighbours.
//!
//! Clusters of sixteen particles meet by their boxes. Those that go on into each other and look the same way cannot touch
//! (Volino and Magnenat-Thalmann 1994, "Efficient self-collision detection on smoothly discretized surface animations using
//! geometrical shape regularity": a region whose normals have one half-space in common does not meet itself). What is
//! left is looked at particle by particle.

use glam::Vec3A;

use super::fold_motion::FoldMotion;
use super::fold_surface::FoldSurface;
use super::garment_surface::GarmentSurface;
use crate::cloth::state::get;
use crate::lanes::{Kernel, Lanes, MOST, Mask, V3, WriteColumn};
use crate::surface::ClusterBoxes;

/// Cosine of a cluster's normals to their mean from which on it is as good as flat: 37 degrees.
const FLAT: f32 = 0.8;

/// Cosine between two mean normals from which on clusters look the same way: 53 degrees.
const ALIKE: f32 = 0.6;

/// How much faster than at its start a particle may be within a step (1).
const FASTER: f32 = 1.5;

/// A particle and the nearest of those in front of it, or behind it, that are not its neighbours.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FoldSeed {
    /// The particle.
    pub particle: u32,
    /// The other.
    pub vertex: u32,
}

/// Finds the seeds of some clusters of a garment.
pub struct FindFolds<'a> {
    /// Velocities of the particles (m/s).
    pub v: [WriteColumn<'a>; 3],
    /// Their surface.
    pub surface: &'a GarmentSurface,
    /// Who is whose neighbour.
    pub folds: &'a FoldSurface,
    /// Boxes of the clusters.
    pub boxes: &'a ClusterBoxes,
    /// How they lie and move.
    pub motion: &'a FoldMotion,
    /// Normals of the particles.
    pub normals: &'a [Vec3A],
    /// Which clusters.
    pub clusters: std::ops::Range<usize>,
    /// Distance at which cloth touches, and how far from a face it has to be looked at (m).
    pub near: f32,
    /// Farther from a face than this nothing is asked for (m).
    pub farthest: f32,
    /// Length of the step (s).
    pub step_seconds: f32,
    /// What is found: two for each particle at most, and there is room for as many.
    pub seeds: &'a mut Vec<FoldSeed>,
}

/// Clusters of which no two particles are of one piece.
const NOBODY: [u16; MOST] = [0; MOST];

/// The nearest of each particle of a cluster, behind and in front: square of the distance (m2) and which. Of several that are
/// equally near it is the one of the lowest index.
type Nearest = [[(f32, u32); 2]; MOST];

impl Kernel for FindFolds<'_> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(mut self) {
        for a in self.clusters.clone() {
            let mut nearest: Nearest = [[(f32::MAX, u32::MAX); 2]; MOST];
            self.cluster::<L>(a, &mut nearest);
            let vertices = self.surface.clusters.vertices(a);
            for (k, found) in nearest.iter().enumerate() {
                // The last cluster is filled up with its last vertex.
                let again = k > 0 && vertices[k] == vertices[k - 1];
                for (_, vertex) in found.iter().filter(|(_, v)| !again && *v != u32::MAX) {
                    debug_assert!(self.seeds.len() < self.seeds.capacity(), "there is room for two of each particle");
                    self.seeds.push(FoldSeed { particle: vertices[k], vertex: *vertex });
                }
            }
        }
    }
}

impl FindFolds<'_> {
    /// Meets a cluster with all others and itself.
    #[inline(always)]
    fn cluster<L: Lanes>(&mut self, a: usize, nearest: &mut Nearest) {
        let ends = self.boxes.columns();
        let motion = self.motion.columns();
        let zero = L::splat(0.0);
        let far = self.vertex_reach(self.near);
        let farthest = L::splat(self.vertex_reach(self.farthest));
        let [nx, ny, nz] = [0, 1, 2].map(|k| L::splat(motion[k].get(a)));
        let (front, flat) = (V3 { x: nx, y: ny, z: nz }, motion[3].get(a) > FLAT);
        let [vx, vy, vz] = [4, 5, 6].map(|k| L::splat(motion[k].get(a)));
        let (velocity, spread) = (V3 { x: vx, y: vy, z: vz }, L::splat(motion[7].get(a)));
        let mut near = self.folds.near(a).iter().peekable();
        let mut from = 0;
        while from < self.surface.clusters.len() {
            let away = V3 {
                x: (L::load(ends[0], from) - L::splat(ends[3].get(a)))
                    .max(L::splat(ends[0].get(a)) - L::load(ends[3], from)),
                y: (L::load(ends[1], from) - L::splat(ends[4].get(a)))
                    .max(L::splat(ends[1].get(a)) - L::load(ends[4], from)),
                z: (L::load(ends[2], from) - L::splat(ends[5].get(a)))
                    .max(L::splat(ends[2].get(a)) - L::load(ends[5], from)),
            };
            let away = V3 { x: away.x.max(zero), y: away.y.max(zero), z: away.z.max(zero) };
            let other = V3 { x: L::load(motion[4], from), y: L::load(motion[5], from), z: L::load(motion[6], from) };
            let relative = other - velocity;
            let speed = relative.dot(relative).sqrt() + spread + L::load(motion[7], from);
            let reach = (L::splat(far) + speed * L::splat(FASTER * self.step_seconds)).min(farthest);
            let mut met = away.dot(away).lt(reach * reach).bits();
            if met == 0 {
                from += L::N;
                continue;
            }
            if flat {
                let toward =
                    V3 { x: L::load(motion[0], from), y: L::load(motion[1], from), z: L::load(motion[2], from) };
                let alike = L::splat(ALIKE).lt(toward.dot(front)).bits();
                let even = L::splat(FLAT).lt(L::load(motion[3], from)).bits();
                let word = from / MOST * MOST;
                let next = u32::from(self.folds.next(a, word)) >> (from - word);
                met &= !(alike & even & next);
            }
            let reach = reach.to_array();
            while met != 0 {
                let lane = met.trailing_zeros() as usize;
                met &= met - 1;
                let other = (from + lane) as u32;
                while near.next_if(|n| n.other < other).is_some() {}
                let apart = near.peek().filter(|n| n.other == other).map_or(&NOBODY, |n| &n.bits);
                self.pair::<L>(a, from + lane, (reach[lane], apart), nearest);
            }
            from += L::N;
        }
    }

    /// How far from the nearest vertex of a face what is so near to the face can be (m).
    #[inline(always)]
    fn vertex_reach(&self, near: f32) -> f32 {
        (self.folds.cover * self.folds.cover + near * near).sqrt()
    }

    /// Whether a particle may come to touch a face around another that is so far away (m2) within the step, by how both move.
    #[inline(always)]
    fn may_touch(&self, i: u32, j: u32, distance2: f32) -> bool {
        let relative = get(self.v, i as usize) - get(self.v, j as usize);
        let reach = self.vertex_reach(self.near) + relative.length() * (FASTER * self.step_seconds);
        distance2 < reach * reach
    }

    /// Meets the particles of two clusters nearer than `reach` (m); `one_piece` says who is of one piece with whom.
    #[inline(always)]
    fn pair<L: Lanes>(&self, a: usize, b: usize, (reach, one_piece): (f32, &[u16; MOST]), nearest: &mut Nearest) {
        let at = self.motion.at();
        let mut from = 0;
        while from < MOST {
            let there = V3::<L>::load(at, b * MOST + from, L::N);
            for (k, kept) in nearest.iter_mut().enumerate() {
                let [x, y, z] = at.map(|c| c.get(a * MOST + k));
                let away = there - V3 { x: L::splat(x), y: L::splat(y), z: L::splat(z) };
                let d2 = away.dot(away);
                let apart = !u32::from(one_piece[k] >> from);
                let mut hits = d2.lt(L::splat(reach * reach)).bits() & apart;
                if hits == 0 {
                    continue;
                }
                let i = self.surface.clusters.vertices(a)[k];
                let normal = self.normals[i as usize];
                let d2 = d2.to_array();
                while hits != 0 {
                    let lane = hits.trailing_zeros() as usize;
                    hits &= hits - 1;
                    let j = self.surface.clusters.vertices(b)[from + lane];
                    if d2[lane] <= kept[0].0.max(kept[1].0) && self.may_touch(i, j, d2[lane]) {
                        let other = Vec3A::from(at.map(|c| c.get(b * MOST + from + lane)));
                        let before = (other - Vec3A::new(x, y, z)).dot(normal) > 0.0;
                        let kept = &mut kept[usize::from(before)];
                        if (d2[lane], j) < *kept {
                            *kept = (d2[lane], j);
                        }
                    }
                }
            }
            from += L::N;
        }
    }
}
