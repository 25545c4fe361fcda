//! Friction in bending: threads that rub keep a part of each bend.
//!
//! Beside the elastic moment B k a stencil has an element of friction in series with a spring (Prandtl 1928, Jenkin 1922):
//! M = B k + clamp(Kp (k - ks), -HB, HB), where ks, the curvature at which it sticks, follows k only while the clamp holds. The loop
//! of moment against curvature then has the slope B and the width 2 HB wherever it slips, as the Kawabata system measures
//! both, and a strip that is bent far and let go stays at HB / B. One number of state a stencil, six operations, nothing that the
//! processor estimates, so every width gives the same bits.
//!
//! A stencil's curvature is a vector, which turns with the cloth; what sticks must turn with it. So friction acts on its part along
//! the cloth's normal, which is the product of two chords over the vertex, and pushes along it.
//!
//! As a force at the positions of the substep's start it has to stay below what a substep can carry: a stencil that sticks is
//! as stiff as [`FrictionRows::prepare`] lets it be, which changes how round the loop's corners are, and neither its slope
//! nor its width.

use super::friction_rows::{FrictionBlock, FrictionPart, FrictionRows, FrictionStrip, FrictionTable, staggered};
use crate::lanes::{Kernel, Lanes, MOST, Numbers, ReadColumn, Readable, Store, V3, WriteColumn, reciprocal_root};

/// What stencils remember, and what they keep: columns in one store.
#[derive(Debug, Clone)]
pub struct FrictionState {
    numbers: Store,
    starts: [usize; 7],
    lens: [usize; 2],
}

/// The same as columns.
#[derive(Clone, Copy)]
pub struct FrictionColumns<'a> {
    /// Where each slot sticks (sqrt(N/m) m).
    pub sticks: WriteColumn<'a>,
    /// What friction keeps of each slot along the normal (sqrt(N/m) m); written in each substep in which it acts.
    pub kept: [WriteColumn<'a>; 3],
    /// Normal of the cloth at each particle in whose middle something rubs (1).
    pub normals: [WriteColumn<'a>; 3],
}

impl FrictionState {
    /// Of cloth of so many particles that was never bent since it was cut. At load.
    pub fn new(rows: &FrictionRows, particles: usize) -> Self {
        let lens = [rows.count, if rows.acts() { particles } else { 0 }];
        let (starts, end) = staggered(0, [lens[0], lens[0], lens[0], lens[0], lens[1], lens[1], lens[1]]);
        Self { numbers: Store::zeros(if rows.acts() { end } else { 0 }), starts, lens }
    }

    /// As columns for kernels.
    pub fn columns(&mut self) -> FrictionColumns<'_> {
        let (starts, [slots, particles]) = (self.starts, self.lens);
        let all = self.numbers.column();
        if slots == 0 {
            return FrictionColumns { sticks: all, kept: [all; 3], normals: [all; 3] };
        }
        let three = |first: usize, len: usize| [0, 1, 2].map(|axis| all.part(starts[first + axis], len));
        FrictionColumns { sticks: all.part(starts[0], slots), kept: three(1, slots), normals: three(4, particles) }
    }

    /// Where each slot sticks (sqrt(N/m) m); empty where nothing rubs.
    pub fn sticks(&self) -> &[f32] {
        &self.numbers.as_slice()[..if self.lens[0] > 0 { self.starts[0] + self.lens[0] } else { 0 }]
    }

    /// The same, to write.
    pub fn sticks_mut(&mut self) -> &mut [f32] {
        let len = self.sticks().len();
        &mut self.numbers.as_mut()[..len]
    }

    /// Memory that it holds (bytes).
    pub fn bytes(&self) -> usize {
        self.numbers.bytes()
    }
}

/// What is bent farther than this in one slot is no cloth any more, or not a number (sqrt(N/m) m): it does not make it slip.
const FARTHEST: f32 = 1e12;

/// What the friction of one owner's slots keeps of the places as they are.
pub struct FrictionMoments<'a> {
    /// The garment's friction.
    pub friction: &'a FrictionRows,
    /// Owner whose slots they are.
    pub owner: usize,
    /// The places (m).
    pub from: [WriteColumn<'a>; 3],
    /// What the slots remember and keep.
    pub state: FrictionColumns<'a>,
    /// Whether the cloth's normals are taken anew: once a step, in which cloth turns by some degrees.
    pub turns: bool,
}

impl Kernel for FrictionMoments<'_> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(mut self) {
        let len = self.from[0].len();
        let [x, y, z] = self.from;
        self.from = [x.cut(len), y.cut(len), z.cut(len)];
        let table = &self.friction.slots;
        for strip in &table.strips[table.owned_strips[self.owner].clone()] {
            self.strip::<L>(strip);
        }
        for block in &table.blocks[table.owned_blocks[self.owner].clone()] {
            self.block::<L>(block);
        }
    }
}

