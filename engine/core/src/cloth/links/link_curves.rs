//! Curves of links: the rest length and compliance of each link in this substep.
//!
//! A link's force is that of `fabric::link_curve`: three slopes and a slider in series with a spring. By the strain that
//! a link is about to have, as its ends are predicted, one of its slopes holds; by the strain at the start of the substep it
//! sticks or slips. That is a linear spring again, of another rest length and another compliance, and the solvers take these
//! in place of the baked ones. So the tridiagonal systems stay linear, and what is stiff, the spring by which a link sticks
//! too, is solved implicitly: no curve has to be softened to fit a substep.
//!
//! With e the strain, t the force over the link's stiffness k l, and s the strain at which it sticks:
//!   t = g e - o,   g = 1, o = 0 between the knees;   g = G, o = E (G - 1) behind a knee at E with the slope G;
//!   sticks:  g + K, o + K s;   slips: o -+ F, where F is the most that friction holds, and s follows e while K |e - s| > F.
//! Rest length l (1 + o / g), compliance c / g.

use std::ops::Range;

use toile_base::fabric::friction_element::STICKING;
use toile_base::garment::Garment;
use toile_base::garment::layout::{FiberLists, Fibers, Layout, Links, OWNERS};
use toile_base::garment::link_curves::CurveTable;

use super::link_gain::{NO_LEAST, Passes, gain};
use crate::cloth::state::ParticleColumns;
use crate::lanes::{Kernel, Lanes, MOST, Mask, Numbers, ReadColumn, Readable, Store, V3, WriteColumn, reciprocal_root};

/// Number of kinds of links, in the order of `garment::link_curves::LinkCurves`.
pub const KINDS: usize = 5;

/// Shear links, weft links, fibers, fibers by index list; fibers along the bias are 0.
pub const SHEAR: usize = 1;
/// Weft links.
pub const WEFT: usize = 2;
/// Warp fibers.
pub const FIBERS: usize = 3;
/// Fibers by index list.
pub const CROSSING: usize = 4;

/// Fewest links side by side that are worth a row.
const LEAST: u32 = 4;

/// Links whose ends and parameters lie side by side.
#[derive(Debug, Clone, Copy, PartialEq)]
struct CurveRow {
    ends: [u32; 2],
    at: u32,
    len: u32,
}

/// Where the links of one kind are.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct CurveRows {
    rows: Box<[CurveRow]>,
    /// Ends and places of those in no row.
    loose: [Box<[u32]>; 3],
    /// What each owner does of both.
    shares: [[Range<usize>; 2]; OWNERS],
}

impl CurveRows {
    /// Of links with their places.
    fn new(mut links: Vec<(u32, [u32; 2])>) -> Self {
        links.sort_unstable();
        let (mut rows, mut loose) = (Vec::new(), [const { Vec::new() }; 3]);
        let follows = |a: &(u32, [u32; 2]), b: &(u32, [u32; 2])| b.0 == a.0 + 1 && b.1 == a.1.map(|p| p + 1);
        for row in links.chunk_by(follows) {
            let (at, ends) = row[0];
            if row.len() as u32 >= LEAST {
                rows.push(CurveRow { ends, at, len: row.len() as u32 });
                continue;
            }
            for &(at, [a, b]) in row {
                loose.iter_mut().zip([a, b, at]).for_each(|(column, value)| column.push(value));
            }
        }
        // Half of the links each: any would do, since each link is one's own.
        let all: u32 = rows.iter().map(|r| r.len).sum();
        let mut sum = 0;
        let middle = rows
            .iter()
            .take_while(|r| {
                sum += r.len;
                2 * sum <= all
            })
            .count();
        let half = loose[0].len().div_ceil(2).next_multiple_of(MOST).min(loose[0].len());
        let shares = [[0..middle, 0..half], [middle..rows.len(), half..loose[0].len()]];
        Self { rows: rows.into(), loose: loose.map(Into::into), shares }
    }

    /// The rows of each kind of links that has curves.
    pub fn of(garment: &Garment) -> [Self; KINDS] {
        let layout = garment.layout();
        let found = [
            bias(layout),
            tuples(&layout.shear),
            tuples(&layout.weft),
            fibers(&layout.fibers),
            lists(&layout.crossing),
        ];
        let mut tables = layout.link_curves.tables().into_iter();
        found.map(|links| if tables.next().is_some_and(|t| !t.is_empty()) { Self::new(links) } else { Self::default() })
    }

    /// Memory that it holds (bytes).
    pub fn bytes(&self) -> usize {
        size_of_val(&*self.rows) + 12 * self.loose[0].len()
    }
}

fn bias(layout: &Layout) -> Vec<(u32, [u32; 2])> {
    let mut out = Vec::new();
    layout.diagonals.for_each(|at, ends| out.push((at as u32, ends)));
    out
}

