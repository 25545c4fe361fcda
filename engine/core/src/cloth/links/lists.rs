//! Fibers by index list, each solved directly: hoops, which close, and fibers that cross others.
//!
//! The same system as in `fibers`. In a hoop the first link shares a particle with the last, so the matrix is cyclic
//! tridiagonal: the last tension is bordered (its column `g` is carried along while the others are eliminated) and found
//! first on the way back. An open fiber is a hoop whose corner is 0.

use toile_base::garment::Solver;
use toile_base::garment::layout::{ENDED, FiberList, FiberLists};

use super::fibers::{FARTHEST, LEAST_PIVOT, NO_PIVOT, limited};
use crate::cloth::state::ParticleColumns;
use crate::lanes::{Kernel, Lanes, MOST, ReadColumn, Readable, V3, WriteColumn, reciprocal_root};

/// Vectors kept a row: position (three), weight, normal (three), right-hand side, factor, last column.
const KEPT: usize = 10;
const WEIGHT: usize = 3;
const NORMAL: usize = 4;
const SIDE: usize = 7;
const FACTOR: usize = 8;
const LAST: usize = 9;

/// Passes of a list that must not lengthen.
const ZERO_STRETCH_PASSES: usize = 3;

/// Numbers of scratch that the longest list needs.
pub fn scratch_len(lists: &FiberLists) -> usize {
    lists.lists.iter().map(|l| l.rows as usize).max().unwrap_or(0) * KEPT * MOST
}

/// One owner's share of one set.
pub struct SolveCrossing<'a> {
    /// The garment's particles.
    pub columns: ParticleColumns<'a>,
    /// All fibers by index list.
    pub lists: &'a FiberLists,
    /// Rest length (m) and compliance (m/N) of their links, as baked or as their curves have them now.
    pub links: [ReadColumn<'a>; 2],
    /// Index of the set that is solved now.
    pub set: usize,
    /// Owner whose share of it is solved.
    pub owner: usize,
    /// This worker's scratch.
    pub scratch: WriteColumn<'a>,
    /// 1 / dt^2 (1/s2).
    pub per_dt2: f32,
    /// The tension of each link so far in this substep, by its number, where they have compliance.
    pub tension: Option<WriteColumn<'a>>,
}

impl Kernel for SolveCrossing<'_> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self) {
        let range = &self.lists.sets[self.set][self.owner];
        for list in &self.lists.lists[range.start as usize..range.end as usize] {
            let mut lane = 0;
            while lane < list.lanes as usize {
                let n = (list.lanes as usize - lane).min(L::N);
                let ring = Ring { solve: &self, list, lane, n };
                if list.solver == Solver::ZeroStretch {
                    for _ in 0..ZERO_STRETCH_PASSES {
                        ring.direct::<L, true>();
                    }
                } else {
                    ring.direct::<L, false>();
                }
                lane += L::N;
            }
        }
    }
}

/// `n` fibers of a list from `lane` on.
struct Ring<'a> {
    solve: &'a SolveCrossing<'a>,
    list: &'a FiberList,
    lane: usize,
    n: usize,
}

