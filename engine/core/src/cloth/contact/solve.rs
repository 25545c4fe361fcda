//! The kernel of a substep: every particle against what it is near.

use toile_assets::limits::MAX_CAPSULES;

use super::ContactSettings;
use super::near::{Block, PLANES, depth};
use super::sweep::Sweep;
use super::touch::{Friction, Surface, close, place, push, surface};
use crate::cloth::state::Columns;
use crate::lanes::{Kernel, Lanes, Mask, V3};

/// One substep over the blocks of one owner.
pub struct Solve<'a> {
    /// The garment's columns.
    pub cols: Columns<'a>,
    /// The capsules, at the end of the substep and along it.
    pub sweep: Sweep<'a>,
    /// Unit normals and offsets (m) of the planes, moved outwards by the contact offset.
    pub planes: &'a [[f32; 4]],
    /// The owner's blocks.
    pub blocks: &'a [Block],
    /// What a particle may move (m2) before any capsule has to sweep it.
    pub least_quick2: f32,
    /// Friction.
    pub how: &'a ContactSettings,
}

impl Kernel for Solve<'_> {
    /// Pairs whose way was followed.
    type Out = u64;

    #[inline(always)]
    fn run<L: Lanes>(self) -> u64 {
        let mut swept = 0;
        for block in self.blocks {
            if block.capsules | block.planes != 0 {
                swept += self.block::<L>(block);
            }
        }
        swept
    }
}

impl Solve<'_> {
    #[inline(always)]
    fn block<L: Lanes>(&self, block: &Block) -> u64 {
        let friction =
            Friction { hold: L::splat(self.how.friction_static), slide: L::splat(self.how.friction_kinetic) };
        let Self { cols, sweep, .. } = self;
        let (first, len) = block.place();
        let lanes_below = ((1u64 << L::N) - 1) as u32;
        let mut swept = 0;
        let mut from = 0;
        while from < len {
            let (at, n) = (first + from, L::N.min(len - from));
            let mut x = V3::<L>::load(cols.x, at, n);
            let mut previous = V3::<L>::load(cols.previous, at, n);
            let mut moved = false;
            let mut way2 = way(x, previous);
            let mut fast = L::splat(self.least_quick2).lt(way2).any();
            let mut bits = block.capsules;
            while bits != 0 {
                let c = bits.trailing_zeros() as usize % MAX_CAPSULES;
                bits &= bits - 1;
                let lanes = u32::from(block.lanes[c]) >> from & lanes_below;
                if L::N < 16 && lanes == 0 {
                    continue;
                }
                let lanes = L::Mask::of(lanes);
                if fast {
                    let quick = sweep.cones.quick2.splat::<L>(c).lt(way2).and(lanes);
                    if quick.any() {
                        swept += u64::from(sweep.run(c, &mut x, &mut previous, friction, quick).count_ones());
                        moved = true;
                        way2 = way(x, previous);
                    }
                }
                if !close(sweep.cones, c, x, L::splat(0.0)).and(lanes).any() {
                    continue;
                }
                let place = place(sweep.cones, c, x);
                let touches = place.out2.lt(place.reach * place.reach).and(lanes);
                if touches.any() {
                    push(&mut x, &mut previous, &surface(sweep.cones, c, &place), friction, touches);
                    moved = true;
                    way2 = way(x, previous);
                    fast = L::splat(self.least_quick2).lt(way2).any();
                }
            }
            moved |= self.planes(block, from, &mut x, &mut previous, friction);
            if moved {
                x.store(cols.x, at, n);
                previous.store(cols.previous, at, n);
            }
            from += L::N;
        }
        swept
    }

    /// Whatever is behind a plane is pushed out: there is no other side.
    #[inline(always)]
    fn planes<L: Lanes>(
        &self,
        block: &Block,
        from: usize,
        x: &mut V3<L>,
        previous: &mut V3<L>,
        friction: Friction<L>,
    ) -> bool {
        let mut moved = false;
        let mut bits = block.planes;
        while bits != 0 {
            let p = bits.trailing_zeros() as usize % PLANES;
            bits &= bits - 1;
            let lanes = L::Mask::of(u32::from(block.plane_lanes[p]) >> from);
            let depth = depth(&self.planes[p % self.planes.len()], *x);
            let touches = L::splat(0.0).lt(depth).and(lanes);
            if touches.any() {
                let [nx, ny, nz, _] = self.planes[p % self.planes.len()];
                let zero = L::splat(0.0);
                let normal = V3 { x: L::splat(nx), y: L::splat(ny), z: L::splat(nz) };
                let carried = V3 { x: zero, y: zero, z: zero };
                push(x, previous, &Surface { normal, depth, carried }, friction, touches);
                moved = true;
            }
        }
        moved
    }
}

/// Square of how far particles have moved in the substep (m2).
#[inline(always)]
fn way<L: Lanes>(x: V3<L>, previous: V3<L>) -> L {
    let way = x - previous;
    way.dot(way)
}
