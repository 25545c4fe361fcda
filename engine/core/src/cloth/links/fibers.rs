//! Fibers side by side, each solved directly: the tridiagonal system of its tensions, a fiber a lane.
//!
//! For the links C_e = |x_(e+1) - x_e| - rest_e of one fiber, with unit vectors n_e, one linearised solve is
//! (J W J^T + alpha / dt^2) lambda = C. A link shares a particle with the next only, so the matrix is tridiagonal:
//! diagonal w_e + w_(e+1) + alpha_e / dt^2, beside it -w_e n_e.n_(e-1); it is factored as L D L^T on the way down and
//! solved on the way up (Goldenthal et al. 2007, "Efficient simulation of inextensible cloth", sets this system up;
//! Macklin et al. 2016 the compliance). Particles then move by w (lambda_e n_e - lambda_(e-1) n_(e-1)).
//!
//! Ill-conditioned chains: a collapsed link has no direction and drops out; both ends pinned and taut, or masses far
//! apart, leave a pivot near zero, which is held at `LEAST_PIVOT` of its diagonal; and no particle moves by more than
//! half its link in one solve, because beyond that the directions mean nothing.

use toile_base::garment::Solver;
use toile_base::garment::layout::{BundleRow, ENDED, FiberBundle, Fibers};

use crate::cloth::state::ParticleColumns;
use crate::lanes::{Kernel, Lanes, MOST, Numbers, ReadColumn, Two, V3, WriteColumn, reciprocal_root};

/// Least pivot as a share of its diagonal: the rounding of f32 over a chain of a hundred links, ten times over.
pub(in crate::cloth) const LEAST_PIVOT: f32 = 1e-5;

/// A pivot where there is no link at all.
pub(in crate::cloth) const NO_PIVOT: f32 = 1e-12;

/// Farthest that one solve may move a particle, as a share of its link.
pub(in crate::cloth) const FARTHEST: f32 = 0.5;

/// Passes of a fiber that must not lengthen; each squares what is left of the error.
const ZERO_STRETCH_PASSES: usize = 2;

/// Vectors kept a link between the way down and the way up: n (three), the factor, the right-hand side.
const KEPT: usize = 5;

/// Numbers of scratch that the longest bundle needs.
pub fn scratch_len(fibers: &Fibers) -> usize {
    fibers.bundles.iter().map(|b| b.rows.len()).max().unwrap_or(0) * KEPT * 2 * MOST
}

/// All bundles of one owner.
pub struct SolveFibers<'a> {
    /// The garment's particles.
    pub columns: ParticleColumns<'a>,
    /// All warp fibers of the garment.
    pub fibers: &'a Fibers,
    /// Rest length (m) and compliance (m/N) of their links, as baked or as their curves have them now.
    pub links: [ReadColumn<'a>; 2],
    /// Least tension that each link may come to (N s2); nothing where they push as they pull.
    pub least: Option<ReadColumn<'a>>,
    /// Owner whose bundles are solved.
    pub owner: usize,
    /// This worker's scratch.
    pub scratch: WriteColumn<'a>,
    /// 1 / dt^2 (1/s2).
    pub per_dt2: f32,
    /// Damping time over the substep (1).
    pub gamma: f32,
    /// Whether [`pull_across`] is above what one solve can take.
    pub taut: bool,
    /// The tension of each link so far in this substep, where they have compliance.
    pub tension: Option<WriteColumn<'a>>,
}

impl Kernel for SolveFibers<'_> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(mut self) {
        self.columns = self.columns.level();
        for bundle in self.fibers.bundles.iter().filter(|b| usize::from(b.owner) == self.owner) {
            let mut lane = 0;
            while lane < bundle.lanes as usize {
                let chain = Chain { solve: &self, bundle, lane };
                match bundle.solver {
                    Solver::GaussSeidel => chain.sweep::<L>(),
                    Solver::SemiImplicit if self.gamma > 0.0 || self.tension.is_some() => {
                        chain.direct::<L, true, false, false>();
                    }
                    // Each link waits for the one before it: two vectors of fibers keep the processor busy meanwhile,
                    // where there are registers for both.
                    Solver::SemiImplicit if L::N == MOST && chain.full(2 * L::N) => {
                        chain.direct::<Two<L>, false, false, true>();
                        lane += L::N;
                    }
                    Solver::SemiImplicit if chain.full(L::N) => chain.direct::<L, false, false, true>(),
                    Solver::SemiImplicit => chain.direct::<L, false, false, false>(),
                    Solver::ZeroStretch => {
                        for _ in 0..ZERO_STRETCH_PASSES {
                            chain.direct::<L, false, true, false>();
                        }
                        chain.shorten::<L>();
                    }
                }
                lane += L::N;
            }
        }
    }
}