impl Ring<'_> {
    #[inline(always)]
    fn index(&self, row: usize) -> &[u32] {
        let at = self.list.first as usize + row * self.list.lanes as usize + self.lane;
        &self.solve.lists.index[at..at + self.n]
    }

    /// Where a link of these fibers has its parameters, and its tension.
    #[inline(always)]
    fn place(&self, link: usize) -> usize {
        self.list.at as usize + link * self.list.lanes as usize + self.lane
    }

    /// Adds to the tension of a link.
    #[inline(always)]
    fn count<L: Lanes>(&self, link: usize, by: L) {
        if let Some(tension) = self.solve.tension {
            let at = self.place(link);
            let sum = self.numbers::<L>(tension, link) + by;
            if self.n == L::N { sum.store(tension, at) } else { sum.store_part(tension, at, self.n) }
        }
    }

    #[inline(always)]
    fn parameter<L: Lanes>(&self, from: ReadColumn<'_>, link: usize) -> L {
        self.numbers(from, link)
    }

    #[inline(always)]
    fn numbers<L: Lanes>(&self, from: impl Readable, link: usize) -> L {
        let at = self.place(link);
        if self.n == L::N { L::load(from, at) } else { L::load_part(from, at, self.n) }
    }

    #[inline(always)]
    fn keep<L: Lanes>(&self, row: usize, what: usize, value: L) {
        value.store(self.solve.scratch, (row * KEPT + what) * L::N);
    }

    #[inline(always)]
    fn kept<L: Lanes>(&self, row: usize, what: usize) -> L {
        L::load(self.solve.scratch, (row * KEPT + what) * L::N)
    }

    #[inline(always)]
    fn kept3<L: Lanes>(&self, row: usize, what: usize) -> V3<L> {
        V3 { x: self.kept(row, what), y: self.kept(row, what + 1), z: self.kept(row, what + 2) }
    }

    #[inline(always)]
    fn keep3<L: Lanes>(&self, row: usize, what: usize, v: V3<L>) {
        self.keep(row, what, v.x);
        self.keep(row, what + 1, v.y);
        self.keep(row, what + 2, v.z);
    }

    #[inline(always)]
    fn after(&self, row: usize) -> usize {
        if row + 1 == self.list.rows as usize { 0 } else { row + 1 }
    }

    #[inline(always)]
    fn direct<L: Lanes, const ZERO: bool>(&self) {
        let links = self.list.links() as usize;
        self.gather::<L>();
        self.normals::<L, ZERO>(links);
        let last = self.eliminate::<L, ZERO>(links);
        self.move_back::<L>(links, last);
    }

    #[inline(always)]
    fn gather<L: Lanes>(&self) {
        let c = &self.solve.columns;
        for row in 0..self.list.rows as usize {
            let index = self.index(row);
            self.keep3(row, 0, V3::<L>::gather(c.x, index, self.n));
            self.keep(row, WEIGHT, L::gather(c.w, index, self.n));
        }
    }

    #[inline(always)]
    fn normals<L: Lanes, const ZERO: bool>(&self, links: usize) {
        let mut p = self.kept3::<L>(0, 0);
        for link in 0..links {
            let q = self.kept3::<L>(self.after(link), 0);
            let d = q - p;
            let length2 = d.dot(d);
            let inverse = reciprocal_root(length2);
            let stretch = length2 * inverse - self.parameter::<L>(self.solve.links[0], link);
            let stretch = match self.solve.tension.filter(|_| !ZERO) {
                Some(tension) => {
                    let soft = self.parameter::<L>(self.solve.links[1], link) * L::splat(self.solve.per_dt2);
                    stretch - self.numbers::<L>(tension, link) * soft
                }
                None => stretch,
            };
            self.keep3(link, NORMAL, d * inverse);
            self.keep(link, SIDE, if ZERO { stretch.max(L::splat(0.0)) } else { stretch });
            p = q;
        }
    }

    /// The entry of a link on the matrix's diagonal.
    #[inline(always)]
    fn diagonal<L: Lanes, const ZERO: bool>(&self, link: usize) -> L {
        let soft = self.parameter::<L>(self.solve.links[1], link);
        let soft = if ZERO {
            soft.select(L::splat(0.1 * ENDED).lt(soft), L::splat(0.0))
        } else {
            soft * L::splat(self.solve.per_dt2)
        };
        self.kept::<L>(link, WEIGHT) + self.kept::<L>(self.after(link), WEIGHT) + soft
    }

    /// Minus the entry beside it, for a link and the one before.
    #[inline(always)]
    fn beside<L: Lanes>(&self, link: usize, before: usize) -> L {
        self.kept::<L>(link, WEIGHT) * self.kept3::<L>(link, NORMAL).dot(self.kept3(before, NORMAL))
    }

    /// L D L^T with the last tension bordered; gives that tension.
    #[inline(always)]
    fn eliminate<L: Lanes, const ZERO: bool>(&self, links: usize) -> L {
        let zero = L::splat(0.0);
        let end = links - 1;
        let mut last = if self.list.closed && end > 0 { self.beside(0, end) } else { zero };
        let full = self.diagonal::<L, ZERO>(end);
        let (mut corner, mut side) = (full, self.kept::<L>(end, SIDE));
        let (mut pivot, mut y) = (zero, zero);
        for link in 0..end {
            let b = if link > 0 { self.beside(link, link - 1) } else { zero };
            let factor = b * pivot;
            let whole = self.diagonal::<L, ZERO>(link);
            let left = (whole - factor * b).max(whole * L::splat(LEAST_PIVOT)).max(L::splat(NO_PIVOT));
            pivot = L::splat(1.0).div(left);
            y = self.kept::<L>(link, SIDE) + factor * y;
            if link > 0 {
                last = factor * last;
            }
            if link + 1 == end {
                last = last + self.beside(end, link);
            }
            let share = last * pivot;
            corner = corner - share * last;
            side = side + share * y;
            self.keep(link, FACTOR, factor);
            self.keep(link, LAST, share);
            self.keep(link, SIDE, y * pivot);
        }
        side.div(corner.max(full * L::splat(LEAST_PIVOT)).max(L::splat(NO_PIVOT)))
    }

    #[inline(always)]
    fn move_back<L: Lanes>(&self, links: usize, last: L) {
        let zero = L::splat(0.0);
        let end = links - 1;
        let rows = self.list.rows as usize;
        self.count(end, last);
        let outer = self.kept3::<L>(end, NORMAL) * last;
        let mut below = outer;
        if !self.list.closed {
            self.shift(rows - 1, V3 { x: zero, y: zero, z: zero } - outer, end);
        }
        let (mut lambda, mut factor) = (zero, zero);
        for link in (0..end).rev() {
            lambda = self.kept::<L>(link, SIDE) + self.kept::<L>(link, LAST) * last + factor * lambda;
            factor = self.kept(link, FACTOR);
            self.count(link, lambda);
            let pull = self.kept3::<L>(link, NORMAL) * lambda;
            self.shift(link + 1, below - pull, link);
            below = pull;
        }
        let first = if self.list.closed { below - outer } else { below };
        self.shift(0, first, 0);
    }

    /// Writes a row, moved by `pull` times its weight.
    #[inline(always)]
    fn shift<L: Lanes>(&self, row: usize, pull: V3<L>, link: usize) {
        let reach = self.parameter::<L>(self.solve.links[0], link) * L::splat(FARTHEST);
        let by = limited(pull * self.kept::<L>(row, WEIGHT), reach);
        (self.kept3::<L>(row, 0) + by).scatter(self.solve.columns.x, self.index(row), self.n);
    }
}
