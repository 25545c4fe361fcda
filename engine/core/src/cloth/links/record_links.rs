//! Links by records: for garments whose links lie in no long rows. The same links in the same order as [`links`](super)
//! solves them in columns, to the same bits; which form a garment's links take is a matter of time alone.

use std::collections::VecDeque;
use std::ops::Range;

use toile_base::garment::layout::{ConstraintRun, Links, OWNERS};

use super::link_gain::Slack;
use super::{LinkGains, LinkParameters, push};
use crate::lanes::{Kernel, Lanes, MOST, ReadColumn, RecordList, V3, WriteColumn};

/// What a sweep over links costs in either form (ns), as an AVX-512 core has it: only their ratios count.
mod cost {
    /// A vector of a row of links, in columns.
    pub const ROW: f64 = 8.0;
    /// A zigzag or run, in columns, whatever its length.
    pub const BEGUN: f64 = 12.0;
    /// A link that is in no row, in columns.
    pub const LOOSE: f64 = 6.5;
    /// A link, by records.
    pub const RECORD: f64 = 1.2;
    /// A particle on its way from columns to records and back, a sweep.
    pub const PARTICLE: f64 = 0.5;
}

/// Records between two that a processor takes for the same when it looks whether a load follows a store (4 KiB).
const ALIAS: u32 = 256;

/// Sixteens of links that a processor works on at once: what the earlier ones write, the later must not seem to read.
const IN_FLIGHT: usize = 3;

/// Links among which the next is looked for: farther ones would be elsewhere in memory.
const LOOK_AHEAD: usize = 512;

/// Links of one kind as records, set after set, owner after owner, by sixteen; what fills up the last sixteen of a share are
/// links of no weight from a spare record to itself.
#[derive(Debug, Clone, PartialEq)]
pub struct RecordLinks {
    /// Both ends.
    ends: [RecordList; 2],
    /// Where the links of each share begin, of sixteen: a set's straights and others, then its slants.
    shares: Box<[[[Range<u32>; 2]; OWNERS]]>,
    /// Place of each link's parameters; nothing for what fills up.
    places: Box<[Option<u32>]>,
    /// Rest length, or 1 over its square where nothing gives; gain; the weights that both ends count with; compliance.
    numbers: [Box<[f32]>; 5],
}

impl RecordLinks {
    /// Those of a garment, where that is the faster form.
    pub fn of(links: &Links, weights: &[f32]) -> Option<Self> {
        preferred(links, weights.len()).then(|| Self::new(links, weights))
    }

    /// The links as records; the gains are yet to be made.
    pub fn new(links: &Links, weights: &[f32]) -> Self {
        let mut out =
            Builder { links, weights, ends: Default::default(), places: Vec::new(), numbers: Default::default() };
        let shares = links.tuples.sets.iter().map(|set| {
            std::array::from_fn(|owner| {
                let share = &set.shares[owner];
                let zigzags = &links.tuples.zigzags[share.zigzags.start as usize..share.zigzags.end as usize];
                let begun = out.ends[0].len();
                zigzags.iter().for_each(|z| out.row(&z.straights, z.straights.len));
                let runs = &links.tuples.runs[share.runs.start as usize..share.runs.end as usize];
                runs.iter().for_each(|run| out.row(run, run.len));
                for (k, i) in share.loose.clone().enumerate() {
                    let ends = links.tuples.loose[i as usize];
                    out.push(share.loose_at as usize + k, ends, ends);
                }
                let first = out.fill_up(begun, owner);
                let begun = out.ends[0].len();
                for z in zigzags {
                    out.row(&z.slants, z.slants.len - u32::from(z.closed()));
                    if z.closed() {
                        let t = z.slants.len - 1;
                        let counted = if z.slants.alike { z.slants.first } else { z.slant(t) };
                        out.push(z.slants.place(t), z.slant(t), counted);
                    }
                }
                [first, out.fill_up(begun, owner)]
            })
        });
        let shares = shares.collect();
        let Builder { ends, places, numbers, .. } = out;
        Self { ends: ends.map(RecordList::new), shares, places: places.into(), numbers: numbers.map(Into::into) }
    }

