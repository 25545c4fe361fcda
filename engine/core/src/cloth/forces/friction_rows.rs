//! Friction in bending, laid out for the lanes: which stencils rub (*slots*), and which of them push each particle (*rows*).
//!
//! A slot has the number `kind * stride + centre`, so that vertices side by side, whose neighbours lie side by side too, have
//! slots side by side: a strip, which reads columns. What is in no strip is a block of sixteen, which reads by index.

use std::ops::Range;

use toile_base::garment::Garment;
use toile_base::garment::bend_friction::FrictionSlot;
use toile_base::garment::layout::OWNERS;

use crate::lanes::{MOST, Store};

/// Slots or rows that are a strip: fewer are as well off in a block.
const LEAST_STRIP: usize = 6;

/// Stiffness of a stencil that sticks over its elastic one (1): it sticks over a tenth of the curvature at which the cloth stays.
pub const STICKING: f32 = 20.0;

/// Least of it for which friction acts in fewer substeps: sticking over a quarter of that curvature.
const ENOUGH: f32 = 8.0;

/// Bound on dt^2 omega^2 up to which friction that sticks is a plain force: with bending's own it stays below half of what is
/// stable.
const STABLE: f32 = 1.2;

/// One particle in so many may be held back more than the others.
const NEEDLES: usize = 50;

/// Vertices whose slots lie alike, or rows, side by side.
#[derive(Debug, Clone, PartialEq)]
pub struct FrictionStrip {
    /// The first vertex, or the particle of the first row.
    pub first: u32,
    /// Vertices or rows.
    pub len: u32,
    /// From a vertex to the ends of its chords; of rows nothing.
    pub chords: [i32; 4],
    /// Slots of each vertex, of rows one, a range of [`FrictionTable::parts`].
    pub parts: Range<u32>,
}

/// One slot of each vertex of a strip, or its rows.
#[derive(Debug, Clone, PartialEq)]
pub struct FrictionPart {
    /// The slot of the first vertex; of rows nothing.
    pub slot: u32,
    /// What each reads, from its vertex or particle on: a range of [`FrictionTable::offsets`].
    pub offsets: Range<u32>,
    /// Where the values begin: those of all for each entry, or one for all of them.
    pub values: u32,
    /// Whether they are all alike.
    pub alike: bool,
}

/// Sixteen slots or rows in no order; what has fewer entries than the longest ends with some of no weight.
#[derive(Debug, Clone, PartialEq)]
pub struct FrictionBlock {
    /// Slots or rows, at most sixteen.
    pub len: u32,
    /// Entries of each.
    pub entries: u32,
    /// Where its indices begin in [`FrictionTable::index`], sixteen of each: the slot or particle; of slots the middle and the
    /// four ends of the chords; then the entries.
    pub index: u32,
    /// Where its values begin, sixteen an entry.
    pub values: u32,
}

/// Strips and blocks of slots, or of rows.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct FrictionTable {
    /// Strips, owner after owner.
    pub strips: Box<[FrictionStrip]>,
    /// What the strips have of slots or rows.
    pub parts: Box<[FrictionPart]>,
    /// From a strip's particles to what they read.
    pub offsets: Box<[i32]>,
    /// Blocks, owner after owner.
    pub blocks: Box<[FrictionBlock]>,
    /// Indices of the blocks.
    pub index: Box<[u32]>,
    /// Coefficients of strips and blocks.
    pub values: Box<[f32]>,
    /// What each owner has of the strips.
    pub owned_strips: [Range<usize>; OWNERS],
    /// What each owner has of the blocks.
    pub owned_blocks: [Range<usize>; OWNERS],
}

/// Numbers between two places that a processor takes for the same when it looks whether a load follows a store (4 KiB), as for
/// the particles' columns.
const ALIAS: usize = 1_024;

/// How far the columns of slots start behind each other of these, and the kinds within one: so that what one slot stores is never
/// taken for what the next one loads.
const STAGGER: [usize; 2] = [112, 48];

