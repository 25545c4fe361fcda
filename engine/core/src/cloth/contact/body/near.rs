//! Near: the broad phase. Which capsules and planes each particle may touch during the step.
//!
//! Particles are looked at in blocks of 16 that lie close together, found at load. A block's box against the capsules'
//! boxes, lanes across capsules, leaves few capsules; those are asked for the distance of each particle from
//! all that they sweep in the step, lanes across particles. What is near is kept as pairs of block and capsule, a bit a
//! particle, with room for all of them; each particle is tried against its capsules in their order.

use toile_base::limits::{MAX_CAPSULES, MAX_PLANES};

use super::cones::{CapsuleCones, CapsuleEnds, CapsuleIndex, CapsuleRow, PLACES};
use super::touch::close;
use crate::cloth::state::ParticleColumns;
use crate::lanes::{Kernel, Lanes, MOST, Mask, ReadColumn, V3, WriteColumn, reciprocal_root};

/// Planes that a block can be near: the floor and those of the scene.
pub const PLANES: usize = MAX_PLANES + 1;

/// Particles this much farther away than they can travel in a step are still looked at (m): what neighbours and gravity
/// add within the step.
const SLACK_M: f32 = 0.004;

/// A particle may be jerked along by its neighbours at so many times its present speed.
const JERK: f32 = 1.5;

/// Acceleration that brings a particle at rest closer within a step (m/s2): in a long step more than the slack.
const FALL_M_S2: f32 = 10.0;

/// Boxes are wider than what they hold by this (m), so that rounding never makes the coarse test stricter than the fine.
const BOX_M: f32 = 1e-3;

/// Up to 16 particles of one owner that lie close together: four times four that are neighbours in memory.
#[derive(Debug, Clone)]
pub struct ParticleBlock {
    /// First particle of each four; of those past `len` nothing is read or written.
    quads: [u32; 4],
    /// Particles, at most [`MOST`].
    len: u16,
    /// Pairs: capsules that some of its particles may touch in this step.
    pub pairs: u16,
    /// First of its pairs.
    pub from: u32,
    /// Bit p is set where some may touch plane p.
    pub planes: u16,
    /// Which may touch each plane, a bit a particle; holds where `planes` has a bit.
    pub plane_lanes: [u16; PLANES],
}

impl ParticleBlock {
    /// Near nothing yet. All fours but the last are whole.
    pub fn new(quads: [u32; 4], len: usize) -> Self {
        Self { quads, len: len.min(MOST) as u16, pairs: 0, from: 0, planes: 0, plane_lanes: [0; PLANES] }
    }

    /// Number of particles in the block.
    #[inline(always)]
    pub fn len(&self) -> usize {
        usize::from(self.len)
    }

    /// Which particle is on a lane.
    #[inline(always)]
    pub fn particle(&self, lane: usize) -> u32 {
        self.quads[lane / 4 % 4] + lane as u32 % 4
    }

    /// Which particles are on the lanes from `lane` on, and how many.
    #[inline(always)]
    fn index<L: Lanes>(&self, lane: usize) -> ([u32; MOST], usize) {
        (std::array::from_fn(|i| self.particle(lane + i)), L::N.min(self.len() - lane))
    }

