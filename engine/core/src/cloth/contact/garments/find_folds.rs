//! Finding folds: which particles of a garment may come too near to each other within a step.
//!
//! Clusters of sixteen particles are tested by their boxes, then their particles by the other's box, then one by one. The search
//! distance follows from the speed of the two against each other and from the time until the next search.

use glam::Vec3A;

use super::fold_motion::FoldMotion;
use super::fold_surface::{FoldSurface, Joined};
use crate::bounded::BoundedVec;
use crate::lanes::{Kernel, Lanes, MOST, Mask, ReadColumn, V3};
use crate::surface::{ClusterBoxes, Clusters};

/// How much faster than it is a particle may be until it is looked at again (1).
pub const FASTER: f32 = 1.25;

/// How much nearer than what they keep apart two particles are looked at (m).
pub const MARGIN_M: f32 = 0.001;

/// Farther than this beyond what they keep apart (m) nothing is looked for: 1.5 m/s towards each other.
const FARTHEST_M: f32 = 0.03;

/// Two particles of a garment that may come too near to each other.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FoldPair {
    /// The two.
    pub particles: [u32; 2],
    /// How far they keep apart (m).
    pub gap: f32,
}

/// Finds the pairs of one share of a garment's clusters with all that come later.
pub struct FindFolds<'a> {
    /// The clusters.
    pub clusters: &'a Clusters,
    /// Distances that the particles keep from each other.
    pub folds: &'a FoldSurface,
    /// Boxes of the clusters.
    pub boxes: &'a ClusterBoxes,
    /// Where they are and how they move.
    pub motion: &'a FoldMotion,
    /// Which share, 0 or 1, and which part of it, below [`PARTS`].
    pub share: [usize; 2],
    /// Time until the same clusters are looked at again (s).
    pub seconds: f32,
    /// Pairs farther apart than this part of what they keep apart are left out (1); more than any where all are wanted.
    pub nearest: f32,
    /// What is found; as many as there is room for.
    pub pairs: &'a mut BoundedVec<FoldPair>,
}

/// Parts of a share, each of which can be looked at in a step of its own.
pub const PARTS: usize = 4;

/// Clusters that one share takes in a row, so that both have as many that come early.
const IN_A_ROW: usize = 4;

impl Kernel for FindFolds<'_> {
    /// How many there was no room for.
    type Out = u64;

    #[inline(always)]
    fn run<L: Lanes>(mut self) -> u64 {
        let mut left_out = 0;
        for a in 0..self.clusters.len() {
            let row = a / IN_A_ROW;
            if [row % 2, row / 2 % PARTS] == self.share {
                left_out += self.cluster::<L>(a);
            }
        }
        left_out
    }
}

/// A box in every lane.
#[derive(Clone, Copy)]
struct Box3<L> {
    low: V3<L>,
    high: V3<L>,
}