impl FrictionMoments<'_> {
    #[inline(always)]
    fn strip<L: Lanes>(&self, strip: &FrictionStrip) {
        let table = &self.friction.slots;
        let (first, len) = (strip.first as usize, strip.len as usize);
        let mut t = 0;
        while t < len {
            let (at, n) = (first + t, (len - t).min(L::N));
            let normal = self.normal::<L>(strip, at, n);
            let own = V3::<L>::load(self.from, at, n);
            for part in &table.parts[strip.parts.start as usize..strip.parts.end as usize] {
                if part.alike {
                    self.part::<L, true>(part, len, [t, n], at, own, normal);
                } else {
                    self.part::<L, false>(part, len, [t, n], at, own, normal);
                }
            }
            t += n;
        }
    }

    #[inline(always)]
    fn normal<L: Lanes>(&self, strip: &FrictionStrip, at: usize, n: usize) -> V3<L> {
        if !self.turns {
            return V3::load(self.state.normals, at, n);
        }
        let [a, b, c, d] = strip.chords;
        let one = self.beside::<L>(at, a, n) - self.beside(at, b, n);
        let normal = unit(one, self.beside(at, c, n) - self.beside(at, d, n));
        normal.store(self.state.normals, at, n);
        normal
    }

    /// One slot of each of `n` vertices, `t` and more of a strip.
    #[inline(always)]
    fn part<L: Lanes, const ALIKE: bool>(
        &self,
        part: &FrictionPart,
        len: usize,
        [t, n]: [usize; 2],
        at: usize,
        own: V3<L>,
        normal: V3<L>,
    ) {
        let table = &self.friction.slots;
        let offsets = &table.offsets[part.offsets.start as usize..part.offsets.end as usize];
        let (stick, reach) = (ReadColumn::new(self.friction.stick()), ReadColumn::new(self.friction.reach()));
        let mut sum = V3::<L>::splat(glam::Vec3A::ZERO);
        for (k, &offset) in offsets.iter().enumerate() {
            sum = sum + (self.beside::<L>(at, offset, n) - own) * value::<L, ALIKE>(table, part, k, len, [t, n]);
        }
        let slot = part.slot as usize + t;
        let sticks = some::<L>(self.state.sticks, slot, n);
        let [sticks, kept] = rubbed(sum.dot(normal), sticks, some(stick, slot, n), some(reach, slot, n));
        if n == L::N {
            sticks.store(self.state.sticks, slot);
        } else {
            sticks.store_part(self.state.sticks, slot, n);
        }
        (normal * kept).store(self.state.kept, slot, n);
    }

    #[inline(always)]
    fn beside<L: Lanes>(&self, at: usize, offset: i32, n: usize) -> V3<L> {
        V3::load(self.from, at.wrapping_add_signed(offset as isize), n)
    }

    #[inline(always)]
    fn block<L: Lanes>(&self, block: &FrictionBlock) {
        let table = &self.friction.slots;
        let values = ReadColumn::new(&table.values);
        let (stick, reach) = (ReadColumn::new(self.friction.stick()), ReadColumn::new(self.friction.reach()));
        let mut lane = 0;
        while lane < block.len as usize {
            let n = (block.len as usize - lane).min(L::N);
            let own = self.listed::<L>(block, 1, lane, n);
            let normal = if self.turns {
                let one = self.listed::<L>(block, 2, lane, n) - self.listed(block, 3, lane, n);
                let normal = unit(one, self.listed(block, 4, lane, n) - self.listed(block, 5, lane, n));
                self.turn(normal, index(table, block, 1, lane, n));
                normal
            } else {
                V3::gather(self.state.normals, index(table, block, 1, lane, n), n)
            };
            let mut sum = V3::<L>::splat(glam::Vec3A::ZERO);
            for k in 0..block.entries as usize {
                let value = some::<L>(values, block.values as usize + k * MOST + lane, n);
                sum = sum + (self.listed(block, 6 + k, lane, n) - own) * value;
            }
            let slots = index(table, block, 0, lane, n);
            let sticks = L::gather(self.state.sticks, slots, n);
            let [sticks, kept] =
                rubbed(sum.dot(normal), sticks, L::gather(stick, slots, n), L::gather(reach, slots, n));
            sticks.scatter(self.state.sticks, slots, n);
            (normal * kept).scatter(self.state.kept, slots, n);
            lane += L::N;
        }
    }

    /// Places of `n` particles of a block, those of its `k`th index.
    #[inline(always)]
    fn listed<L: Lanes>(&self, block: &FrictionBlock, k: usize, lane: usize, n: usize) -> V3<L> {
        V3::gather(self.from, index(&self.friction.slots, block, k, lane, n), n)
    }

    /// Keeps normals of vertices, of which one may be there twice, with the same normal.
    #[inline(always)]
    fn turn<L: Lanes>(&self, normal: V3<L>, vertices: &[u32]) {
        let (x, y, z) = (normal.x.to_array(), normal.y.to_array(), normal.z.to_array());
        for (t, &v) in vertices.iter().enumerate() {
            self.state.normals[0].set(v as usize, x[t]);
            self.state.normals[1].set(v as usize, y[t]);
            self.state.normals[2].set(v as usize, z[t]);
        }
    }
}