    /// Vectors of the particles from `lane` on; 0 past the last.
    #[inline(always)]
    pub fn load<L: Lanes>(&self, from: [WriteColumn<'_>; 3], lane: usize) -> V3<L> {
        if self.len() == MOST {
            return V3::load_quads(from, &self.quads, lane);
        }
        let (index, n) = self.index::<L>(lane);
        V3::gather(from, &index, n)
    }

    /// Numbers of the same.
    #[inline(always)]
    pub fn load_one<L: Lanes>(&self, from: WriteColumn<'_>, lane: usize) -> L {
        if self.len() == MOST {
            return L::load_quads(from, &self.quads, lane);
        }
        let (index, n) = self.index::<L>(lane);
        L::gather(from, &index, n)
    }

    /// Writes the vectors of the block's particles, from `lane` on, to three columns.
    #[inline(always)]
    pub fn store<L: Lanes>(&self, v: V3<L>, to: [WriteColumn<'_>; 3], lane: usize) {
        if self.len() == MOST {
            return v.store_quads(to, &self.quads, lane);
        }
        let (index, n) = self.index::<L>(lane);
        v.scatter(to, &index, n);
    }
}

/// A block and a capsule that are near.
#[derive(Debug, Clone, Copy, Default)]
pub struct ContactPair {
    /// Row of the capsule.
    pub capsule: CapsuleIndex,
    /// Which particles of the block may touch it in this step, a bit each.
    pub lanes: u16,
    /// Which do at the end of this substep as it stands; from bit 16 on, which have moved so far in it that the capsule
    /// may have to sweep them.
    pub found: u32,
}

/// Boxes around what each capsule sweeps in the step.
#[derive(Debug, Clone)]
pub struct CapsuleBoxes {
    low: [CapsuleRow; 3],
    high: [CapsuleRow; 3],
}

impl CapsuleBoxes {
    /// Boxes that hold nothing.
    pub const NONE: Self =
        Self { low: [CapsuleRow([f32::INFINITY; PLACES]); 3], high: [CapsuleRow([f32::NEG_INFINITY; PLACES]); 3] };

    /// Around both ends at start and end of the step, and the offset.
    pub fn set(&mut self, ends: &CapsuleEnds, offset: f32) {
        *self = Self::NONE;
        for c in (0..PLACES).filter(|c| ends.sound >> c & 1 != 0) {
            for (start, travel) in ends.start.iter().zip(&ends.travel) {
                for axis in 0..3 {
                    let from = start.centre[axis].0[c];
                    let to = from + travel.centre[axis].0[c];
                    let radius = start.radius.0[c] + travel.radius.0[c].max(0.0) + offset + BOX_M;
                    self.low[axis].0[c] = self.low[axis].0[c].min(from.min(to) - radius);
                    self.high[axis].0[c] = self.high[axis].0[c].max(from.max(to) + radius);
                }
            }
        }
    }

    /// The capsules whose boxes meet a box.
    #[inline(always)]
    fn meet<L: Lanes>(&self, low: [f32; 3], high: [f32; 3]) -> u32 {
        let mut bits = 0;
        let mut at = 0;
        while at < PLACES {
            let met =
                self.meet_along::<L>(0, [low[0], high[0]], at).and(self.meet_along::<L>(1, [low[1], high[1]], at));
            bits |= met.and(self.meet_along::<L>(2, [low[2], high[2]], at)).bits() << at;
            at += L::N;
        }
        bits
    }

    /// The capsules from `at` on whose boxes meet a range along an axis.
    #[inline(always)]
    fn meet_along<L: Lanes>(&self, axis: usize, [low, high]: [f32; 2], at: usize) -> L::Mask {
        let lows = L::load(ReadColumn::new(&self.low[axis].0), at);
        let highs = L::load(ReadColumn::new(&self.high[axis].0), at);
        lows.lt(L::splat(high)).and(L::splat(low).lt(highs))
    }
}

/// The broad phase over the blocks of one owner.
pub struct FindPairs<'a> {
    /// The garment's columns.
    pub cols: ParticleColumns<'a>,
    /// Where the capsules are in the middle of the step, swollen by half of their travel: they hold all that is swept.
    pub swept: &'a CapsuleCones,
    /// Boxes around the same.
    pub boxes: &'a CapsuleBoxes,
    /// Unit normals and offsets (m) of the planes, moved outwards by the contact offset.
    pub planes: &'a [[f32; 4]],
    /// The owner's blocks.
    pub blocks: &'a mut [ParticleBlock],
    /// Room for a pair of every block with every capsule.
    pub pairs: &'a mut [ContactPair],
    /// Which particles of each block may touch each capsule at all; empty where all may touch all.
    pub reach: &'a [[u16; MAX_CAPSULES]],
    /// Length of the step (s).
    pub step_seconds: f32,
}

impl Kernel for FindPairs<'_> {
    /// How many pairs were found.
    type Out = usize;

    #[inline(always)]
    fn run<L: Lanes>(self) -> usize {
        let Self { cols, swept, boxes, planes, blocks, pairs, reach, step_seconds } = self;
        let ahead = L::splat(JERK * step_seconds);
        let mut count = 0;
        for (b, block) in blocks.iter_mut().enumerate() {
            let mut far = [0.0; MOST];
            let far = WriteColumn::new(&mut far);
            let [low, high] = around::<L>(cols, block, ahead, far);
            let met = [boxes.meet::<L>(low, high), meet_planes(planes, low, high)];
            (block.from, block.pairs, block.planes) = (count as u32, 0, 0);
            if met != [0, 0] {
                let lanes = ask::<L>(cols, swept, planes, block, far, met);
                count = keep(block, pairs, met[0], lanes, reach.get(b));
            }
        }
        count
    }
}