impl<L: Lanes> Box3<L> {
    #[inline(always)]
    fn load(from: [ReadColumn<'_>; 6], at: usize) -> Self {
        let [lx, ly, lz, hx, hy, hz] = from;
        Self { low: V3::load([lx, ly, lz], at, L::N), high: V3::load([hx, hy, hz], at, L::N) }
    }

    #[inline(always)]
    fn splat(from: [ReadColumn<'_>; 6], at: usize) -> Self {
        let [lx, ly, lz, hx, hy, hz] = from;
        let one = |c: [ReadColumn<'_>; 3]| Vec3A::new(c[0].get(at), c[1].get(at), c[2].get(at));
        Self { low: V3::splat(one([lx, ly, lz])), high: V3::splat(one([hx, hy, hz])) }
    }

    /// How far each axis is from a range, below 0 within it.
    #[inline(always)]
    fn away(self, low: V3<L>, high: V3<L>) -> V3<L> {
        V3 {
            x: (low.x - self.high.x).max(self.low.x - high.x),
            y: (low.y - self.high.y).max(self.low.y - high.y),
            z: (low.z - self.high.z).max(self.low.z - high.z),
        }
    }
}

/// Square of a distance from how far its axes are away.
#[inline(always)]
fn outside2<L: Lanes>(away: V3<L>) -> L {
    let zero = L::splat(0.0);
    let away = V3 { x: away.x.max(zero), y: away.y.max(zero), z: away.z.max(zero) };
    away.dot(away)
}

impl FindFolds<'_> {
    /// Meets a cluster with itself and all later ones.
    #[inline(always)]
    fn cluster<L: Lanes>(&mut self, a: usize) -> u64 {
        let (ends, velocity, radii) = (self.boxes.columns(), self.motion.velocity(), self.folds.largest());
        let (own, moves) = (Box3::<L>::splat(ends, a), Box3::<L>::splat(velocity, a));
        let radius = L::splat(radii.get(a) + MARGIN_M);
        let mut near = self.folds.near(a).iter().peekable();
        let mut left_out = 0;
        let mut from = a / L::N * L::N;
        while from < self.clusters.len() {
            let other = Box3::<L>::load(ends, from);
            let toward = Box3::<L>::load(velocity, from);
            let speed = widest(moves, toward);
            let moved = (speed.dot(speed).sqrt() * L::splat(FASTER * self.seconds)).min(L::splat(FARTHEST_M));
            let reach = radius + L::load(radii, from) + moved;
            let mut met = outside2(own.away(other.low, other.high)).lt(reach * reach).bits();
            if from < a {
                met &= !((1 << (a - from)) - 1);
            }
            let reach = reach.to_array();
            while met != 0 {
                let lane = met.trailing_zeros() as usize;
                met &= met - 1;
                let b = from + lane;
                while near.next_if(|n| (n.other as usize) < b).is_some() {}
                let near = near.peek().filter(|n| n.other as usize == b);
                if near.is_some() && self.motion.flatness.are_flat(a, b) {
                    continue;
                }
                let joined = self.folds.joined(near.copied());
                left_out += self.pair::<L>([a, b], reach[lane], joined);
            }
            from += L::N;
        }
        left_out
    }

    /// Which particles of a cluster are within `reach` (m) of another's box.
    #[inline(always)]
    fn near_box<L: Lanes>(&self, of: usize, to: usize, reach: f32) -> u32 {
        let there = Box3::<L>::splat(self.boxes.columns(), to);
        let (mut bits, mut from) = (0, 0);
        while from < MOST {
            let p = V3::<L>::load(self.motion.vertices()[0], of * MOST + from, L::N);
            bits |= outside2(there.away(p, p)).lt(L::splat(reach * reach)).bits() << from;
            from += L::N;
        }
        bits
    }

    /// Adds the pairs of two clusters' particles nearer than `reach` (m); `joined` says which particles are joined. Returns the
    /// number of pairs that did not fit.
    #[inline(always)]
    fn pair<L: Lanes>(&mut self, [a, b]: [usize; 2], reach: f32, joined: &Joined) -> u64 {
        let mut rows = self.near_box::<L>(a, b, reach) & self.clusters.members(a);
        if rows == 0 {
            return 0;
        }
        let columns = self.near_box::<L>(b, a, reach) & self.clusters.members(b);
        let mut left_out = 0;
        while rows != 0 {
            let k = rows.trailing_zeros() as usize;
            rows &= rows - 1;
            let later = if a == b { u32::MAX << k } else { u32::MAX };
            left_out += self.row::<L>([a, k], b, columns & later & !u32::from(joined[k]));
        }
        left_out
    }

    /// Meets a particle, the `k`th of a cluster, with some of another cluster's.
    #[inline(always)]
    fn row<L: Lanes>(&mut self, [a, k]: [usize; 2], b: usize, wanted: u32) -> u64 {
        let ([at, v], radii) = (self.motion.vertices(), self.folds.radii());
        let own = a * MOST + k;
        let p = V3::<L>::splat(Vec3A::new(at[0].get(own), at[1].get(own), at[2].get(own)));
        let moves = V3::<L>::splat(Vec3A::new(v[0].get(own), v[1].get(own), v[2].get(own)));
        let radius = L::splat(radii.get(own) + MARGIN_M);
        let (mut left_out, mut from) = (0, 0);
        while from < MOST {
            let there = b * MOST + from;
            if wanted >> from & ((1u64 << L::N) - 1) as u32 != 0 {
                let away = V3::<L>::load(at, there, L::N) - p;
                let relative = V3::<L>::load(v, there, L::N) - moves;
                let moved = relative.dot(relative).sqrt() * L::splat(FASTER * self.seconds);
                let reach = radius + L::load(radii, there) + moved;
                let d2 = away.dot(away);
                let mut hits = d2.lt(reach * reach).bits() & wanted >> from;
                if hits != 0 {
                    let (d2, moved) = (d2.to_array(), moved.to_array());
                    while hits != 0 {
                        let lane = hits.trailing_zeros() as usize;
                        hits &= hits - 1;
                        let [i, j] = [self.clusters.vertices(a)[k], self.clusters.vertices(b)[from + lane]];
                        left_out += self.meet([i, j], d2[lane], moved[lane]);
                    }
                }
            }
            from += L::N;
        }
        left_out
    }

    /// Lists two particles if they may come too near until they are looked at again, in which they move by so much against each other (m).
    #[inline(always)]
    fn meet(&mut self, particles: [u32; 2], distance2: f32, moved: f32) -> u64 {
        let gap = self.folds.gap(particles[0], particles[1]);
        let (reach, nearest) = (gap + MARGIN_M + moved, self.nearest * gap);
        if !(distance2 < reach * reach && distance2 < nearest * nearest) {
            return 0;
        }
        u64::from(!self.pairs.push(FoldPair { particles, gap }))
    }
}

/// The greatest difference of two ranges of velocities along each axis (m/s).
#[inline(always)]
fn widest<L: Lanes>(one: Box3<L>, other: Box3<L>) -> V3<L> {
    V3 {
        x: (one.high.x - other.low.x).max(other.high.x - one.low.x),
        y: (one.high.y - other.low.y).max(other.high.y - one.low.y),
        z: (one.high.z - other.low.z).max(other.high.z - one.low.z),
    }
}
