//! Links: stretch between two particles, set by set, by Gauss-Seidel.
//!
//! Extended position-based dynamics (Macklin, Mueller, Chentanez 2016, eq. 18 and 26): for C = |b - a| - rest with
//! compliance alpha and damping time tau, one pass a substep moves the ends by -+ w n lambda with
//! lambda = (C + gamma n.(db - da)) / ((1 + gamma)(w_a + w_b) + alpha / dt^2), gamma = tau / dt, where da and db are the
//! ends' motion in this substep. No two links of a set share a particle, so their order changes no bit.

use toile_base::garment::layout::{ConstraintRun, ConstraintSet, Links, Zigzag};

use super::state::{self, ParticleColumns};
use crate::lanes::{Kernel, Lanes, MOST, Numbers, ReadColumn, Readable, Two, V3, WriteColumn, reciprocal_root};
use link_curves::CurveColumns;
use link_gain::{NO_LEAST, Passes, Slack, gain};

/// What the settings make of links.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct LinkGains {
    /// 1 / ((1 + gamma)(w_a + w_b) + alpha / dt^2), but see [`Passes::Once`]; 0 where nothing can move `[places]`.
    pub gain: Box<[f32]>,
    /// 1 / rest^2 (1/m2) `[places]`.
    pub per_rest2: Box<[f32]>,
}

/// Shortest rest length that the stretch is measured by (m): a tenth of a micrometre, whose square is still a number whose
/// reciprocal f32 has.
const SHORTEST: f32 = 1e-7;

impl LinkGains {
    /// Room for a garment's; the lengths are there already. At load.
    pub fn new(links: &Links) -> Self {
        let per_rest2 = links.rest.iter().map(|l| l.max(SHORTEST).powi(2).recip()).collect();
        Self { gain: vec![0.0; links.rest.len()].into(), per_rest2 }
    }

    /// Makes the gains, in the order of the parameters.
    pub fn prepare(&mut self, links: &Links, weights: &[f32], [dt, gamma]: [f32; 2], passes: Passes) {
        let per_dt2 = (dt * dt).recip();
        links.tuples.for_each(|place, [a, b]| {
            let w = weights[a as usize] + weights[b as usize];
            let (ends, own) = ((1.0 + gamma) * w, links.compliance[place] * per_dt2);
            self.gain[place] = gain(ends, own, passes);
        });
    }

    /// Memory that it holds (bytes).
    pub fn bytes(&self) -> usize {
        4 * (self.gain.len() + self.per_rest2.len())
    }
}

/// What lengths, gain and compliance of links are read from: as baked and prepared, or as their curves have them now.
#[derive(Clone, Copy)]
pub struct LinkColumns<'a> {
    /// Rest length (m) where there is compliance or damping, else 1 over its square (1/m2) `[places]`.
    pub rest: ReadColumn<'a>,
    /// Gain ([`LinkGains::gain`]) `[places]`.
    pub gain: ReadColumn<'a>,
    /// Inverse stiffness (m/N) `[places]`.
    pub compliance: ReadColumn<'a>,
    /// Least tension that each may come to (N s2) `[places]`; nothing where they push as they pull.
    pub least: Option<ReadColumn<'a>>,
    /// Whether `rest` is a length.
    pub lengths: bool,
}

impl<'a> LinkColumns<'a> {
    /// Of links with one slope, as baked; `soft` says that they have compliance or damping.
    pub fn baked(links: &'a Links, gains: &'a LinkGains, soft: bool) -> Self {
        Self {
            rest: ReadColumn::new(if soft { &links.rest } else { &gains.per_rest2 }),
            gain: ReadColumn::new(&gains.gain),
            compliance: ReadColumn::new(&links.compliance),
            least: None,
            lengths: soft,
        }
    }

    /// As their curves have them.
    pub fn curved(link_curve: CurveColumns<'a>) -> Self {
        let [rest, gain, compliance, least] =
            [link_curve.rest, link_curve.gain, link_curve.compliance, link_curve.least].map(WriteColumn::to_read);
        Self { rest, gain, compliance, least: Some(least), lengths: true }
    }
}

/// One owner's share of one set.
pub struct SolveLinks<'a> {
    /// The garment's particles.
    pub columns: ParticleColumns<'a>,
    /// All links of the garment.
    pub links: &'a Links,
    /// Their parameters.
    pub parameters: LinkColumns<'a>,
    /// The set that is solved now.
    pub set: &'a ConstraintSet,
    /// Owner whose share is solved.
    pub owner: usize,
    /// Damping time over the substep (1).
    pub gamma: f32,
    /// The tension of each link so far in this substep, and 1 / dt^2, where links with compliance are solved more than
    /// once a substep: without it, each pass would add a spring of its own.
    pub tension: Option<(WriteColumn<'a>, f32)>,
}

