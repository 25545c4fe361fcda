//! The kernel of a substep: every particle against what it is near.

use super::ContactSettings;
use super::cones::CapsuleCones;
use super::near::{ContactPair, ParticleBlock, depth};
use super::sweep::Sweep;
use super::touch::{ContactSurface, Friction, ON_M, close, place, push, surface};
use crate::cloth::state::ParticleColumns;
use crate::lanes::{Kernel, Lanes, MOST, Mask, V3};

/// One substep over the blocks of one owner.
///
/// Each particle meets its capsules one after the other, but a push is a long chain of operations that wait for each
/// other. So the blocks take turns: all are looked at, each that has something to do meets one capsule, those are looked
/// at again from that capsule on, until nothing is left. Nothing then waits for what was only just begun.
pub struct SolveContacts<'a> {
    /// The garment's columns.
    pub cols: ParticleColumns<'a>,
    /// The capsules, at the end of the substep and along it.
    pub sweep: Sweep<'a>,
    /// Unit normals and offsets (m) of the planes, moved outwards by the contact offset.
    pub planes: &'a [[f32; 4]],
    /// The owner's blocks.
    pub blocks: &'a [ParticleBlock],
    /// Pairs of the owner's blocks, block after block.
    pub pairs: &'a mut [ContactPair],
    /// Room for a turn of every block.
    pub turns: &'a mut [BusyBlock],
    /// How contact acts: friction, and the distance that is kept from surfaces.
    pub how: &'a ContactSettings,
}

/// A block that has something to do.
#[derive(Debug, Clone, Copy, Default)]
pub struct BusyBlock {
    /// Index of the block among the owner's blocks.
    block: u32,
    /// Which of its pairs is next.
    pair: u32,
}

impl Kernel for SolveContacts<'_> {
    /// Pairs of particle and capsule whose way was followed.
    type Out = u64;

    #[inline(always)]
    fn run<L: Lanes>(self) -> u64 {
        let Self { cols, sweep, planes, blocks, pairs, turns, how } = self;
        let friction = Friction { hold: L::splat(how.friction_static), slide: L::splat(how.friction_kinetic) };
        let mut swept = 0;
        let mut count = 0;
        for (b, block) in blocks.iter().enumerate().filter(|(_, b)| b.pairs != 0) {
            let next = look::<L>(cols, &sweep, block, pairs, 0);
            count += take(turns, count, b as u32, next);
        }
        while count > 0 {
            let mut touching = TouchingParticles::new(cols, sweep.cones);
            for turn in &turns[..count] {
                let (block, pair) = (&blocks[turn.block as usize], &mut pairs[turn.pair as usize]);
                if pair.found >> MOST != 0 {
                    swept += follow(cols, &sweep, block, pair, friction);
                }
                touching.take(block, pair, friction);
            }
            if touching.len > 0 {
                touching.push(friction);
            }
            let mut left = 0;
            for t in 0..count {
                let BusyBlock { block: b, pair } = turns[t];
                let block = &blocks[b as usize];
                let next = look::<L>(cols, &sweep, block, pairs, pair as usize + 1 - block.from as usize);
                left += take(turns, left, b, next);
            }
            count = left;
        }
        for block in blocks.iter().filter(|b| b.planes != 0) {
            meet_planes(cols, planes, block, friction);
        }
        swept
    }
}

/// Notes a turn; 1 if there is something to do. Written first and counted after: no branch.
#[inline(always)]
fn take(turns: &mut [BusyBlock], at: usize, block: u32, next: Option<u32>) -> usize {
    turns[at] = BusyBlock { block, pair: next.unwrap_or(0) };
    usize::from(next.is_some())
}

/// The bits of the lanes from `from` on among those of a block.
#[inline(always)]
fn few<L: Lanes>(bits: u32, from: usize) -> u32 {
    bits >> from & (((1u64 << L::N) - 1) as u32)
}

/// Looks at a block's pairs from number `start` on: which particles touch, which have moved far. Gives the first of the
/// pairs with any.
#[inline(always)]
fn look<L: Lanes>(
    cols: ParticleColumns<'_>,
    sweep: &Sweep<'_>,
    block: &ParticleBlock,
    pairs: &mut [ContactPair],
    start: usize,
) -> Option<u32> {
    let range = block.from as usize + start..block.from as usize + usize::from(block.pairs);
    let later = &mut pairs[range.clone()];
    let mut from = 0;
    while from < block.len() {
        let x = block.load::<L>(cols.x, from);
        let way = x - block.load(cols.previous, from);
        let way2 = way.dot(way);
        for pair in &mut *later {
            let lanes = few::<L>(pair.lanes.into(), from);
            // The widest lanes hold all of a pair's particles: there is always one.
            let [mut touched, mut fast] = [0; 2];
            if L::N == MOST || lanes != 0 {
                let c = pair.capsule;
                touched = close(sweep.cones, c, x, L::splat(-ON_M)).bits() & lanes;
                fast = sweep.cones.quick2.splat::<L>(c).lt(way2).bits() & lanes;
                if fast != 0 {
                    fast &= sweep.asks(c, x, way).bits();
                }
            }
            let before = if from == 0 { 0 } else { pair.found };
            pair.found = before | (touched | fast << MOST) << from;
        }
        from += L::N;
    }
    let mut next = None;
    for (pair, i) in later.iter().zip(range).rev() {
        next = if pair.found != 0 { Some(i as u32) } else { next };
    }
    next
}