/// The fibers of a bundle from `lane` on, as many as there are lanes.
struct Chain<'a> {
    solve: &'a SolveFibers<'a>,
    bundle: &'a FiberBundle,
    lane: usize,
}

impl Chain<'_> {
    #[inline(always)]
    fn rows(&self) -> &[BundleRow] {
        &self.solve.fibers.rows[self.bundle.rows.start as usize..self.bundle.rows.end as usize]
    }

    /// Whether every lane has a fiber to the last row: then nothing has to be masked.
    #[inline(always)]
    fn full(&self, lanes: usize) -> bool {
        self.rows().last().is_some_and(|row| self.lane + lanes <= row.lanes as usize)
    }

    /// First particle of a row for these lanes, and how many of them reach so far; the row's end where none does, since what
    /// lies beyond may not be there.
    #[inline(always)]
    fn place<L: Numbers, const FULL: bool>(&self, row: BundleRow) -> (usize, usize) {
        if FULL {
            return (row.first as usize + self.lane, L::N);
        }
        let lane = self.lane.min(row.lanes as usize);
        (row.first as usize + lane, (row.lanes as usize - lane).min(L::N))
    }

    /// Weights of a row's particles.
    #[inline(always)]
    fn weights<L: Numbers>(&self, row: BundleRow, at: usize, n: usize) -> L {
        let w = self.solve.columns.w;
        if self.bundle.alike {
            L::splat(w.get(row.first as usize))
        } else if n == L::N {
            L::load(w, at)
        } else {
            L::load_part(w, at, n)
        }
    }

    /// Number of a link of the first of these lanes, and how many lanes there are.
    #[inline(always)]
    fn number<L: Numbers>(&self, link: usize) -> (usize, usize) {
        let lanes = self.bundle.lanes as usize;
        (self.bundle.serial as usize + link * lanes + self.lane, (lanes - self.lane).min(L::N))
    }

    /// Tension of a link so far.
    #[inline(always)]
    fn tension<L: Numbers>(&self, link: usize) -> L {
        let Some(tension) = self.solve.tension else { return L::splat(0.0) };
        let (at, n) = self.number::<L>(link);
        if n == L::N { L::load(tension, at) } else { L::load_part(tension, at, n) }
    }

    /// A parameter of a link of fibers that are not alike.
    #[inline(always)]
    fn parameter<L: Numbers, const FULL: bool>(&self, from: ReadColumn<'_>, link: usize) -> L {
        let lanes = self.bundle.lanes as usize;
        let at = self.bundle.at as usize + link * lanes + self.lane;
        let n = if FULL { L::N } else { (lanes - self.lane).min(L::N) };
        if n == L::N { L::load(from, at) } else { L::load_part(from, at, n) }
    }

    /// Rest length and compliance of a link.
    #[inline(always)]
    fn link<L: Numbers, const FULL: bool>(&self, link: usize) -> (L, L) {
        let [rest, soft] = self.solve.links;
        let first = self.bundle.at as usize;
        if self.bundle.alike {
            return (L::splat(rest.get(first + link)), L::splat(soft.get(first + link)));
        }
        (self.parameter::<L, FULL>(rest, link), self.parameter::<L, FULL>(soft, link))
    }

    #[inline(always)]
    fn direct<L: Numbers, const SOFT: bool, const ZERO: bool, const FULL: bool>(&self) {
        let c = &self.solve.columns;
        let rows = self.rows();
        let scratch = self.solve.scratch;
        let per_dt2 = L::splat(self.solve.per_dt2);
        let gamma = L::splat(self.solve.gamma);
        let zero = L::splat(0.0);
        let (at, n) = self.place::<L, FULL>(rows[0]);
        let mut p = V3::<L>::load(c.x, at, n);
        let mut moved = if SOFT { p - V3::load(c.previous, at, n) } else { p };
        let mut w = self.weights::<L>(rows[0], at, n);
        let mut normal = V3 { x: zero, y: zero, z: zero };
        let (mut pivot, mut y) = (zero, zero);
        for link in 0..rows.len() - 1 {
            let (at, n) = self.place::<L, FULL>(rows[link + 1]);
            let q = V3::<L>::load(c.x, at, n);
            let w_q = self.weights::<L>(rows[link + 1], at, n);
            let (rest, soft) = self.link::<L, FULL>(link);
            let d = q - p;
            let length2 = d.dot(d);
            let inverse = reciprocal_root(length2);
            let next = d * inverse;
            let mut stretch = length2 * inverse - rest;
            let mut both = w + w_q;
            let mut beside = w * next.dot(normal);
            let stiff = if ZERO {
                stretch = stretch.max(zero);
                soft.select(L::splat(0.1 * ENDED).lt(soft), zero)
            } else {
                soft * per_dt2
            };
            if SOFT {
                // What the link gives by its compliance under the tension that it has, and its damping.
                let moves = q - V3::load(c.previous, at, n);
                stretch = stretch + gamma * next.dot(moves - moved) - self.tension::<L>(link) * stiff;
                moved = moves;
                both = both + gamma * both;
                beside = beside + gamma * beside;
            }
            // L D L^T: `beside` is minus the entry beside the diagonal.
            let diagonal = both + stiff;
            let factor = beside * pivot;
            let rest_pivot =
                (diagonal - factor * beside).max((diagonal * L::splat(LEAST_PIVOT)).max(L::splat(NO_PIVOT)));
            pivot = L::splat(1.0).div(rest_pivot);
            y = stretch + factor * y;
            let kept = link * KEPT * L::N;
            next.x.store(scratch, kept);
            next.y.store(scratch, kept + L::N);
            next.z.store(scratch, kept + 2 * L::N);
            factor.store(scratch, kept + 3 * L::N);
            (y * pivot).store(scratch, kept + 4 * L::N);
            (p, w, normal) = (q, w_q, next);
        }
        self.back::<L, FULL>(rows);
    }

    /// The way up: tensions, and the motion that they cause.
    #[inline(always)]
    fn back<L: Numbers, const FULL: bool>(&self, rows: &[BundleRow]) {
        let scratch = self.solve.scratch;
        let zero = L::splat(0.0);
        let mut below = V3 { x: zero, y: zero, z: zero };
        let (mut lambda, mut factor) = (zero, zero);
        let (mut reach, mut held) = (zero, zero);
        for link in (0..rows.len() - 1).rev() {
            let kept = link * KEPT * L::N;
            let normal = V3 {
                x: L::load(scratch, kept),
                y: L::load(scratch, kept + L::N),
                z: L::load(scratch, kept + 2 * L::N),
            };
            lambda = L::load(scratch, kept + 4 * L::N) + factor * lambda;
            factor = L::load(scratch, kept + 3 * L::N);
            if let Some(least) = self.solve.least {
                lambda = lambda.max(self.parameter::<L, FULL>(least, link) - self.tension::<L>(link));
            }
            if let Some(tension) = self.solve.tension {
                let (at, n) = self.number::<L>(link);
                let sum = self.tension::<L>(link) + lambda;
                if n == L::N { sum.store(tension, at) } else { sum.store_part(tension, at, n) }
            }
            let pull = normal * lambda;
            let (at, n) = self.place::<L, FULL>(rows[link + 1]);
            let rest = self.link::<L, FULL>(link).0;
            reach = rest * L::splat(FARTHEST);
            let w = self.weights::<L>(rows[link + 1], at, n);
            let mut by = (below - pull) * w;
            if self.solve.taut {
                let holds = lambda.max(-lambda).div(rest.max(L::splat(NO_PIVOT)));
                by = calmed(by, normal, w * (held + holds));
                held = holds;
            }
            self.shift(by, reach, at, n);
            below = pull;
        }
        let (at, n) = self.place::<L, FULL>(rows[0]);
        self.shift(below * self.weights::<L>(rows[0], at, n), reach, at, n);
    }

    /// Moves a row, no particle farther than `reach`.
    #[inline(always)]
    fn shift<L: Numbers>(&self, by: V3<L>, reach: L, at: usize, n: usize) {
        let x = self.solve.columns.x;
        let by = limited(by, reach);
        (V3::load(x, at, n) + by).store(x, at, n);
    }

    /// Gauss-Seidel down the fibers, each link once.
    #[inline(always)]
    fn sweep<L: Lanes>(&self) {
        let c = &self.solve.columns;
        let rows = self.rows();
        let (mut above, n) = self.place::<L, false>(rows[0]);
        let mut p = V3::<L>::load(c.x, above, n);
        let mut reached = n;
        let mut w = self.weights::<L>(rows[0], above, n);
        for link in 0..rows.len() - 1 {
            let (at, n) = self.place::<L, false>(rows[link + 1]);
            let mut q = V3::<L>::load(c.x, at, n);
            let w_q = self.weights::<L>(rows[link + 1], at, n);
            let (rest, soft) = self.link::<L, false>(link);
            let d = q - p;
            let inverse = reciprocal_root(d.dot(d));
            let weight = (w + w_q + soft * L::splat(self.solve.per_dt2)).max(L::splat(NO_PIVOT));
            let slack = self.tension::<L>(link) * soft * L::splat(self.solve.per_dt2);
            let mut by = (d.dot(d) * inverse - rest - slack).div(weight);
            if let Some(least) = self.solve.least {
                by = by.max(self.parameter::<L, false>(least, link) - self.tension::<L>(link));
            }
            if let Some(tension) = self.solve.tension {
                let (at, n) = self.number::<L>(link);
                let sum = self.tension::<L>(link) + by;
                if n == L::N { sum.store(tension, at) } else { sum.store_part(tension, at, n) }
            }
            let pull = by * inverse;
            (p + d * (pull * w)).store(c.x, above, reached);
            q = q - d * (pull * w_q);
            (p, w, above, reached) = (q, w_q, at, n);
        }
        p.store(c.x, above, reached);
    }

    /// From the support on, every particle whose link is too long is drawn to its length: nothing stays lengthened.
    #[inline(always)]
    fn shorten<L: Lanes>(&self) {
        let c = &self.solve.columns;
        let rows = self.rows();
        let (at, n) = self.place::<L, false>(rows[0]);
        let mut p = V3::<L>::load(c.x, at, n);
        for (link, &row) in rows[1..].iter().enumerate() {
            let (at, n) = self.place::<L, false>(row);
            let q = V3::<L>::load(c.x, at, n);
            let (rest, _) = self.link::<L, false>(link);
            let d = q - p;
            let kept = (rest * reciprocal_root(d.dot(d))).min(L::splat(1.0));
            let free = L::splat(0.0).lt(self.weights::<L>(row, at, n));
            p = (p + d * kept).select(free, q);
            p.store(c.x, at, n);
        }
    }
}