impl Kernel for SolveLinks<'_> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(mut self) {
        self.columns = self.columns.level();
        if self.parameters.lengths { self.all::<L, true>() } else { self.all::<L, false>() }
    }
}

impl SolveLinks<'_> {
    #[inline(always)]
    fn all<L: Lanes, const SOFT: bool>(&self) {
        let share = &self.set.shares[self.owner];
        let tuples = &self.links.tuples;
        for zigzag in &tuples.zigzags[share.zigzags.start as usize..share.zigzags.end as usize] {
            let (n, alike) = (zigzag.straights.len as usize, zigzag.straights.alike && zigzag.slants.alike);
            if n < L::N || SOFT && self.gamma > 0.0 {
                self.row::<L, SOFT>(&zigzag.straights, 0, zigzag.straights.len);
                self.slants::<L, SOFT>(zigzag, 0);
            } else if alike && L::N == 4 && n >= 4 * L::N {
                self.zigzag::<L, Two<Two<L>>, true, SOFT>(zigzag);
            } else if alike && n >= 2 * L::N {
                self.zigzag::<L, Two<L>, true, SOFT>(zigzag);
            } else if alike {
                self.zigzag::<L, L, true, SOFT>(zigzag);
            } else {
                self.zigzag::<L, L, false, SOFT>(zigzag);
            }
        }
        for run in &tuples.runs[share.runs.start as usize..share.runs.end as usize] {
            self.row::<L, SOFT>(run, 0, run.len);
        }
        let LinkColumns { rest, gain, compliance: soft, .. } = self.parameters;
        let loose = &self.links.tuples.loose;
        let mut k = 0;
        while k < share.loose.len() {
            let n = (share.loose.len() - k).min(L::N);
            let first = share.loose.start as usize + k;
            let (at, number) = (share.loose_at as usize + k, share.loose_serial as usize + k);
            let slack = match self.tension.filter(|_| SOFT) {
                Some((t, per_dt2)) => {
                    let tension = part::<L>(t, number, n);
                    Slack {
                        gives: tension * part(soft, at, n) * L::splat(per_dt2),
                        least: self.least::<L>(at, n) - tension,
                    }
                }
                None => Slack::none(),
            };
            let pull = self.listed::<L, SOFT>(&loose[first..first + n], [rest, gain], at, slack);
            self.count::<L, SOFT>(pull, number, n);
            k += n;
        }
    }

    /// The links `from..to` of a run.
    #[inline(always)]
    fn row<L: Lanes, const SOFT: bool>(&self, run: &ConstraintRun<2>, from: u32, to: u32) {
        let [a, b] = run.first.map(|f| f as usize);
        let mut t = from as usize;
        while t < to as usize {
            let n = (to as usize - t).min(L::N);
            let slack = self.slack::<L, SOFT>(run, t, n);
            let by = self.side_by_side::<L, SOFT>([a + t, b + t], self.parameters::<L, SOFT>(run, t, n), slack, n);
            self.count::<L, SOFT>(by, run.serial as usize + t, n);
            t += n;
        }
    }

    /// The slants of a zigzag from `from` on.
    #[inline(always)]
    fn slants<L: Lanes, const SOFT: bool>(&self, zigzag: &Zigzag, from: u32) {
        let Zigzag { straights, slants } = zigzag;
        self.row::<L, SOFT>(slants, from, straights.len - 1);
        if zigzag.closed() {
            // The one that leads back, alone.
            let t = straights.len - 1;
            let (place, [b, a]) = (slants.place(t), zigzag.slant(t).map(|p| p as usize));
            let w = self.columns.w;
            // What is alike counts with the masses of the first, here as within a vector: alike is not the same to the bit.
            let LinkColumns { rest, gain, .. } = self.parameters;
            let own = [rest.get(place), gain.get(place), w.get(b), w.get(a)];
            let p = if slants.alike { self.alike::<f32, SOFT>(slants) } else { own };
            let slack = self.slack::<f32, SOFT>(slants, t as usize, 1);
            let by = self.side_by_side::<f32, SOFT>([b, a], p, slack, 1);
            self.count::<f32, SOFT>(by, slants.serial as usize + t as usize, 1);
        }
    }

    /// Rest length, gain and the weights of both ends of `n` links of a run.
    #[inline(always)]
    fn parameters<L: Numbers, const SOFT: bool>(&self, run: &ConstraintRun<2>, t: usize, n: usize) -> [L; 4] {
        let LinkColumns { rest, gain, .. } = self.parameters;
        let ([a, b], at, w) = (run.first.map(|f| f as usize), run.at as usize, self.columns.w);
        if run.alike {
            return self.alike::<L, SOFT>(run);
        }
        [part(rest, at + t, n), part(gain, at + t, n), part(w, a + t, n), part(w, b + t, n)]
    }

    /// The same of the first link of a run.
    #[inline(always)]
    fn alike<L: Numbers, const SOFT: bool>(&self, run: &ConstraintRun<2>) -> [L; 4] {
        let ([a, b], at, w) = (run.first.map(|f| f as usize), run.at as usize, self.columns.w);
        let [rest, gain] = [self.parameters.rest.get(at), self.parameters.gain.get(at)];
        [L::splat(rest), L::splat(gain), L::splat(w.get(a)), L::splat(w.get(b))]
    }

    /// A zigzag of at least a vector of straights: each particle is read and written once. What is left of the rails at the
    /// end, less than a vector, and what leads back to the beginning where that does not fall on a vector's end, go by
    /// way of memory.
    #[inline(always)]
    fn zigzag<L: Lanes, W: Numbers, const ALIKE: bool, const SOFT: bool>(&self, zigzag: &Zigzag) {
        let Zigzag { straights, slants } = zigzag;
        let (x, n) = (self.columns.x, straights.len as usize);
        let [a, b] = straights.first.map(|f| f as usize);
        let like = [self.alike::<W, SOFT>(straights), self.alike::<W, SOFT>(slants)];
        let mut one = self.straight::<W, ALIKE, SOFT>(straights, 0, like[0]);
        // What the slants before have made of the first lane, the only one that they reach: kept apart, so that the
        // next slants need not wait for them.
        let mut behind = one.a;
        let mut t = W::N;
        while t + W::N <= n {
            let next = self.straight::<W, ALIKE, SOFT>(straights, t, like[0]);
            let turned = self.slant::<W, ALIKE, SOFT>(slants, t - W::N, &mut one, &next, like[1]);
            one.a = turned.with_first(behind);
            one.store(x, [a + t - W::N, b + t - W::N]);
            (one, behind) = (next, turned);
            t += W::N;
        }
        let last = t - W::N;
        if t < n || !zigzag.closed() {
            one.a = one.a.with_first(behind);
            one.store(x, [a + last, b + last]);
            self.row::<L, SOFT>(straights, t as u32, straights.len);
            return self.slants::<L, SOFT>(zigzag, last as u32);
        }
        let mut first = one;
        if last > 0 {
            first.a = V3::splat(state::get(x, a));
            first.weights[0] = W::splat(self.columns.w.get(a));
        }
        let turned = self.slant::<W, ALIKE, SOFT>(slants, last, &mut one, &first, like[1]);
        one.a = turned;
        if last > 0 {
            turned.store(x, a, 1);
            one.a = turned.with_first(behind);
        }
        one.store(x, [a + last, b + last]);
    }

    /// A vector of straights from the `t`-th on, solved; `like` are their parameters where all of the zigzag is alike.
    #[inline(always)]
    fn straight<L: Numbers, const ALIKE: bool, const SOFT: bool>(
        &self,
        straights: &ConstraintRun<2>,
        t: usize,
        like: [L; 4],
    ) -> Straights<L> {
        let ([a, b], x) = (straights.first.map(|f| f as usize + t), self.columns.x);
        let [rest, gain, wa, wb] = if ALIKE { like } else { self.parameters::<L, SOFT>(straights, t, L::N) };
        let slack = self.slack::<L, SOFT>(straights, t, L::N);
        let (pa, pb) = (V3::<L>::load(x, a, L::N), V3::load(x, b, L::N));
        let parameters = LinkParameters { rest, gain, slack, weights: [wa, wb] };
        let ([by_a, by_b], by) = push::<L, SOFT>(pb - pa, parameters, None);
        self.count::<L, SOFT>(by, straights.serial as usize + t, L::N);
        // Straights that are alike count with the masses of the first; slants that are not count with their own.
        let weights = if ALIKE { [wa, wb] } else { [L::load(self.columns.w, a), L::load(self.columns.w, b)] };
        Straights { a: pa + by_a, b: pb - by_b, weights }
    }

    /// The slants from the `t`-th on, between a vector of straights and the next, solved; gives the first rail a lane on, in
    /// its lowest lane the next vector's.
    #[inline(always)]
    fn slant<L: Numbers, const ALIKE: bool, const SOFT: bool>(
        &self,
        slants: &ConstraintRun<2>,
        t: usize,
        one: &mut Straights<L>,
        next: &Straights<L>,
        like: [L; 4],
    ) -> V3<L> {
        let [rest, gain, wb, wa] = self.slant_parameters::<L, ALIKE, SOFT>(slants, t, [one, next], like);
        let slack = self.slack::<L, SOFT>(slants, t, L::N);
        let parameters = LinkParameters { rest, gain, slack, weights: [wb, wa] };
        let a = one.a.with_first(next.a).rotate_down();
        let ([by_b, by_a], by) = push::<L, SOFT>(a - one.b, parameters, None);
        self.count::<L, SOFT>(by, slants.serial as usize + t, L::N);
        one.b = one.b + by_b;
        (a - by_a).rotate_up()
    }

    /// The slants' parameters: those of the first where all are alike, else the ends' weights are at hand.
    #[inline(always)]
    fn slant_parameters<L: Numbers, const ALIKE: bool, const SOFT: bool>(
        &self,
        slants: &ConstraintRun<2>,
        t: usize,
        [one, next]: [&Straights<L>; 2],
        like: [L; 4],
    ) -> [L; 4] {
        if ALIKE || slants.alike {
            return like;
        }
        let [a, b] = one.weights;
        let (LinkColumns { rest, gain, .. }, at) = (self.parameters, slants.at as usize + t);
        [L::load(rest, at), L::load(gain, at), b, a.with_first(next.weights[0]).rotate_down()]
    }

    /// What `n` links of a run give by their compliance under the tension that they have (m).
    #[inline(always)]
    fn slack<L: Numbers, const SOFT: bool>(&self, run: &ConstraintRun<2>, t: usize, n: usize) -> Slack<L> {
        let Some((tension, per_dt2)) = self.tension.filter(|_| SOFT) else { return Slack::none() };
        let (soft, at) = (self.parameters.compliance, run.place(t as u32));
        let soft = if run.alike { L::splat(soft.get(at)) } else { part(soft, at, n) };
        let tension = part::<L>(tension, run.serial as usize + t, n);
        Slack { gives: tension * soft * L::splat(per_dt2), least: self.least::<L>(at, n) - tension }
    }

    /// Least tension of `n` links from a place on; links that have one are not alike.
    #[inline(always)]
    fn least<L: Numbers>(&self, at: usize, n: usize) -> L {
        match self.parameters.least {
            Some(least) => part(least, at, n),
            None => L::splat(NO_LEAST),
        }
    }

    /// Adds to the tension of links.
    #[inline(always)]
    fn count<L: Numbers, const SOFT: bool>(&self, by: L, number: usize, n: usize) {
        let Some((tension, _)) = self.tension.filter(|_| SOFT) else { return };
        let sum = part::<L>(tension, number, n) + by;
        if n == L::N { sum.store(tension, number) } else { sum.store_part(tension, number, n) }
    }

    /// Links by index list; gives by how much their tension grew.
    #[inline(always)]
    fn listed<L: Lanes, const SOFT: bool>(
        &self,
        links: &[[u32; 2]],
        [rest, gain]: [ReadColumn<'_>; 2],
        at: usize,
        slack: Slack<L>,
    ) -> L {
        let c = &self.columns;
        let n = links.len();
        let mut ends = [[0u32; MOST]; 2];
        for (t, link) in links.iter().enumerate() {
            (ends[0][t], ends[1][t]) = (link[0], link[1]);
        }
        let [a, b] = &ends;
        let (pa, pb) = (V3::<L>::gather(c.x, a, n), V3::gather(c.x, b, n));
        let weights = [L::gather(c.w, a, n), L::gather(c.w, b, n)];
        let parameters = LinkParameters { rest: part(rest, at, n), gain: part(gain, at, n), slack, weights };
        let damped = if SOFT && self.gamma > 0.0 {
            Some(((pb - V3::gather(c.previous, b, n)) - (pa - V3::gather(c.previous, a, n)), self.gamma))
        } else {
            None
        };
        let ([by_a, by_b], by) = push::<L, SOFT>(pb - pa, parameters, damped);
        (pa + by_a).scatter(c.x, a, n);
        (pb - by_b).scatter(c.x, b, n);
        by
    }

    /// `n` links whose ends lie side by side; gives by how much their tension grew.
    #[inline(always)]
    fn side_by_side<L: Lanes, const SOFT: bool>(
        &self,
        [a, b]: [usize; 2],
        parameters: [L; 4],
        slack: Slack<L>,
        n: usize,
    ) -> L {
        let [rest, gain, wa, wb] = parameters;
        let c = &self.columns;
        let (pa, pb) = (V3::<L>::load(c.x, a, n), V3::load(c.x, b, n));
        let damped = if SOFT && self.gamma > 0.0 {
            Some(((pb - V3::load(c.previous, b, n)) - (pa - V3::load(c.previous, a, n)), self.gamma))
        } else {
            None
        };
        let parameters = LinkParameters { rest, gain, slack, weights: [wa, wb] };
        let ([by_a, by_b], by) = push::<L, SOFT>(pb - pa, parameters, damped);
        (pa + by_a).store(c.x, a, n);
        (pb - by_b).store(c.x, b, n);
        by
    }
}

