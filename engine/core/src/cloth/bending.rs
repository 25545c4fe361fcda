//! Bending: a force, linear in the positions, so that nothing can go wrong where cloth is folded flat.
//!
//! Each stencil stores (1/2) |d|^2 with d = sum c_i x_i, the curvature along its fiber times the root of its stiffness
//! (assets, `bake::links`); it pulls with -c_i d. Evaluated at the positions of the substep's start, so statics do not
//! depend on the time step; stable while dt^2 w_i sum_s |c_si| sum_j |c_sj| stays below 4 for every particle
//! (Gershgorin). What is stiffer than a mesh and a substep can carry so takes several [`super::stiff_bending`]; [`weaken`] weakens
//! what is stiffer still, and says by how much. [`super::hubs`] does the same over whole rings.

use toile_assets::garment::layout::{Bends, ConstraintRun, ConstraintSet};

use crate::lanes::{Kernel, Lanes, MOST, ReadColumn, Readable, V3, WriteColumn};

/// The bound on dt^2 omega^2 up to which bending is a plain force, a fifth of what is stable: what is stiffer rings, and
/// the stretch solves of cloth that is pressed in its plane feed the ringing.
pub const STABLE: f32 = 0.8;

/// How bending goes on for one time step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BendingPace {
    /// It acts every so many substeps, with the impulse of all of them (Tuckerman, Berne, Martyna 1992: slow forces need
    /// not be asked as often as fast ones).
    pub every: u32,
    /// Stages of each time ([`super::stiff_bending`]); 1 where it is a plain force.
    pub stages: u32,
    /// Least share of its stiffness that the time step can carry.
    pub least: f32,
}

/// Adds to each particle the bound on dt^2 omega^2 that some stencils put on it.
pub fn add_load<const K: usize>(bends: &Bends<K>, weights: &[f32], dt: f32, load: &mut [f32]) {
    let coefficient = |at: usize, k: usize| bends.coefficients[k][at].abs();
    bends.tuples.for_each(|at, v| {
        let sum: f32 = (0..K).map(|k| coefficient(at, k)).sum();
        for (k, &i) in v.iter().enumerate() {
            load[i as usize] += dt * dt * weights[i as usize] * coefficient(at, k) * sum;
        }
    });
}

/// Writes for each stencil the share of its stiffness that can be carried where `limit` is the bound, 1 where all of it;
/// the least is given back.
pub fn weaken<const K: usize>(bends: &Bends<K>, load: &[f32], limit: f32, scale: &mut [f32]) -> f32 {
    let mut least = 1.0f32;
    scale.fill(1.0);
    bends.tuples.for_each(|at, v| {
        let most = v.iter().map(|&i| load[i as usize]).fold(0.0, f32::max);
        if most > limit {
            scale[at] = scale[at].min(limit / most);
            least = least.min(scale[at]);
        }
    });
    least
}

/// How often bending has to act.
pub fn every(load: &[f32], substeps: u32) -> u32 {
    let most = load.iter().copied().fold(0.0, f32::max);
    let fits = |every: &u32| substeps.is_multiple_of(*every) && most * (every * every) as f32 <= STABLE;
    (1..=substeps).rev().find(fits).unwrap_or(1)
}

/// Stencils that are taken together: their curvatures stay in the nearest cache.
pub const CHUNK: usize = 512;

/// Numbers between the coordinates of the curvatures: not a power of two, so that none of them hides another.
const STRIDE: usize = CHUNK + MOST;

/// Numbers of scratch that bending needs.
pub const SCRATCH: usize = 3 * STRIDE;

/// Adds the bending forces of one owner's share of a set to the velocities, or whatever is bent to whatever is pushed.
///
/// Stencils side by side overlap, and what one has just written another reads from the middle of it, which stalls a
/// processor. So 512 stencils at a time are swept `K + 1` times: first for their curvatures, then for what these
/// do to all the middles, to all the first ends and to all the second ones. The order of sums is the same at every width.
pub struct BendStencils<'a, const K: usize> {
    /// Inverse masses (1/kg).
    pub w: WriteColumn<'a>,
    /// All bending stencils of the garment.
    pub bends: &'a Bends<K>,
    /// The set that is solved now.
    pub set: &'a ConstraintSet,
    /// Owner whose share is solved: index into the set's shares.
    pub owner: usize,
    /// What is bent: the positions (m).
    pub from: [WriteColumn<'a>; 3],
    /// What is pushed: the velocities (m/s).
    pub to: [WriteColumn<'a>; 3],
    /// How much: the length of the substep (s).
    pub by: f32,
    /// What [`weaken`] made, where anything had to be weakened.
    pub scale: Option<&'a [f32]>,
    /// This worker's scratch, at least [`SCRATCH`] numbers.
    pub scratch: WriteColumn<'a>,
}

/// A place among the runs of a share.
#[derive(Clone, Copy)]
struct StencilCursor {
    run: usize,
    /// Stencil of the run.
    t: usize,
}

impl<const K: usize> Kernel for BendStencils<'_, K> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(mut self) {
        let len = self.w.len();
        for axis in 0..3 {
            (self.from[axis], self.to[axis]) = (self.from[axis].cut(len), self.to[axis].cut(len));
        }
        let share = &self.set.shares[self.owner];
        let runs = &self.bends.tuples.runs[share.runs.start as usize..share.runs.end as usize];
        let mut place = StencilCursor { run: 0, t: 0 };
        while place.run < runs.len() {
            let next = self.curvatures::<L>(runs, place);
            for k in 0..K {
                self.push::<L>(runs, place, k);
            }
            place = next;
        }
        for (k, i) in share.loose.clone().enumerate() {
            self.loose(self.bends.tuples.loose[i as usize], share.loose_at as usize + k);
        }
    }
}

