//! Bending of a whole garment as one matrix, a row a particle that moves.
//!
//! Stencils and hubs say what is bent (assets, `bake::links`): each stores (1/2) |d|^2 with d = sum c_j x_j, the curvature
//! along its fiber or over its ring times the root of its stiffness, and its coefficients add up to nothing. All of them
//! together push a particle by -sum K_ij (x_j - x_i), where K_ij is the sum of c_i c_j over those that hold both: linear in
//! the positions, so that nothing can go wrong where cloth is folded flat. A row is written by its own particle alone, and
//! workers need no barrier for stencils that cross owners.
//!
//! Rows side by side whose neighbours lie side by side too are a [`RowStrip`] and read columns; what is in no strip is a
//! [`RowBlock`] of sixteen rows of much the same length, and reads records.

use std::ops::Range;

use toile_base::garment::Garment;
use toile_base::garment::layout::OWNERS;

use crate::lanes::{MOST, RecordList};

/// Rows that are a strip: fewer are as well off in a block.
const LEAST_STRIP: u32 = 6;

/// Rows that follow each other which make a block of their own: fewer share theirs with others.
const LEAST_SEQUENCE: usize = 8;

/// Difference between two entries, as a part of the row's greatest, below which they count as the same: as the bake has it for
/// lengths and masses.
const SAME: f32 = 1e-5;

/// Row index of a particle without a row: one that is fixed, or that nothing bends.
const NO_ROW: u32 = u32::MAX;

/// Rows `first..first + len`, of which row `t` reads the particles `first + t + offsets`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RowStrip {
    /// Particle of the first row.
    pub first: u32,
    /// Number of rows.
    pub len: u32,
    /// Where its offsets begin in [`BendingMatrix::offsets`].
    pub offsets: u32,
    /// Entries of each row.
    pub entries: u32,
    /// Where its values begin: for each entry those of all rows, or one for all of them.
    pub values: u32,
    /// Whether the rows are all alike.
    pub alike: bool,
}

impl RowStrip {
    /// Where entry `k` of row `t` has its value.
    #[inline(always)]
    pub fn value(&self, k: u32, t: u32) -> usize {
        (self.values + if self.alike { k } else { k * self.len + t }) as usize
    }
}

/// Sixteen rows; those with fewer entries than the longest end with some of no weight.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RowBlock {
    /// Whether its rows follow each other in memory.
    pub sequence: bool,
    /// Rows, at most sixteen.
    pub len: u32,
    /// Entries of each row.
    pub entries: u32,
    /// Where its neighbours begin in [`BendingMatrix::neighbours`], sixteen an entry.
    pub neighbours: u32,
    /// Where its values begin, sixteen an entry.
    pub values: u32,
}

/// The matrix of one garment.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct BendingMatrix {
    /// Strips, owner after owner.
    pub strips: Box<[RowStrip]>,
    /// From a row's particle to its neighbours, strip after strip.
    pub offsets: Box<[i32]>,
    /// Blocks, owner after owner.
    pub blocks: Box<[RowBlock]>,
    /// The blocks' rows, sixteen a block; the last of a block again where it has fewer.
    pub rows: RecordList,
    /// The blocks' neighbours.
    pub neighbours: RecordList,
    /// Entries -w_i K_ij (1/s2), strips before blocks.
    pub values: Box<[f32]>,
    /// What each owner has of the strips.
    pub owned_strips: [Range<u32>; OWNERS],
    /// What each owner has of the blocks.
    pub owned_blocks: [Range<u32>; OWNERS],
    /// Which strip has the row of a particle, or behind all strips which of the blocks' rows it is `[particles]`.
    place: Box<[u32]>,
    /// Share of its stiffness that a strip of rows alike has `[strips]`.
    shares: Box<[f32]>,
    /// Whether the values are those of the whole stiffness.
    whole: bool,
}

impl BendingMatrix {
    /// That of a garment, its stiffness whole. At load.
    pub fn new(garment: &Garment) -> Self {
        let neighbours = neighbours(garment);
        let mut this = Self { place: vec![NO_ROW; neighbours.len()].into(), ..Self::default() };
        let mut loose: [Vec<u32>; OWNERS] = Default::default();
        let (mut strips, mut offsets) = (Vec::new(), Vec::new());
        for (owner, loose) in loose.iter_mut().enumerate() {
            let begun = strips.len() as u32;
            for &(first, len) in &garment.layout().spans[owner] {
                let (mut at, end) = (first, first + len);
                while at < end {
                    let row = &neighbours[at as usize];
                    let len = 1 + (at + 1..end).take_while(|&i| leads_alike(&neighbours, at, i)).count() as u32;
                    let strip = RowStrip {
                        first: at,
                        len,
                        offsets: offsets.len() as u32,
                        entries: row.len() as u32,
                        values: 0,
                        alike: false,
                    };
                    match row.is_empty() {
                        true => {}
                        false if len < LEAST_STRIP => loose.extend(at..at + len),
                        false => {
                            this.place[at as usize..(at + len) as usize].fill(strips.len() as u32);
                            offsets.extend(row.iter().map(|&j| j.cast_signed() - at.cast_signed()));
                            strips.push(strip);
                        }
                    }
                    at += len;
                }
            }
            this.owned_strips[owner] = begun..strips.len() as u32;
        }
        (this.strips, this.offsets) = (strips.into(), offsets.into());
        this.shares = vec![1.0; this.strips.len()].into();
        this.gather_blocks(&neighbours, loose);
        this.lay_values();
        this.fill(garment, &[], f32::INFINITY);
        this.share_alike();
        this
    }