fn tuples(links: &Links) -> Vec<(u32, [u32; 2])> {
    let mut out = Vec::new();
    links.tuples.for_each(|at, ends| out.push((at as u32, ends)));
    out
}

fn fibers(fibers: &Fibers) -> Vec<(u32, [u32; 2])> {
    let mut out = Vec::new();
    for bundle in &fibers.bundles {
        let rows = &fibers.rows[bundle.rows.start as usize..bundle.rows.end as usize];
        for (link, pair) in (0..).zip(rows.windows(2)) {
            let at = bundle.at + link * bundle.lanes;
            out.extend((0..pair[1].lanes).map(|lane| (at + lane, [pair[0].first + lane, pair[1].first + lane])));
        }
    }
    out
}

fn lists(lists: &FiberLists) -> Vec<(u32, [u32; 2])> {
    let mut out = Vec::new();
    for list in &lists.lists {
        for link in 0..list.links() {
            for lane in 0..list.lanes {
                let particle = |row: u32| lists.index[(list.first + row % list.rows * list.lanes + lane) as usize];
                out.push((list.at + link * list.lanes + lane, [particle(link), particle(link + 1)]));
            }
        }
    }
    out
}

/// What the links of one kind are in this substep, as columns of their places.
#[derive(Clone, Copy)]
pub struct CurveColumns<'a> {
    /// Strain at which each sticks (1).
    pub sticks: WriteColumn<'a>,
    /// Rest length (m).
    pub rest: WriteColumn<'a>,
    /// Compliance (m/N).
    pub compliance: WriteColumn<'a>,
    /// Gain, of links that are solved by Gauss-Seidel.
    pub gain: WriteColumn<'a>,
    /// Least tension that they may come to, over the square of a substep (N s2): what a thread bears that is pushed together.
    pub least: WriteColumn<'a>,
    /// 1 over the rest length as baked (1/m); written at load.
    pub per_rest: WriteColumn<'a>,
    /// Rest length over compliance as baked: the force at a strain of 1 (N); written at load.
    pub stiffness: WriteColumn<'a>,
}

/// Columns of each kind, in one store.
#[derive(Debug, Clone)]
pub struct CurveState {
    numbers: Store,
    /// Places of each kind, filled up to whole vectors.
    lens: [usize; KINDS],
}

/// Columns of a kind.
const COLUMNS: usize = 7;

impl CurveState {
    /// Of links that were never deformed. At load.
    pub fn new(layout: &Layout) -> Self {
        let lens = layout.link_curves.tables().map(|t| t.len().next_multiple_of(MOST));
        let mut state = Self { numbers: Store::zeros(COLUMNS * lens.iter().sum::<usize>()), lens };
        // Places of no link, where a fiber has ended, stay as they were baked, and carry what they like.
        let baked = |kind: usize| match kind {
            0 => [&layout.diagonals.rest, &layout.diagonals.compliance],
            SHEAR => [&layout.shear.rest, &layout.shear.compliance],
            WEFT => [&layout.weft.rest, &layout.weft.compliance],
            FIBERS => [&layout.fibers.rest, &layout.fibers.compliance],
            _ => [&layout.crossing.rest, &layout.crossing.compliance],
        };
        for kind in (0..KINDS).filter(|&kind| lens[kind] > 0) {
            let (first, len) = (state.first(kind), lens[kind]);
            state.numbers.as_mut()[first + 4 * len..][..len].fill(NO_LEAST);
            let [rest, compliance] = baked(kind);
            for (at, (rest, compliance)) in rest.iter().zip(compliance.iter()).enumerate() {
                let figures = [(1, *rest), (2, *compliance), (5, rest.recip()), (6, rest / compliance)];
                figures.into_iter().for_each(|(column, v)| state.numbers.as_mut()[first + column * len + at] = v);
            }
        }
        state
    }

    fn first(&self, kind: usize) -> usize {
        COLUMNS * self.lens[..kind].iter().sum::<usize>()
    }

    /// As columns for kernels.
    pub fn columns(&mut self) -> [CurveColumns<'_>; KINDS] {
        let (lens, firsts) = (self.lens, [0, 1, 2, 3, 4].map(|kind| self.first(kind)));
        let all = self.numbers.column();
        std::array::from_fn(|kind| {
            let column = |k: usize| all.part(firsts[kind] + k * lens[kind], lens[kind]);
            let [sticks, rest, compliance, gain, least, per_rest, stiffness] = [0, 1, 2, 3, 4, 5, 6].map(column);
            CurveColumns { sticks, rest, compliance, gain, least, per_rest, stiffness }
        })
    }

    /// Where links stick, kind after kind (1).
    pub fn sticks(&self) -> impl Iterator<Item = &[f32]> {
        (0..KINDS).map(|kind| &self.numbers.as_slice()[self.first(kind)..][..self.lens[kind]])
    }