impl<const K: usize> BendStencils<'_, K> {
    /// The curvatures of a chunk, times the substep, into the scratch; gives the place behind it.
    #[inline(always)]
    fn curvatures<L: Lanes>(&self, runs: &[ConstraintRun<K>], mut place: StencilCursor) -> StencilCursor {
        let (x, mut filled) = (self.from, 0);
        while filled < CHUNK && place.run < runs.len() {
            let run = &runs[place.run];
            let n = (run.len as usize - place.t).min(CHUNK - filled);
            let mut done = 0;
            while done < n {
                let (t, part) = (place.t + done, (n - done).min(L::N));
                let at = run.place(t as u32);
                let mut d = V3::<L>::load(x, run.first[0] as usize + t, part) * self.coefficient::<L>(0, run, at, part);
                for k in 1..K {
                    let c = self.coefficient::<L>(k, run, at, part);
                    d = d + V3::load(x, run.first[k] as usize + t, part) * c;
                }
                let mut scale = L::splat(self.by);
                if let Some(s) = self.scale {
                    scale = scale * one_or_each::<L>(ReadColumn::new(s), run.alike, at, part);
                }
                (d * scale).store(self.kept(), filled + done, part);
                done += part;
            }
            filled += n;
            place = place.after(n, run);
        }
        place
    }

    /// What the curvatures of a chunk do to the particles at end `k` of its stencils.
    #[inline(always)]
    fn push<L: Lanes>(&self, runs: &[ConstraintRun<K>], mut place: StencilCursor, k: usize) {
        let (to, mut filled) = (self.to, 0);
        while filled < CHUNK && place.run < runs.len() {
            let run = &runs[place.run];
            let n = (run.len as usize - place.t).min(CHUNK - filled);
            let mut done = 0;
            while done < n {
                let (t, part) = (place.t + done, (n - done).min(L::N));
                let v = run.first[k] as usize + t;
                let w_at = if run.alike { run.first[k] as usize } else { v };
                let w = one_or_each::<L>(self.w, run.alike, w_at, part);
                let by = self.coefficient::<L>(k, run, run.place(t as u32), part) * w;
                let d = V3::<L>::load(self.kept(), filled + done, part);
                (V3::<L>::load(to, v, part) - d * by).store(to, v, part);
                done += part;
            }
            filled += n;
            place = place.after(n, run);
        }
    }

    /// A stencil that is in no run.
    #[inline(always)]
    fn loose(&self, v: [u32; K], at: usize) {
        let (x, to, v) = (self.from, self.to, v.map(|v| v as usize));
        let coefficient = |k: usize| self.bends.coefficients[k][at];
        let mut d = V3::<f32>::load(x, v[0], 1) * coefficient(0);
        for (k, &v) in v.iter().enumerate().skip(1) {
            d = d + V3::load(x, v, 1) * coefficient(k);
        }
        let d = d * self.scale.map_or(self.by, |s| self.by * s[at]);
        for (k, &v) in v.iter().enumerate() {
            (V3::<f32>::load(to, v, 1) - d * (coefficient(k) * self.w.get(v))).store(to, v, 1);
        }
    }

    /// Where the curvatures are kept, one coordinate after the other.
    #[inline(always)]
    fn kept(&self) -> [WriteColumn<'_>; 3] {
        [0, 1, 2].map(|axis| self.scratch.part(axis * STRIDE, STRIDE))
    }

    #[inline(always)]
    fn coefficient<L: Lanes>(&self, k: usize, run: &ConstraintRun<K>, at: usize, n: usize) -> L {
        one_or_each(ReadColumn::new(&self.bends.coefficients[k]), run.alike, at, n)
    }
}

impl StencilCursor {
    /// `n` stencils of the run later.
    #[inline(always)]
    fn after<const K: usize>(self, n: usize, run: &ConstraintRun<K>) -> Self {
        let t = self.t + n;
        if t == run.len as usize { Self { run: self.run + 1, t: 0 } } else { Self { t, ..self } }
    }
}

/// One number for all, or `n` numbers side by side.
#[inline(always)]
fn one_or_each<L: Lanes>(from: impl Readable, one: bool, at: usize, n: usize) -> L {
    if one {
        L::splat(from.reader().get(at))
    } else if n == L::N {
        L::load(from, at)
    } else {
        L::load_part(from, at, n)
    }
}