/// How much two links pull a particle across them, for each metre that it is off their line and for the metre that a
/// substep then moves it (1): dt^2 w (T / l + T' / l'), the most of all particles under the weight of what hangs from each
/// fiber. A linearised solve overshoots where it is above 1, and by more the larger it is: light threads that carry a
/// heavy hem, or steps too long for the length of a fiber.
pub fn pull_across(fibers: &Fibers, weights: &[f32], dt: f32) -> f32 {
    let mut most = 0.0f32;
    for bundle in &fibers.bundles {
        let rows = &fibers.rows[bundle.rows.start as usize..bundle.rows.end as usize];
        for lane in 0..bundle.lanes {
            let (mut carried, mut below) = (0.0f32, 0.0f32);
            for (link, row) in rows[1..].iter().enumerate().rev().filter(|(_, row)| lane < row.lanes) {
                let w = weights[(row.first + lane) as usize];
                carried += if w > 0.0 { w.recip() } else { 0.0 };
                let apart = if bundle.alike { link } else { link * bundle.lanes as usize + lane as usize };
                let pull = carried * GRAVITY * dt * dt / fibers.rest[bundle.at as usize + apart].max(NO_PIVOT);
                most = most.max(w * (pull + below));
                below = pull;
            }
        }
    }
    most
}

/// Weight that fibers are judged by (m/s2).
const GRAVITY: f32 = 9.81;

/// Share of a motion across its links, away from their line, that one solve may give a particle: with neighbours that do
/// the same towards the other side it then just meets them.
const ACROSS: f32 = 0.5;

/// A motion of which the part across the link of direction `normal` is no more than [`ACROSS`] of the way back to the
/// line; `pull` is what [`pull_across`] says, for the tensions just found. Geometric stiffness, which a linearised solve
/// leaves out (Tournier et al. 2015, "Stable constrained dynamics"), would do the same.
#[inline(always)]
fn calmed<L: Numbers>(by: V3<L>, normal: V3<L>, pull: L) -> V3<L> {
    let along = normal * by.dot(normal);
    let share = L::splat(ACROSS).div(pull.max(L::splat(ACROSS)));
    along + (by - along) * share
}

/// A vector no longer than `reach`.
#[inline(always)]
pub(in crate::cloth) fn limited<L: Numbers>(by: V3<L>, reach: L) -> V3<L> {
    use crate::lanes::Mask;
    let size2 = by.dot(by);
    let over = (reach * reach).lt(size2);
    if over.any() { by * (reach * reciprocal_root(size2)).select(over, L::splat(1.0)) } else { by }
}