/// Follows the ways of a block's particles that have moved far, and looks again at which touch; gives how many were followed.
#[inline(always)]
fn follow<L: Lanes>(
    cols: ParticleColumns<'_>,
    sweep: &Sweep<'_>,
    block: &ParticleBlock,
    pair: &mut ContactPair,
    friction: Friction<L>,
) -> u64 {
    let c = pair.capsule;
    let mut swept = 0;
    let mut from = 0;
    while from < block.len() {
        let fast = few::<L>(pair.found >> MOST, from);
        if fast != 0 {
            let mut x = block.load::<L>(cols.x, from);
            let mut previous = block.load::<L>(cols.previous, from);
            sweep.run(c, &mut x, &mut previous, friction, L::Mask::of(fast));
            swept += fast.count_ones();
            let touched = close(sweep.cones, c, x, L::splat(-ON_M)).bits() & few::<L>(pair.lanes.into(), from);
            pair.found = pair.found & !(few::<L>(!0, 0) << from) | touched << from;
            block.store(x, cols.x, from);
            block.store(previous, cols.previous, from);
        }
        from += L::N;
    }
    u64::from(swept)
}

/// Particles that touch a capsule each: few of a block do, so they are pushed by the vector, from wherever they are.
struct TouchingParticles<'a> {
    cols: ParticleColumns<'a>,
    cones: &'a CapsuleCones,
    particles: [u32; MOST],
    capsules: [u32; MOST],
    len: usize,
}

impl<'a> TouchingParticles<'a> {
    fn new(cols: ParticleColumns<'a>, cones: &'a CapsuleCones) -> Self {
        Self { cols, cones, particles: [0; MOST], capsules: [0; MOST], len: 0 }
    }

    /// Takes on those of a block that touch the pair's capsule; pushes where there is a vector of them.
    #[inline(always)]
    fn take<L: Lanes>(&mut self, block: &ParticleBlock, pair: &ContactPair, friction: Friction<L>) {
        let mut touched = pair.found & ((1 << MOST) - 1);
        while touched != 0 {
            let lane = touched.trailing_zeros() as usize;
            touched &= touched - 1;
            let at = self.len % MOST;
            (self.particles[at], self.capsules[at]) = (block.particle(lane), pair.capsule.place() as u32);
            self.len += 1;
            if self.len >= L::N {
                self.push(friction);
            }
        }
    }

    /// Pushes all that were taken on.
    #[inline(always)]
    fn push<L: Lanes>(&mut self, friction: Friction<L>) {
        let n = std::mem::take(&mut self.len).min(L::N);
        let c = &self.capsules;
        let mut x = V3::<L>::gather(self.cols.x, &self.particles, n);
        let mut previous = V3::<L>::gather(self.cols.previous, &self.particles, n);
        let on = surface(self.cones, c, &place(self.cones, c, x));
        push(&mut x, &mut previous, &on, friction, L::Mask::of(few::<L>((1u32 << n) - 1, 0)));
        x.scatter(self.cols.x, &self.particles, n);
        previous.scatter(self.cols.previous, &self.particles, n);
    }
}

/// Whatever is behind a plane is pushed out: there is no other side.
#[inline(always)]
fn meet_planes<L: Lanes>(cols: ParticleColumns<'_>, planes: &[[f32; 4]], block: &ParticleBlock, friction: Friction<L>) {
    let zero = L::splat(0.0);
    let mut from = 0;
    while from < block.len() {
        let mut x = block.load::<L>(cols.x, from);
        let mut previous = block.load::<L>(cols.previous, from);
        for (p, plane) in planes.iter().enumerate().filter(|(p, _)| block.planes >> p & 1 != 0) {
            let depth = depth(plane, x);
            let touched = zero.lt(depth).and(L::Mask::of(few::<L>(block.plane_lanes[p].into(), from)));
            if touched.any() {
                let [nx, ny, nz, _] = *plane;
                let normal = V3 { x: L::splat(nx), y: L::splat(ny), z: L::splat(nz) };
                let on = ContactSurface { normal, depth, carried: V3 { x: zero, y: zero, z: zero } };
                push(&mut x, &mut previous, &on, friction, touched);
            }
        }
        block.store(x, cols.x, from);
        block.store(previous, cols.previous, from);
        from += L::N;
    }
}