    /// Takes over where the links of another state of the same garment stick.
    pub fn remember(&mut self, other: &Self) {
        for kind in (0..KINDS).filter(|&kind| self.lens[kind] == other.lens[kind]) {
            let (to, from) = (self.first(kind), other.first(kind));
            self.numbers.as_mut()[to..to + self.lens[kind]]
                .copy_from_slice(&other.numbers.as_slice()[from..][..self.lens[kind]]);
        }
    }

    /// Memory that it holds (bytes).
    pub fn bytes(&self) -> usize {
        self.numbers.bytes()
    }
}

/// How the gain of links is made.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CurveGain {
    /// 1 and the damping time over the substep (1).
    pub damped: f32,
    /// How often they are solved.
    pub passes: Passes,
}

/// One owner's links of one kind.
pub struct FollowCurves<'a> {
    /// The garment's particles.
    pub columns: ParticleColumns<'a>,
    /// Where the links are.
    pub rows: &'a CurveRows,
    /// Owner whose share is done.
    pub owner: usize,
    /// Their curves.
    pub table: &'a CurveTable,
    /// Rest length and compliance as baked.
    pub baked: [&'a [f32]; 2],
    /// What they are now.
    pub to: CurveColumns<'a>,
    /// 1 / dt^2 (1/s2).
    pub per_dt2: f32,
    /// Gain to make, of links that are solved by Gauss-Seidel.
    pub gain: Option<CurveGain>,
}

/// Least stiffness of what sticks, over a link's own (1).
const LEAST_STICKING: f32 = 0.1;

/// Strains beyond this are not cloth's, or not numbers: they do not make anything slip (1).
const FARTHEST: f32 = 1e6;

impl Kernel for FollowCurves<'_> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(mut self) {
        self.columns = self.columns.level();
        let [rows, loose] = &self.rows.shares[self.owner];
        let c = self.columns;
        for row in &self.rows.rows[rows.clone()] {
            let mut t = 0;
            while t < row.len as usize {
                let n = (row.len as usize - t).min(L::N);
                let [a, b] = row.ends.map(|p| p as usize + t);
                let had = V3::<L>::load(c.previous, b, n) - V3::load(c.previous, a, n);
                let has = V3::<L>::load(c.x, b, n) - V3::load(c.x, a, n);
                let weight = some::<L>(c.w, a, n) + some(c.w, b, n);
                self.follow(Beside { at: row.at as usize + t, n }, [had, has], weight);
                t += n;
            }
        }
        let [a, b, at] = &self.rows.loose;
        let mut k = loose.start;
        while k < loose.end {
            let n = (loose.end - k).min(L::N);
            let [a, b] = [&a[k..k + n], &b[k..k + n]];
            let had = V3::<L>::gather(c.previous, b, n) - V3::gather(c.previous, a, n);
            let has = V3::<L>::gather(c.x, b, n) - V3::gather(c.x, a, n);
            let weight = L::gather(c.w, a, n) + L::gather(c.w, b, n);
            self.follow(Listed(&at[k..k + n]), [had, has], weight);
            k += n;
        }
    }
}

/// Places of some links.
trait Places: Copy {
    fn load<L: Lanes>(self, from: impl Readable) -> L;
    fn store<L: Lanes>(self, values: L, to: WriteColumn<'_>);
}

#[derive(Clone, Copy)]
struct Beside {
    at: usize,
    n: usize,
}

impl Places for Beside {
    #[inline(always)]
    fn load<L: Lanes>(self, from: impl Readable) -> L {
        some(from, self.at, self.n)
    }

    #[inline(always)]
    fn store<L: Lanes>(self, values: L, to: WriteColumn<'_>) {
        if self.n == L::N { values.store(to, self.at) } else { values.store_part(to, self.at, self.n) }
    }
}

#[derive(Clone, Copy)]
struct Listed<'a>(&'a [u32]);

impl Places for Listed<'_> {
    #[inline(always)]
    fn load<L: Lanes>(self, from: impl Readable) -> L {
        L::gather(from, self.0, self.0.len())
    }

    #[inline(always)]
    fn store<L: Lanes>(self, values: L, to: WriteColumn<'_>) {
        values.scatter(to, self.0, self.0.len());
    }
}