/// Where the columns from the `first` on begin that have so many numbers each, and where the last ends.
pub fn staggered<const N: usize>(first: usize, lens: [usize; N]) -> ([usize; N], usize) {
    let mut end = 0usize;
    let starts = std::array::from_fn(|c| {
        let start = end + ((first + c) * STAGGER[0] + 100 * ALIAS - end) % ALIAS;
        end = (start + lens[c]).next_multiple_of(MOST);
        start
    });
    (starts, end)
}

/// The friction of one garment.
#[derive(Debug, Clone, PartialEq)]
pub struct FrictionRows {
    /// From places to what is bent: coefficients (sqrt(N/m)).
    pub slots: FrictionTable,
    /// From what is kept to accelerations: -w_i times the coefficient (sqrt(N/m)/kg).
    pub rows: FrictionTable,
    /// Number of slots, unused ones included.
    pub count: usize,
    /// From a kind's slots to the next one's.
    stride: u32,
    /// Stiffness and reach of each slot, and where each begins.
    parameters: Store,
    starts: [usize; 2],
    /// It acts every so many substeps, with the impulse of all of them.
    pub every: u32,
}

/// Difference between two values, as a part of the greatest, below which they count as the same: as for bending.
const SAME: f32 = 1e-5;

/// One slot or row before it has its place.
#[derive(Clone)]
struct FrictionLine {
    number: u32,
    centre: u32,
    chords: Option<[u32; 4]>,
    entries: Vec<(u32, f32)>,
}

impl FrictionLine {
    /// Whether `other` is `by` further on in every way.
    fn leads_to(&self, other: &Self, by: u32) -> bool {
        let ends = |line: &Self| line.chords.unwrap_or_default();
        other.number == self.number + by
            && other.centre == self.centre + by
            && (self.chords.is_none() || ends(self).iter().zip(ends(other)).all(|(a, b)| a + by == b))
            && self.entries.len() == other.entries.len()
            && self.entries.iter().zip(&other.entries).all(|(a, b)| a.0 + by == b.0)
    }
}

/// Whether all lines of one vertex lead to those of another, `by` further on.
fn lead_to(one: &[FrictionLine], other: &[FrictionLine], by: usize) -> bool {
    one.len() == other.len() && one.iter().zip(other).all(|(a, b)| a.leads_to(b, by as u32))
}

impl FrictionTable {
    fn new(lines: [Vec<FrictionLine>; OWNERS]) -> Self {
        let mut this = FrictionTableBuilder::default();
        let mut out = Self::default();
        for (owner, lines) in lines.into_iter().enumerate() {
            let begun = [this.strips.len(), this.blocks.len()];
            this.gather(&lines);
            out.owned_strips[owner] = begun[0]..this.strips.len();
            out.owned_blocks[owner] = begun[1]..this.blocks.len();
        }
        Self {
            strips: this.strips.into(),
            parts: this.parts.into(),
            offsets: this.offsets.into(),
            blocks: this.blocks.into(),
            index: this.index.into(),
            values: this.values.into(),
            ..out
        }
    }

    fn bytes(&self) -> usize {
        size_of_val(&*self.strips)
            + size_of_val(&*self.parts)
            + size_of_val(&*self.blocks)
            + 4 * (self.offsets.len() + self.index.len() + self.values.len())
    }
}

#[derive(Default)]
struct FrictionTableBuilder {
    strips: Vec<FrictionStrip>,
    parts: Vec<FrictionPart>,
    offsets: Vec<i32>,
    blocks: Vec<FrictionBlock>,
    index: Vec<u32>,
    values: Vec<f32>,
}

