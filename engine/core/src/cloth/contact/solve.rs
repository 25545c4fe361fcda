//! The kernel of a substep: every particle against what it is near.

use super::ContactSettings;
use super::cones::PLACES;
use super::near::{Block, PLANES, Pair, depth};
use super::sweep::Sweep;
use super::touch::{Friction, ON_M, Surface, close, place, push, surface};
use crate::cloth::state::Columns;
use crate::lanes::{Kernel, Lanes, MOST, Mask, V3};

/// One substep over the blocks of one owner, in two passes. The first looks at every pair and changes nothing, so that
/// nothing waits for anything; it leaves few blocks, and what the second does with their pairs is known before it gets
/// there. A pair is looked at again only where a push came before it.
pub struct Solve<'a> {
    /// The garment's columns.
    pub cols: Columns<'a>,
    /// The capsules, at the end of the substep and along it.
    pub sweep: Sweep<'a>,
    /// Unit normals and offsets (m) of the planes, moved outwards by the contact offset.
    pub planes: &'a [[f32; 4]],
    /// The owner's blocks.
    pub blocks: &'a mut [Block],
    /// Their pairs.
    pub pairs: &'a mut [Pair],
    /// What a particle may move (m2) before any capsule has to sweep it.
    pub least_quick2: f32,
    /// Friction.
    pub how: &'a ContactSettings,
}

/// Particles of a block on lanes, and what is known of them.
struct Few<L: Lanes> {
    x: V3<L>,
    previous: V3<L>,
    /// Shift of their bits.
    from: usize,
    friction: Friction<L>,
    /// Whether one may have moved so far that a capsule has to sweep it.
    fast: bool,
    /// Square of how far they moved (m2).
    way2: L,
    /// Whether any was pushed.
    moved: bool,
    /// Pairs whose way was followed.
    swept: u32,
}

impl Kernel for Solve<'_> {
    /// Pairs of particle and capsule whose way was followed.
    type Out = u64;

    #[inline(always)]
    fn run<L: Lanes>(self) -> u64 {
        let Self { cols, sweep, planes, blocks, pairs, least_quick2, how } = self;
        for block in &mut *blocks {
            if block.pairs != 0 {
                block.busy = look::<L>(cols, &sweep, block, pairs, least_quick2);
            }
            block.busy = block.busy && block.pairs != 0 || block.planes != 0;
        }
        let friction = Friction { hold: L::splat(how.friction_static), slide: L::splat(how.friction_kinetic) };
        let mut swept = 0;
        for block in blocks.iter().filter(|b| b.busy) {
            let (first, len) = block.place();
            let mut from = 0;
            while from < len {
                let (at, n) = (first + from, L::N.min(len - from));
                let (x, previous) = (V3::<L>::load(cols.x, at, n), V3::<L>::load(cols.previous, at, n));
                let zero = L::splat(0.0);
                let mut few = Few { x, previous, from, friction, fast: false, way2: zero, moved: false, swept: 0 };
                few.measure(least_quick2);
                for pair in pairs.get(block.range()).unwrap_or_default() {
                    few.meet(&sweep, pair, least_quick2);
                }
                few.meet_planes(planes, block);
                if few.moved {
                    few.x.store(cols.x, at, n);
                    few.previous.store(cols.previous, at, n);
                }
                swept += u64::from(few.swept);
                from += L::N;
            }
        }
        swept
    }
}

/// The bits of these lanes among those of a block.
#[inline(always)]
fn few_of<L: Lanes>(lanes: u16, from: usize) -> u32 {
    u32::from(lanes) >> from & (((1u64 << L::N) - 1) as u32)
}

/// Which particles of a block touch each capsule that they are near; whether any does, or has moved far.
#[inline(always)]
fn look<L: Lanes>(cols: Columns<'_>, sweep: &Sweep<'_>, block: &Block, pairs: &mut [Pair], least_quick2: f32) -> bool {
    let (first, len) = block.place();
    let pairs = pairs.get_mut(block.range()).unwrap_or_default();
    let mut busy = 0;
    let mut from = 0;
    while from < len {
        let (at, n) = (first + from, L::N.min(len - from));
        let x = V3::<L>::load(cols.x, at, n);
        busy |= L::splat(least_quick2).lt(way2(x, V3::load(cols.previous, at, n))).bits();
        for pair in &mut *pairs {
            let lanes = few_of::<L>(pair.lanes, from);
            let before = if from == 0 { 0 } else { pair.touched };
            // The widest lanes hold all of a pair's particles: there is always one.
            if L::N < MOST && lanes == 0 {
                pair.touched = before;
                continue;
            }
            let c = usize::from(pair.capsule) % PLACES;
            let touched = close(sweep.cones, c, x, L::splat(-ON_M)).bits() & lanes;
            pair.touched = before | (touched << from) as u16;
            busy |= touched;
        }
        from += L::N;
    }
    busy != 0
}

impl<L: Lanes> Few<L> {
    /// How far the particles moved.
    #[inline(always)]
    fn measure(&mut self, least_quick2: f32) {
        self.way2 = way2(self.x, self.previous);
        self.fast = L::splat(least_quick2).lt(self.way2).any();
    }

    /// One capsule.
    #[inline(always)]
    fn meet(&mut self, sweep: &Sweep<'_>, pair: &Pair, least_quick2: f32) {
        let lanes = few_of::<L>(pair.lanes, self.from);
        if L::N < MOST && lanes == 0 {
            return;
        }
        let c = usize::from(pair.capsule) % PLACES;
        let lanes = L::Mask::of(lanes);
        if self.fast {
            let quick = sweep.cones.quick2.splat::<L>(c).lt(self.way2).and(lanes);
            if quick.any() {
                let swept = sweep.run(c, &mut self.x, &mut self.previous, self.friction, quick);
                self.swept += swept.count_ones();
                self.moved = true;
                self.measure(least_quick2);
            }
        }
        if !self.moved && few_of::<L>(pair.touched, self.from) == 0 {
            return;
        }
        let touches = close(sweep.cones, c, self.x, L::splat(-ON_M)).and(lanes);
        // What the first pass saw still holds as long as nothing was moved.
        if self.moved && !touches.any() {
            return;
        }
        let on = surface(sweep.cones, c, &place(sweep.cones, c, self.x));
        push(&mut self.x, &mut self.previous, &on, self.friction, touches);
        self.moved = true;
        self.measure(least_quick2);
    }

    /// Whatever is behind a plane is pushed out: there is no other side.
    #[inline(always)]
    fn meet_planes(&mut self, planes: &[[f32; 4]], block: &Block) {
        let mut bits = block.planes;
        while bits != 0 {
            let p = bits.trailing_zeros() as usize;
            bits &= bits - 1;
            let Some(plane) = planes.get(p) else { return };
            let lanes = L::Mask::of(few_of::<L>(block.plane_lanes[p % PLANES], self.from));
            let depth = depth(plane, self.x);
            let touches = L::splat(0.0).lt(depth).and(lanes);
            if touches.any() {
                let [x, y, z, _] = plane.map(L::splat);
                let zero = L::splat(0.0);
                let on = Surface { normal: V3 { x, y, z }, depth, carried: V3 { x: zero, y: zero, z: zero } };
                push(&mut self.x, &mut self.previous, &on, self.friction, touches);
                self.moved = true;
            }
        }
    }
}

/// Square of how far particles have moved in the substep (m2).
#[inline(always)]
fn way2<L: Lanes>(x: V3<L>, previous: V3<L>) -> L {
    let way = x - previous;
    way.dot(way)
}