/// `n` of a block's `k`th indices.
#[inline(always)]
fn index<'a>(table: &'a FrictionTable, block: &FrictionBlock, k: usize, lane: usize, n: usize) -> &'a [u32] {
    &table.index[block.index as usize + k * MOST + lane..][..n]
}

/// The value of an entry of `n` vertices or rows, `t` and more of a strip.
#[inline(always)]
fn value<L: Lanes, const ALIKE: bool>(
    table: &FrictionTable,
    part: &FrictionPart,
    entry: usize,
    len: usize,
    [t, n]: [usize; 2],
) -> L {
    let (values, at) = (ReadColumn::new(&table.values), part.values as usize);
    if ALIKE { L::splat(values.get(at + entry)) } else { some(values, at + entry * len + t, n) }
}

/// Where a slot sticks after it was bent so far, and what it keeps; unchanged to the bit while it sticks.
#[inline(always)]
fn rubbed<L: Numbers>(bent: L, sticks: L, stick: L, reach: L) -> [L; 2] {
    let off = bent - sticks;
    let held = off.max(-reach).min(reach);
    let slips = off - held;
    let sound = slips.max(-slips).lt(L::splat(FARTHEST));
    [sticks + slips.select(sound, L::splat(0.0)), held * stick]
}

/// The normal of the cloth: the product of two chords, of length 1. Nothing where they are parallel.
#[inline(always)]
fn unit<L: Numbers>(one: V3<L>, other: V3<L>) -> V3<L> {
    let across = one.cross(other);
    across * reciprocal_root(across.dot(across))
}

/// `n <= N` numbers side by side.
#[inline(always)]
fn some<L: Lanes>(from: impl Readable, at: usize, n: usize) -> L {
    if n == L::N { L::load(from, at) } else { L::load_part(from, at, n) }
}

/// What the slots keep pushes one owner's particles.
pub struct FrictionForces<'a> {
    /// The garment's friction.
    pub friction: &'a FrictionRows,
    /// Owner whose rows they are.
    pub owner: usize,
    /// What the slots keep.
    pub kept: [WriteColumn<'a>; 3],
    /// What is pushed: the velocities (m/s).
    pub to: [WriteColumn<'a>; 3],
    /// How long (s).
    pub by: f32,
}

impl Kernel for FrictionForces<'_> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(mut self) {
        let (slots, len) = (self.kept[0].len(), self.to[0].len());
        let ([kx, ky, kz], [x, y, z]) = (self.kept, self.to);
        (self.kept, self.to) = ([kx.cut(slots), ky.cut(slots), kz.cut(slots)], [x.cut(len), y.cut(len), z.cut(len)]);
        let table = &self.friction.rows;
        for strip in &table.strips[table.owned_strips[self.owner].clone()] {
            self.strip::<L>(strip);
        }
        for block in &table.blocks[table.owned_blocks[self.owner].clone()] {
            self.block::<L>(block);
        }
    }
}

impl FrictionForces<'_> {
    #[inline(always)]
    fn strip<L: Lanes>(&self, strip: &FrictionStrip) {
        for part in &self.friction.rows.parts[strip.parts.start as usize..strip.parts.end as usize] {
            if part.alike { self.part::<L, true>(strip, part) } else { self.part::<L, false>(strip, part) }
        }
    }

    #[inline(always)]
    fn part<L: Lanes, const ALIKE: bool>(&self, strip: &FrictionStrip, part: &FrictionPart) {
        let table = &self.friction.rows;
        let offsets = &table.offsets[part.offsets.start as usize..part.offsets.end as usize];
        let (first, len) = (strip.first as usize, strip.len as usize);
        let mut t = 0;
        while t < len {
            let n = (len - t).min(L::N);
            let mut sum = V3::<L>::splat(glam::Vec3A::ZERO);
            for (k, &offset) in offsets.iter().enumerate() {
                let kept = V3::<L>::load(self.kept, (first + t).wrapping_add_signed(offset as isize), n);
                sum = sum + kept * value::<L, ALIKE>(table, part, k, len, [t, n]);
            }
            let to = V3::<L>::load(self.to, first + t, n);
            (to + sum * L::splat(self.by)).store(self.to, first + t, n);
            t += n;
        }
    }

    #[inline(always)]
    fn block<L: Lanes>(&self, block: &FrictionBlock) {
        let table = &self.friction.rows;
        let values = ReadColumn::new(&table.values);
        let mut lane = 0;
        while lane < block.len as usize {
            let n = (block.len as usize - lane).min(L::N);
            let mut sum = V3::<L>::splat(glam::Vec3A::ZERO);
            for k in 0..block.entries as usize {
                let kept = V3::<L>::gather(self.kept, index(table, block, 1 + k, lane, n), n);
                sum = sum + kept * some::<L>(values, block.values as usize + k * MOST + lane, n);
            }
            let rows = index(table, block, 0, lane, n);
            let to = V3::<L>::gather(self.to, rows, n);
            (to + sum * L::splat(self.by)).scatter(self.to, rows, n);
            lane += L::N;
        }
    }
}

#[cfg(test)]
mod tests;