impl FollowCurves<'_> {
    /// Stiffness of what sticks, over the link's own. Links that are solved once a substep hold what their ends weigh over its square
    /// and no more: as stiff as the rest of that, so that a sticking link carries the force of its curve before it slips.
    #[inline(always)]
    fn sticking<L: Numbers>(&self, weight: L, compliance: L) -> L {
        let most = L::splat(STICKING as f32);
        match self.gain {
            Some(CurveGain { damped, passes: Passes::Once }) => {
                let ends = (weight * L::splat(damped)).max(L::splat(f32::MIN_POSITIVE));
                let left = (compliance * L::splat(self.per_dt2)).div(ends) - L::splat(1.0);
                left.max(L::splat(LEAST_STICKING)).min(most)
            }
            _ => most,
        }
    }

    #[inline(always)]
    fn follow<L: Lanes>(&self, at: impl Places, [had, has]: [V3<L>; 2], weight: L) {
        let (table, one) = (self.table, L::splat(1.0));
        let (rest, compliance) = (at.load::<L>(column(self.baked[0])), at.load::<L>(column(self.baked[1])));
        let per_rest = at.load::<L>(self.to.per_rest);
        let below = [at.load(column(&table.lower)), at.load(column(&table.lower_slope))];
        let above = [at.load(column(&table.upper)), at.load(column(&table.upper_slope))];
        let [slope, offset] = slope_at(strain(has, per_rest), below, above);
        let (stuck, holds) = (at.load::<L>(self.to.sticks), at.load::<L>(column(&table.friction)));
        let had = strain(had, per_rest);
        // A thread that has given way does not rub: what was measured is friction of threads that are drawn.
        let gives = had.lt(below[0]).and(below[1].lt(one));
        let holds = L::splat(0.0).select(gives, holds);
        let sticking = self.sticking(weight, compliance);
        let [stuck, sticks, keeps, rubs] = rubbed(had, stuck, holds, sticking);
        at.store(stuck, self.to.sticks);
        let stiff = at.load::<L>(self.to.stiffness) * L::splat(self.per_dt2.recip());
        at.store(least(had, below, rubs, stiff), self.to.least);
        let (slope, offset) = (slope + sticks, offset + keeps);
        let per_slope = one.div(slope);
        let soft = compliance * per_slope;
        at.store(rest * (one + offset * per_slope), self.to.rest);
        at.store(soft, self.to.compliance);
        if let Some(CurveGain { damped, passes }) = self.gain {
            at.store(gain(weight * L::splat(damped), soft * L::splat(self.per_dt2), passes), self.to.gain);
        }
    }
}

#[inline(always)]
fn column(numbers: &[f32]) -> ReadColumn<'_> {
    ReadColumn::new(numbers)
}

/// Strain of links of some vectors.
#[inline(always)]
fn strain<L: Numbers>(d: V3<L>, per_rest: L) -> L {
    let length2 = d.dot(d);
    length2 * reciprocal_root(length2) * per_rest - L::splat(1.0)
}

/// Least tension of links that give way below their lower knee, of a strain, with what their friction holds, given their stiffness
/// over the square of the substep: what is pushed on beyond it is not resisted. As a slope it would have to change from pass to
/// pass: a link that goes slack while it is solved, or taut, would have the wrong one, and gain energy.
#[inline(always)]
fn least<L: Numbers>(strain: L, [lower, below]: [L; 2], rubs: L, stiff: L) -> L {
    let further = (strain - lower).min(L::splat(0.0));
    let bears = (lower + below * further + rubs) * stiff;
    bears.select(below.lt(L::splat(1.0)), L::splat(NO_LEAST))
}

/// Slope and offset at a strain, given knees and slopes below and above; a slope below that is less than 1 is [`least`]'s.
#[inline(always)]
fn slope_at<L: Numbers>(strain: L, [lower, below]: [L; 2], [upper, above]: [L; 2]) -> [L; 2] {
    let one = L::splat(1.0);
    let (long, short) = (upper.lt(strain), strain.lt(lower).and(one.lt(below)));
    let slope = above.select(long, below.select(short, one));
    let knee = upper.select(long, lower.select(short, L::splat(0.0)));
    [slope, knee * (slope - one)]
}

/// Where a link sticks, as stiff as `sticking` over its own stiffness, after it was strained so far, what its friction adds to slope and offset, and what it holds.
#[inline(always)]
fn rubbed<L: Numbers>(strain: L, stuck: L, holds: L, sticking: L) -> [L; 4] {
    let zero = L::splat(0.0);
    let reach = holds.div(sticking);
    let off = strain - stuck;
    let held = off.max(-reach).min(reach);
    let slips = off - held;
    let far = slips.max(-slips);
    let stuck = stuck + slips.select(far.lt(L::splat(FARTHEST)), zero);
    let (rubs, slipping) = (zero.lt(holds), zero.lt(far));
    let slope = zero.select(slipping, sticking.select(rubs, zero));
    let offset = (-(held * sticking)).select(slipping, (stuck * sticking).select(rubs, zero));
    [stuck, slope, offset, held * sticking]
}

/// `n <= N` numbers side by side.
#[inline(always)]
fn some<L: Lanes>(from: impl Readable, at: usize, n: usize) -> L {
    if n == L::N { L::load(from, at) } else { L::load_part(from, at, n) }
}

#[cfg(test)]
mod tests;