/// What is known of links side by side.
#[derive(Clone, Copy)]
pub struct LinkParameters<L> {
    /// Rest length (m) where there is compliance or damping, else 1 over its square (1/m2).
    pub rest: L,
    /// Gain ([`LinkGains::gain`]).
    pub gain: L,
    /// What they give under the tension that they have, and by how much it may fall.
    pub slack: Slack<L>,
    /// Inverse masses of both ends (1/kg).
    pub weights: [L; 2],
}

/// How far links of vector `d` draw their ends, and by how much their tension grows; `moved` is by how much the ends moved
/// apart in the substep, and the damping time over it, where stretch is damped.
#[inline(always)]
pub fn push<L: Numbers, const SOFT: bool>(
    d: V3<L>,
    LinkParameters { rest, gain, slack, weights }: LinkParameters<L>,
    moved: Option<(V3<L>, f32)>,
) -> ([V3<L>; 2], L) {
    if !SOFT {
        return (stiff(d, rest, gain, weights), L::splat(0.0));
    }
    let length2 = d.dot(d);
    let inverse = reciprocal_root(length2);
    let mut stretch = length2 * inverse - rest - slack.gives;
    if let Some((moved, gamma)) = moved {
        stretch = stretch + d.dot(moved) * inverse * L::splat(gamma);
    }
    let by = (stretch * gain).max(slack.least);
    let pull = by * inverse;
    ([d * (pull * weights[0]), d * (pull * weights[1])], by)
}