/// Keeps a block's pairs; says how many there are now in all.
#[inline(always)]
fn keep(
    block: &mut ParticleBlock,
    pairs: &mut [ContactPair],
    met: u32,
    lanes: [u16; PLACES],
    reach: Option<&[u16; MAX_CAPSULES]>,
) -> usize {
    let mut at = block.from as usize;
    let mut bits = met;
    while let Some(capsule) = CapsuleIndex::lowest(bits) {
        bits &= bits - 1;
        let c = capsule.place();
        let lanes = lanes[c] & reach.map_or(!0, |r| r[c]);
        // Written first and counted after: no branch.
        if let Some(pair) = pairs.get_mut(at) {
            *pair = ContactPair { capsule, lanes, found: 0 };
            at += usize::from(lanes != 0);
        }
    }
    block.pairs = (at - block.from as usize) as u16;
    at
}

/// How far particles of these velocities may come in so much time (m).
#[inline(always)]
fn travel<L: Lanes>(v: V3<L>, ahead: L) -> L {
    let speed2 = v.dot(v);
    let fall = L::splat(FALL_M_S2 / (JERK * JERK)) * ahead * ahead;
    L::splat(SLACK_M) + fall + speed2 * reciprocal_root(speed2) * ahead
}

/// The box around all places that the free particles of a block may come to, and how far each may come; what is not free
/// comes to NaN, which is in no box and near nothing.
#[inline(always)]
fn around<L: Lanes>(cols: ParticleColumns<'_>, block: &ParticleBlock, ahead: L, far: WriteColumn<'_>) -> [[f32; 3]; 2] {
    let (mut low, mut high) = ([L::splat(f32::MAX); 3], [L::splat(-f32::MAX); 3]);
    let mut from = 0;
    while from < block.len() {
        let x = block.load::<L>(cols.x, from);
        let free = L::splat(0.0).lt(block.load_one(cols.w, from));
        let reach = travel(block.load(cols.v, from), ahead).select(free, L::splat(f32::NAN));
        reach.store(far, from);
        // NaN leaves the box as it was.
        low[0] = (x.x - reach).min(low[0]);
        low[1] = (x.y - reach).min(low[1]);
        low[2] = (x.z - reach).min(low[2]);
        high[0] = (x.x + reach).max(high[0]);
        high[1] = (x.y + reach).max(high[1]);
        high[2] = (x.z + reach).max(high[2]);
        from += L::N;
    }
    [[low[0].least(), low[1].least(), low[2].least()], [-(-high[0]).least(), -(-high[1]).least(), -(-high[2]).least()]]
}

/// The planes that a box reaches through.
#[inline(always)]
fn meet_planes(planes: &[[f32; 4]], low: [f32; 3], high: [f32; 3]) -> u32 {
    let mut bits = 0;
    for (i, [nx, ny, nz, offset]) in planes.iter().enumerate() {
        let deepest =
            (nx * low[0]).min(nx * high[0]) + (ny * low[1]).min(ny * high[1]) + (nz * low[2]).min(nz * high[2]);
        bits |= u32::from(deepest < offset + BOX_M) << i;
    }
    bits
}

/// Asks the capsules and planes that a block's box has met for each of its particles: a bit a particle for each capsule.
#[inline(always)]
fn ask<L: Lanes>(
    cols: ParticleColumns<'_>,
    swept: &CapsuleCones,
    planes: &[[f32; 4]],
    block: &mut ParticleBlock,
    far: WriteColumn<'_>,
    met: [u32; 2],
) -> [u16; PLACES] {
    let mut lanes = [0; PLACES];
    block.plane_lanes = [0; PLANES];
    let mut from = 0;
    while from < block.len() {
        let x = block.load::<L>(cols.x, from);
        let far = L::load(far, from);
        let mut bits = met[0];
        while let Some(c) = CapsuleIndex::lowest(bits) {
            bits &= bits - 1;
            lanes[c.place()] |= (close(swept, c, x, far).bits() << from) as u16;
        }
        let mut bits = met[1];
        while bits != 0 {
            let p = bits.trailing_zeros() as usize;
            bits &= bits - 1;
            let near = (-far).lt(depth(&planes[p], x));
            block.plane_lanes[p] |= (near.bits() << from) as u16;
            block.planes |= u16::from(block.plane_lanes[p] != 0) << p;
        }
        from += L::N;
    }
    lanes
}

/// How deep particles are behind a plane (m).
#[inline(always)]
pub fn depth<L: Lanes>(plane: &[f32; 4], x: V3<L>) -> L {
    let [nx, ny, nz, offset] = *plane;
    L::splat(offset) - (x.x * L::splat(nx) + x.y * L::splat(ny) + x.z * L::splat(nz))
}
