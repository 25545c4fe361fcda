//! Friction in bending, laid out for the lanes: which stencils rub (*slots*), and which of them push each particle (*rows*).
//!
//! A slot has the number `kind * particles + centre`, so that vertices side by side, whose neighbours lie side by side too, have
//! slots side by side: a strip, which reads columns. What is in no strip is a block of sixteen, which reads by index.

use std::ops::Range;

use toile_assets::garment::Garment;
use toile_assets::garment::bend_friction::FrictionSlot;
use toile_assets::garment::layout::OWNERS;

use crate::lanes::MOST;

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

/// Slots or rows side by side: the first of them, how many, and from it to what each reads.
#[derive(Debug, Clone, PartialEq)]
pub struct FrictionStrip {
    /// First slot, or first particle.
    pub first: u32,
    /// Particle in the middle of the first slot; of rows the first particle.
    pub centre: u32,
    /// Slots or rows.
    pub len: u32,
    /// From the middle's particle to the ends of the chords; of rows nothing.
    pub chords: [i32; 4],
    /// Where its offsets begin in [`FrictionTable::offsets`], and of how many entries: from the middle's particle, or from the row's.
    pub offsets: Range<u32>,
    /// Where its values begin: those of all rows for each entry.
    pub values: u32,
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

/// The friction of one garment.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct FrictionRows {
    /// From places to what is bent: coefficients (sqrt(N/m)).
    pub slots: FrictionTable,
    /// From what is kept to accelerations: -w_i times the coefficient (sqrt(N/m)/kg).
    pub rows: FrictionTable,
    /// Number of slots, those that nobody has among them.
    pub count: usize,
    /// Stiffness while it sticks over the elastic one, of each slot (1); written by [`Self::prepare`].
    pub stick: Box<[f32]>,
    /// How far what is bent gets from where it sticks before it slips (sqrt(N/m) m), of each slot; written by [`Self::prepare`].
    pub reach: Box<[f32]>,
    /// It acts every so many substeps, with the impulse of all of them.
    pub every: u32,
}

/// One slot or row before it has its place.
struct Line {
    number: u32,
    centre: u32,
    chords: Option<[u32; 4]>,
    entries: Vec<(u32, f32)>,
}

impl Line {
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

impl FrictionTable {
    fn new(lines: [Vec<Line>; OWNERS]) -> Self {
        let mut this = Builder::default();
        let mut out = Self::default();
        for (owner, lines) in lines.into_iter().enumerate() {
            let begun = [this.strips.len(), this.blocks.len()];
            this.gather(&lines);
            out.owned_strips[owner] = begun[0]..this.strips.len();
            out.owned_blocks[owner] = begun[1]..this.blocks.len();
        }
        Self {
            strips: this.strips.into(),
            offsets: this.offsets.into(),
            blocks: this.blocks.into(),
            index: this.index.into(),
            values: this.values.into(),
            ..out
        }
    }

    fn bytes(&self) -> usize {
        size_of_val(&*self.strips)
            + size_of_val(&*self.blocks)
            + 4 * (self.offsets.len() + self.index.len() + self.values.len())
    }
}

#[derive(Default)]
struct Builder {
    strips: Vec<FrictionStrip>,
    offsets: Vec<i32>,
    blocks: Vec<FrictionBlock>,
    index: Vec<u32>,
    values: Vec<f32>,
}

impl Builder {
    fn gather(&mut self, lines: &[Line]) {
        let (mut at, mut loose) = (0, Vec::new());
        while at < lines.len() {
            let first = &lines[at];
            let len = (1u32..).zip(&lines[at + 1..]).take_while(|(by, line)| first.leads_to(line, *by)).count() + 1;
            let some = &lines[at..at + len];
            if len < LEAST_STRIP { loose.extend(some) } else { self.strip(some) }
            at += len;
        }
        loose.sort_by_key(|line| std::cmp::Reverse(line.entries.len()));
        loose.chunks(MOST).for_each(|some| self.block(some));
    }

    fn strip(&mut self, lines: &[Line]) {
        let first = &lines[0];
        let from = |to: u32| to.cast_signed() - first.centre.cast_signed();
        let begun = self.offsets.len() as u32;
        self.offsets.extend(first.entries.iter().map(|(to, _)| from(*to)));
        self.strips.push(FrictionStrip {
            first: first.number,
            centre: first.centre,
            len: lines.len() as u32,
            chords: first.chords.unwrap_or([first.centre; 4]).map(from),
            offsets: begun..self.offsets.len() as u32,
            values: self.values.len() as u32,
        });
        for k in 0..first.entries.len() {
            self.values.extend(lines.iter().map(|line| line.entries[k].1));
        }
    }

    fn block(&mut self, lines: &[&Line]) {
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
        let (mut slots, mut rows): ([Vec<Line>; OWNERS], [Vec<Line>; OWNERS]) = Default::default();
        let mut pushed: Vec<Vec<(u32, f32)>> = vec![Vec::new(); if friction.slots.is_empty() { 0 } else { n as usize }];
        for slot in &friction.slots {
            let number = slot.kind * n + slot.centre;
            let entries: Vec<(u32, f32)> = friction.entries(slot).collect();
            let own = -entries.iter().map(|(_, c)| c).sum::<f32>();
            for (i, c) in entries.iter().copied().chain([(slot.centre, own)]) {
                let w = garment.inverse_mass[i as usize];
                if w > 0.0 && c != 0.0 {
                    pushed[i as usize].push((number, -w * c));
                }
            }
            let line = Line { number, centre: slot.centre, chords: Some(slot.chords), entries };
            slots[owner(slot.centre)].push(line);
        }
        for (i, mut entries) in (0..).zip(pushed).filter(|(_, entries)| !entries.is_empty()) {
            entries.sort_unstable_by_key(|(slot, _)| *slot);
            rows[owner(i)].push(Line { number: i, centre: i, chords: None, entries });
        }
        let count = (friction.kinds() * n) as usize;
        Self {
            slots: FrictionTable::new(slots),
            rows: FrictionTable::new(rows),
            count,
            stick: vec![0.0; count].into(),
            reach: vec![0.0; count].into(),
            every: 1,
        }
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
        let (friction, n) = (&garment.layout().friction, garment.start.len() as u32);
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
            let at = (slot.kind * n + slot.centre) as usize;
            (self.stick[at], self.reach[at]) = (stick, slot.limit / stick);
            least = least.min(stick);
        }
        least
    }

    /// Memory that it holds (bytes).
    pub fn bytes(&self) -> usize {
        self.slots.bytes() + self.rows.bytes() + 8 * self.count
    }
}