    /// Rows that are in no strip by sixteen: as many as follow each other, then the rest, longest first.
    fn gather_blocks(&mut self, neighbours: &[Vec<u32>], loose: [Vec<u32>; OWNERS]) {
        let (mut blocks, mut rows, mut listed) = (Vec::new(), Vec::new(), Vec::new());
        let entries = |i: u32| neighbours[i as usize].len();
        for (owner, mine) in loose.into_iter().enumerate() {
            let begun = blocks.len() as u32;
            let chunks = mine.chunk_by(|a, b| a + 1 == *b).flat_map(|run| run.chunks(MOST));
            let (whole, rest): (Vec<&[u32]>, Vec<&[u32]>) = chunks.partition(|c| c.len() >= LEAST_SEQUENCE);
            let mut rest = rest.concat();
            rest.sort_by_key(|&i| (std::cmp::Reverse(entries(i)), i));
            for (block, sequence) in whole.into_iter().map(|b| (b, true)).chain(rest.chunks(MOST).map(|b| (b, false))) {
                let most = block.iter().map(|i| entries(*i)).max().unwrap_or(0);
                let row = |lane: usize| block[lane.min(block.len() - 1)];
                for (lane, &i) in block.iter().enumerate() {
                    self.place[i as usize] = (self.strips.len() + rows.len() + lane) as u32;
                }
                blocks.push(RowBlock {
                    sequence,
                    len: block.len() as u32,
                    entries: most as u32,
                    neighbours: listed.len() as u32,
                    values: 0,
                });
                rows.extend((0..MOST).map(row));
                for k in 0..most {
                    listed.extend((0..MOST).map(|lane| *neighbours[row(lane) as usize].get(k).unwrap_or(&row(lane))));
                }
            }
            self.owned_blocks[owner] = begun..blocks.len() as u32;
        }
        (self.blocks, self.rows, self.neighbours) = (blocks.into(), RecordList::new(rows), RecordList::new(listed));
    }

    /// Gives all values their places.
    fn lay_values(&mut self) {
        let mut end = 0;
        for strip in &mut self.strips {
            strip.values = end;
            end += strip.entries * if strip.alike { 1 } else { strip.len };
        }
        for block in &mut self.blocks {
            block.values = end;
            end += block.entries * MOST as u32;
        }
        self.values = vec![0.0; end as usize].into();
    }

    /// Strips whose rows have the same values keep them once.
    fn share_alike(&mut self) {
        let (old, before) = (self.values.clone(), self.strips.clone());
        let blocks_from = self.blocks.first().map_or(old.len(), |b| b.values as usize);
        for strip in &mut self.strips {
            let entry = |k: u32| &old[strip.value(k, 0)..][..strip.len as usize];
            let most = (0..strip.entries).map(|k| entry(k)[0].abs()).fold(0.0, f32::max);
            strip.alike = (0..strip.entries).all(|k| entry(k).iter().all(|v| (v - entry(k)[0]).abs() <= SAME * most));
        }
        self.lay_values();
        for (strip, before) in self.strips.iter().zip(&before) {
            for (k, t) in (0..strip.entries).flat_map(|k| (0..strip.len).map(move |t| (k, t))).filter(|_| !strip.alike)
            {
                self.values[strip.value(k, t)] = old[before.value(k, t)];
            }
            (0..strip.entries).filter(|_| strip.alike).for_each(|k| {
                self.values[strip.value(k, 0)] = old[before.value(k, 0)];
            });
        }
        let kept = &old[blocks_from..];
        let behind = self.values.len() - kept.len();
        self.values[behind..].copy_from_slice(kept);
    }