impl FrictionTableBuilder {
    /// Lines in the order of their vertices.
    fn gather(&mut self, lines: &[FrictionLine]) {
        let vertices: Vec<&[FrictionLine]> = lines.chunk_by(|a, b| a.centre == b.centre).collect();
        let (mut at, mut loose) = (0, Vec::new());
        while at < vertices.len() {
            let len =
                (1..vertices.len() - at).take_while(|by| lead_to(vertices[at], vertices[at + by], *by)).count() + 1;
            let some = &vertices[at..at + len];
            if len < LEAST_STRIP {
                loose.extend(some.iter().copied().flatten());
            } else {
                self.strip(some);
            }
            at += len;
        }
        loose.sort_by_key(|line| std::cmp::Reverse(line.entries.len()));
        loose.chunks(MOST).for_each(|some| self.block(some));
    }

    fn strip(&mut self, vertices: &[&[FrictionLine]]) {
        let begun = self.parts.len() as u32;
        for (k, line) in vertices[0].iter().enumerate() {
            let from = self.offsets.len() as u32;
            self.offsets.extend(line.entries.iter().map(|(to, _)| to.cast_signed() - line.centre.cast_signed()));
            let most = line.entries.iter().map(|(_, c)| c.abs()).fold(0.0, f32::max);
            let like = |other: &FrictionLine| {
                line.entries.iter().zip(&other.entries).all(|(a, b)| (a.1 - b.1).abs() <= SAME * most)
            };
            let alike = vertices.iter().all(|v| like(&v[k]));
            self.parts.push(FrictionPart {
                slot: line.number,
                offsets: from..self.offsets.len() as u32,
                values: self.values.len() as u32,
                alike,
            });
            let kept = if alike { 1 } else { vertices.len() };
            for e in 0..line.entries.len() {
                self.values.extend(vertices[..kept].iter().map(|v| v[k].entries[e].1));
            }
        }
        let first = &vertices[0][0];
        self.strips.push(FrictionStrip {
            first: first.centre,
            len: vertices.len() as u32,
            chords: first.chords.unwrap_or([first.centre; 4]).map(|c| c.cast_signed() - first.centre.cast_signed()),
            parts: begun..self.parts.len() as u32,
        });
    }

    fn block(&mut self, lines: &[&FrictionLine]) {
        let line = |lane: usize| lines[lane.min(lines.len() - 1)];
        let most = lines.iter().map(|l| l.entries.len()).max().unwrap_or(0);
        self.blocks.push(FrictionBlock {
            len: lines.len() as u32,
            entries: most as u32,
            index: self.index.len() as u32,
            values: self.values.len() as u32,
        });
        self.index.extend((0..MOST).map(|lane| line(lane).number));
        if lines[0].chords.is_some() {
            self.index.extend((0..MOST).map(|lane| line(lane).centre));
            for k in 0..4 {
                self.index.extend((0..MOST).map(|lane| line(lane).chords.unwrap_or_default()[k]));
            }
        }
        for k in 0..most {
            // What is read without weight is there: the first entry again.
            let entry = |lane: usize| line(lane).entries.get(k).copied().unwrap_or((line(lane).entries[0].0, 0.0));
            self.index.extend((0..MOST).map(|lane| entry(lane).0));
            self.values.extend((0..MOST).map(|lane| entry(lane).1));
        }
    }
}