    /// Takes over what the settings made; `soft` says whether the links give or are damped.
    pub fn prepare(&mut self, links: &Links, gains: &LinkGains, soft: bool) {
        let [rest, gain, ..] = &mut self.numbers;
        for ((place, rest), gain) in self.places.iter().zip(rest).zip(gain) {
            let Some(place) = place.map(|p| p as usize) else { continue };
            (*rest, *gain) = (if soft { links.rest[place] } else { gains.per_rest2[place] }, gains.gain[place]);
        }
    }

    /// Links, and what fills up: as many tensions are kept.
    pub fn len(&self) -> usize {
        self.places.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.places.is_empty()
    }

    /// Memory that it holds (bytes).
    pub fn bytes(&self) -> usize {
        self.ends.iter().map(RecordList::bytes).sum::<usize>()
            + size_of_val(&*self.shares)
            + size_of_val(&*self.places)
            + self.numbers.iter().map(|n| size_of_val(&**n)).sum::<usize>()
    }
}

/// Whether records are the faster form for the links of a garment of so many particles.
pub fn preferred(links: &Links, particles: usize) -> bool {
    by_records(links, particles) < by_columns(links)
}

/// Time of a sweep in columns (ns).
fn by_columns(links: &Links) -> f64 {
    let row = |len: u32| cost::BEGUN + cost::ROW * f64::from(len.div_ceil(MOST as u32));
    let zigzags = links.tuples.zigzags.iter().map(|z| row(z.straights.len) + row(z.slants.len));
    let runs = links.tuples.runs.iter().map(|r| row(r.len));
    zigzags.chain(runs).sum::<f64>() + cost::LOOSE * links.tuples.loose.len() as f64
}

/// Time of a sweep by records (ns).
fn by_records(links: &Links, particles: usize) -> f64 {
    cost::RECORD * links.tuples.count as f64 + cost::PARTICLE * particles as f64
}

struct Builder<'a> {
    links: &'a Links,
    weights: &'a [f32],
    ends: [Vec<u32>; 2],
    places: Vec<Option<u32>>,
    numbers: [Vec<f32>; 5],
}

impl Builder<'_> {
    fn row(&mut self, run: &ConstraintRun<2>, len: u32) {
        for t in 0..len {
            let ends = run.first.map(|f| f + t);
            self.push(run.place(t), ends, if run.alike { run.first } else { ends });
        }
    }

    /// A link, and the particles whose weights it counts with: of what is alike, those of the first.
    fn push(&mut self, place: usize, ends: [u32; 2], counted: [u32; 2]) {
        (0..2).for_each(|k| self.ends[k].push(ends[k]));
        self.places.push(Some(place as u32));
        let [wa, wb] = counted.map(|p| self.weights[p as usize]);
        let numbers = [0.0, 0.0, wa, wb, self.links.compliance[place]];
        self.numbers.iter_mut().zip(numbers).for_each(|(to, number)| to.push(number));
    }

    /// Puts the links from `begun` on into an order in which none reads where the sixteens just before it wrote, nor at a place
    /// that the processor takes for it; they share no particle, so that their order changes no bit.
    fn part_ways(&mut self, begun: usize) {
        let mut left: VecDeque<usize> = (begun..self.places.len()).collect();
        let mut order = Vec::with_capacity(left.len());
        let mut written: VecDeque<Vec<u32>> = VecDeque::new();
        let slots = |this: &Self, k: usize| this.ends.each_ref().map(|e| e[k] % ALIAS);
        while !left.is_empty() {
            let mut taken = Vec::with_capacity(2 * MOST);
            for _ in 0..MOST.min(left.len()) {
                let apart = |k: &usize| slots(self, *k).iter().all(|s| written.iter().all(|w| !w.contains(s)));
                let at = left.iter().take(LOOK_AHEAD).position(apart).unwrap_or(0);
                let Some(k) = left.remove(at) else { break };
                taken.extend(slots(self, k));
                order.push(k);
            }
            written.push_back(taken);
            if written.len() > IN_FLIGHT {
                written.pop_front();
            }
        }
        let before = (self.ends.clone(), self.places.clone(), self.numbers.clone());
        for (to, &from) in (begun..).zip(&order) {
            (0..2).for_each(|e| self.ends[e][to] = before.0[e][from]);
            self.places[to] = before.1[from];
            self.numbers.iter_mut().zip(&before.2).for_each(|(numbers, old)| numbers[to] = old[from]);
        }
    }

    /// Fills up what was begun at `begun`; gives its range, of sixteen.
    fn fill_up(&mut self, begun: usize, owner: usize) -> Range<u32> {
        self.part_ways(begun);
        let end = self.places.len().next_multiple_of(MOST);
        // The two workers' spare records are two: neither writes where the other does.
        let spare = (self.weights.len() + owner) as u32;
        self.ends.iter_mut().for_each(|e| e.resize(end, spare));
        self.places.resize(end, None);
        self.numbers.iter_mut().for_each(|n| n.resize(end, 0.0));
        (begun / MOST) as u32..(end / MOST) as u32
    }
}