    /// The values where what puts more than `limit` on a particle ([`add_load`](super::bending::add_load)) is weakened; gives
    /// the least share of a stiffness that is left. Allocates nothing. Of rows alike, all are as weak as the weakest.
    pub fn fill(&mut self, garment: &Garment, load: &[f32], limit: f32) -> f32 {
        let weakened = load.iter().any(|l| *l > limit);
        if !weakened && self.whole {
            return 1.0;
        }
        self.whole = !weakened;
        self.values.fill(0.0);
        self.shares.fill(1.0);
        let mut least = 1.0f32;
        garment.layout().for_each_bend(|particles, coefficient| {
            let most = particles.iter().filter_map(|&i| load.get(i as usize)).copied().fold(0.0, f32::max);
            let share = if most > limit { limit / most } else { 1.0 };
            least = least.min(share);
            for (a, &i) in particles.iter().enumerate() {
                let weight = garment.inverse_mass[i as usize];
                if weight > 0.0 {
                    let share = self.share_of(i, share);
                    self.add(particles, a, -(weight * share * coefficient(a)), coefficient);
                }
            }
        });
        for (strip, share) in self.strips.iter().zip(&self.shares).filter(|(strip, share)| strip.alike && **share < 1.0)
        {
            self.values[strip.values as usize..][..strip.entries as usize].iter_mut().for_each(|v| *v *= share);
        }
        least
    }

    /// The share that a stencil adds to the row of a particle: rows alike keep the least of theirs for the end.
    fn share_of(&mut self, particle: u32, share: f32) -> f32 {
        let strip = self.place[particle as usize] as usize;
        match self.strips.get(strip) {
            Some(RowStrip { alike: true, .. }) => {
                self.shares[strip] = self.shares[strip].min(share);
                1.0
            }
            _ => share,
        }
    }

    /// Adds a stencil to the row of its particle `a`.
    fn add(&mut self, particles: &[u32], a: usize, by: f32, coefficient: &dyn Fn(usize) -> f32) {
        let i = particles[a];
        let place = self.place[i as usize] as usize;
        for (b, &j) in particles.iter().enumerate().filter(|(b, _)| *b != a) {
            let at = if let Some(strip) = self.strips.get(place) {
                if strip.alike && i != strip.first {
                    return;
                }
                let offsets = &self.offsets[strip.offsets as usize..][..strip.entries as usize];
                let offset = j.cast_signed() - i.cast_signed();
                offsets.binary_search(&offset).ok().map(|k| strip.value(k as u32, i - strip.first))
            } else {
                let (block, lane) = ((place - self.strips.len()) / MOST, (place - self.strips.len()) % MOST);
                let block = self.blocks[block];
                let listed = |k: u32| block.neighbours as usize + k as usize * MOST + lane;
                let found = (0..block.entries).find(|&k| self.neighbours.record(listed(k)) == j);
                found.map(|k| block.values as usize + k as usize * MOST + lane)
            };
            if let Some(at) = at {
                self.values[at] += by * coefficient(b);
            }
        }
    }

    /// Calls `each(particle, neighbours and values)` for every row, in no order of the particles.
    pub fn for_each_row(&self, mut each: impl FnMut(u32, &mut dyn Iterator<Item = (u32, f32)>)) {
        for strip in &self.strips {
            let offsets = &self.offsets[strip.offsets as usize..][..strip.entries as usize];
            for t in 0..strip.len {
                let i = strip.first + t;
                let entry = |(k, offset): (u32, &i32)| (i.wrapping_add_signed(*offset), self.values[strip.value(k, t)]);
                each(i, &mut (0..).zip(offsets).map(entry));
            }
        }
        for (number, block) in self.blocks.iter().enumerate() {
            for lane in 0..block.len as usize {
                let at = |from: u32, k: usize| from as usize + k * MOST + lane;
                let entry = |k| (self.neighbours.record(at(block.neighbours, k)), self.values[at(block.values, k)]);
                let i = self.rows.record(number * MOST + lane);
                each(i, &mut (0..block.entries as usize).map(entry).filter(|(j, _)| *j != i));
            }
        }
    }

    /// Whether any row reads records.
    pub fn reads_records(&self) -> bool {
        !self.blocks.is_empty()
    }

    /// Memory that it holds (bytes).
    pub fn bytes(&self) -> usize {
        size_of_val(&*self.strips)
            + size_of_val(&*self.blocks)
            + 4 * (self.offsets.len() + self.values.len() + self.place.len() + self.shares.len())
            + self.rows.bytes()
            + self.neighbours.bytes()
    }
}

/// The particles that push each one, in the order of memory; none for one that does not move.
fn neighbours(garment: &Garment) -> Vec<Vec<u32>> {
    let mut out = vec![Vec::new(); garment.start.len()];
    garment.layout().for_each_bend(|particles, _| {
        for &i in particles.iter().filter(|i| garment.inverse_mass[**i as usize] > 0.0) {
            out[i as usize].extend(particles.iter().filter(|j| **j != i));
        }
    });
    for row in &mut out {
        row.sort_unstable();
        row.dedup();
    }
    out
}

/// Whether two rows' neighbours lie the same way from them.
fn leads_alike(neighbours: &[Vec<u32>], a: u32, b: u32) -> bool {
    let (one, other) = (&neighbours[a as usize], &neighbours[b as usize]);
    one.len() == other.len() && one.iter().zip(other).all(|(p, q)| p + b == q + a)
}