/// Most e = |d|^2 / rest^2 - 1 that a pass is given: up to it the series below grows; a link longer than that is drawn in over
/// several passes.
const MOST_EXCESS: f32 = 2.0 / 3.0;

/// How far a link without compliance draws its ends, of the weights given: along d by w lambda / |d|, which is
/// 1 - rest / |d| times the gain and the weight. With e = |d|^2 / rest^2 - 1 that is 1 - (1 + e)^(-1/2), by its series
/// e (1/2 - 3/8 e), short of it by a fortieth where a link is a tenth too long: no root, and the next pass finds what is
/// left. Over eight sizes of the benchmark's skirt it leaves no more strain than the root (.137 % for .142), and no more than
/// the next term of the series would.
/// Gain and weight are multiplied first: one wait less.
#[inline(always)]
fn stiff<L: Numbers>(d: V3<L>, per_rest2: L, gain: L, weights: [L; 2]) -> [V3<L>; 2] {
    // Where d is not a number, the other operand counts: the push is none either way.
    let e = (d.dot(d) * per_rest2 - L::splat(1.0)).min(L::splat(MOST_EXCESS));
    let excess = e * (L::splat(0.5) - e * L::splat(0.375));
    [d * (excess * (gain * weights[0])), d * (excess * (gain * weights[1]))]
}

/// Both ends of a vector of straights, and their weights.
#[derive(Clone, Copy)]
struct Straights<L> {
    a: V3<L>,
    b: V3<L>,
    weights: [L; 2],
}

impl<L: Numbers> Straights<L> {
    #[inline(always)]
    fn store(self, to: [WriteColumn<'_>; 3], [a, b]: [usize; 2]) {
        self.a.store(to, a, L::N);
        self.b.store(to, b, L::N);
    }
}

/// `n <= N` numbers side by side.
#[inline(always)]
fn part<L: Numbers>(from: impl Readable, at: usize, n: usize) -> L {
    if n == L::N { L::load(from, at) } else { L::load_part(from, at, n) }
}

pub mod diagonals;
pub mod fibers;
pub mod link_curves;
pub mod link_gain;
pub mod lists;
pub mod record_links;
pub mod records;
#[cfg(test)]
mod tests;
pub mod tethers;