/// One owner's share of one set.
pub struct SolveRecordLinks<'a> {
    /// The garment's links.
    pub links: &'a RecordLinks,
    /// Number of the set that is solved now.
    pub set: usize,
    /// Owner whose share is solved.
    pub owner: usize,
    /// The particles' records, and behind them one to spare for each owner.
    pub records: WriteColumn<'a>,
    /// The tension of each link so far in this substep, and 1 / dt^2, where links have compliance.
    pub tension: Option<(WriteColumn<'a>, f32)>,
}

impl Kernel for SolveRecordLinks<'_> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self) {
        for half in &self.links.shares[self.set][self.owner] {
            let range = half.start as usize * MOST..half.end as usize * MOST;
            match self.tension {
                Some((tension, per_dt2)) => self.soft::<L>(range, tension, L::splat(per_dt2)),
                None => self.stiff::<L>(range),
            }
        }
    }
}

impl SolveRecordLinks<'_> {
    #[inline(always)]
    fn numbers<L: Lanes, const COUNT: usize>(&self, k: usize) -> [L; COUNT] {
        let mut out = [L::splat(0.0); COUNT];
        for (out, numbers) in out.iter_mut().zip(&self.links.numbers) {
            *out = L::load(ReadColumn::new(numbers), k);
        }
        out
    }

    #[inline(always)]
    fn stiff<L: Lanes>(&self, range: Range<usize>) {
        let mut k = range.start;
        while k < range.end {
            let [rest, gain, wa, wb] = self.numbers::<L, 4>(k);
            let parameters = LinkParameters { rest, gain, slack: Slack::none(), weights: [wa, wb] };
            self.solve::<L, false>(k, parameters);
            k += L::N;
        }
    }

    #[inline(always)]
    fn soft<L: Lanes>(&self, range: Range<usize>, tension: WriteColumn<'_>, per_dt2: L) {
        let mut k = range.start;
        while k < range.end {
            let [rest, gain, wa, wb, soft] = self.numbers::<L, 5>(k);
            let so_far = L::load(tension, k);
            let slack = Slack { gives: so_far * soft * per_dt2, ..Slack::none() };
            let by = self.solve::<L, true>(k, LinkParameters { rest, gain, slack, weights: [wa, wb] });
            (so_far + by).store(tension, k);
            k += L::N;
        }
    }

    /// The links from the `k`th on; gives by how much their tension grew.
    #[inline(always)]
    fn solve<L: Lanes, const SOFT: bool>(&self, k: usize, parameters: LinkParameters<L>) -> L {
        let [a, b] = &self.links.ends;
        let (a, b) = (a.within(self.records), b.within(self.records));
        let ([ax, ay, az, aw], [bx, by, bz, bw]) = (L::load_records(a, k), L::load_records(b, k));
        let (pa, pb) = (V3 { x: ax, y: ay, z: az }, V3 { x: bx, y: by, z: bz });
        let ([by_a, by_b], grown) = push::<L, SOFT>(pb - pa, parameters, None);
        let (pa, pb) = (pa + by_a, pb - by_b);
        L::store_records([pa.x, pa.y, pa.z, aw], a, k);
        L::store_records([pb.x, pb.y, pb.z, bw], b, k);
        grown
    }
}