impl FrictionRows {
    /// That of a garment; nothing is prepared yet. At load.
    pub fn new(garment: &Garment) -> Self {
        let (friction, n) = (&garment.layout().friction, garment.start.len() as u32);
        let owner = |particle: u32| usize::from(garment.layout().owner[particle as usize]);
        let (mut slots, mut rows): ([Vec<FrictionLine>; OWNERS], [Vec<FrictionLine>; OWNERS]) = Default::default();
        let stride = ((n as usize).next_multiple_of(ALIAS) + STAGGER[1]) as u32;
        let mut pushed: Vec<Vec<(u32, f32)>> = vec![Vec::new(); if friction.slots.is_empty() { 0 } else { n as usize }];
        for slot in &friction.slots {
            let number = slot.kind * stride + slot.centre;
            let entries: Vec<(u32, f32)> = friction.entries(slot).collect();
            let own = -entries.iter().map(|(_, c)| c).sum::<f32>();
            for (i, c) in entries.iter().copied().chain([(slot.centre, own)]) {
                let w = garment.inverse_mass[i as usize];
                if w > 0.0 && c != 0.0 {
                    pushed[i as usize].push((number, -w * c));
                }
            }
            let line = FrictionLine { number, centre: slot.centre, chords: Some(slot.chords), entries };
            slots[owner(slot.centre)].push(line);
        }
        for (i, mut entries) in (0..).zip(pushed).filter(|(_, entries)| !entries.is_empty()) {
            entries.sort_unstable_by_key(|(slot, _)| *slot);
            rows[owner(i)].push(FrictionLine { number: i, centre: i, chords: None, entries });
        }
        slots.iter_mut().for_each(|own| own.sort_by_key(|line| (line.centre, line.number)));
        let count = (friction.kinds() * stride) as usize;
        let (starts, end) = staggered(7, [count; 2]);
        Self {
            slots: FrictionTable::new(slots),
            rows: FrictionTable::new(rows),
            count,
            stride,
            parameters: Store::zeros(if count > 0 { end } else { 0 }),
            starts,
            every: 1,
        }
    }

    /// Number of a slot.
    pub fn number(&self, slot: &FrictionSlot) -> usize {
        (slot.kind * self.stride + slot.centre) as usize
    }

    /// Stiffness of each slot while it sticks over the elastic one (1), as prepared.
    pub fn stick(&self) -> &[f32] {
        &self.parameters.as_slice()[self.starts[0]..][..self.count]
    }

    /// How far what is bent gets from where it sticks before it slips (sqrt(N/m) m), of each slot, as prepared.
    pub fn reach(&self) -> &[f32] {
        &self.parameters.as_slice()[self.starts[1]..][..self.count]
    }

    /// Whether anything rubs.
    pub fn acts(&self) -> bool {
        self.count > 0
    }

    /// Stiffness while it sticks, and how often it acts, for substeps of `dt` (s); `load` is room for a number a particle. Gives
    /// the least stiffness of all, over the elastic one. Allocates nothing.
    pub fn prepare(&mut self, garment: &Garment, dt: f32, substeps: u32, load: &mut [f32]) -> f32 {
        if !self.acts() {
            return STICKING;
        }
        let friction = &garment.layout().friction;
        load.fill(0.0);
        let each = |slot: &FrictionSlot, put: &mut dyn FnMut(u32, f32)| {
            let (sum, all) = friction.entries(slot).fold((0.0, 0.0), |(s, a), (_, c)| (s + c, a + c.abs()));
            friction.entries(slot).chain([(slot.centre, -sum)]).for_each(|(i, c)| put(i, c.abs() * (all + sum.abs())));
        };
        for slot in &friction.slots {
            each(slot, &mut |i, load_of| load[i as usize] += dt * dt * garment.inverse_mass[i as usize] * load_of);
        }
        let few = load.len() / NEEDLES;
        let carries = |every: &u32| {
            let most = STABLE / (ENOUGH * (every * every) as f32);
            substeps.is_multiple_of(*every) && load.iter().filter(|l| **l > most).count() <= few
        };
        self.every = (1..=substeps).rev().find(carries).unwrap_or(1);
        let most = STABLE / (self.every * self.every) as f32;
        let mut least = STICKING;
        for slot in &friction.slots {
            let mut heaviest = 0.0f32;
            each(slot, &mut |i, _| heaviest = heaviest.max(load[i as usize]));
            let stick = if STICKING * heaviest > most { most / heaviest } else { STICKING };
            let at = self.number(slot);
            let to = self.parameters.as_mut();
            (to[self.starts[0] + at], to[self.starts[1] + at]) = (stick, slot.limit / stick);
            least = least.min(stick);
        }
        least
    }

    /// Memory that it holds (bytes).
    pub fn bytes(&self) -> usize {
        self.slots.bytes() + self.rows.bytes() + self.parameters.bytes()
    }
}
