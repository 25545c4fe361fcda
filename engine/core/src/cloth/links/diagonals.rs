//! Diagonals: fibers along the bias, a family solved directly by way of its runs.
//!
//! The system is that of [`fibers`](super::fibers): (J W J^T + alpha / dt^2) lambda = C, tridiagonal along each fiber. Here
//! neighbours side by side are on different fibers from row to row, so what a link leaves for the next one lies with the
//! particle between them. Shear needs it: links solved one by one from no tension keep 1 / (1 + w k dt^2) of their
//! stiffness, an eighth of a shirt's in four substeps; solved directly, an even shear keeps all of it, since tension that
//! is the same along a fiber moves none of its particles.
//!
//! On the way back a link's tension follows from where its end is by then: with n, pivot and y of the way down,
//! lambda = y / pivot + (n.(x_b - x_a) - |d|) / pivot, because only the link that leads on has moved b since.

use toile_base::garment::layout::{ConstraintRun, DiagonalShare, Diagonals};

use super::fibers::{FARTHEST, LEAST_PIVOT, NO_PIVOT};
use crate::cloth::state::ParticleColumns;
use crate::lanes::{Kernel, Lanes, Numbers, ReadColumn, Readable, Store, V3, WriteColumn, reciprocal_root};

/// Columns of what a link leaves with the particle that it leads to: n (three), 1 / pivot, tension without what follows,
/// the same less what its length makes of it.
pub const KEPT: usize = 6;

/// Room for a solve: what is kept with each particle.
#[derive(Debug, Clone)]
pub struct DiagonalScratch([Store; KEPT]);

impl DiagonalScratch {
    /// For so many particles; none where no fiber runs along the bias.
    pub fn new(diagonals: &Diagonals, particles: usize) -> Self {
        let len = if diagonals.families.is_empty() { 0 } else { particles };
        Self(std::array::from_fn(|_| Store::zeros(len)))
    }

    /// The scratch as columns that kernels write to.
    pub fn columns(&mut self) -> [WriteColumn<'_>; KEPT] {
        self.0.each_mut().map(Store::column)
    }

    /// Memory that it holds (bytes).
    pub fn bytes(&self) -> usize {
        self.0.iter().map(Store::bytes).sum()
    }
}

/// One owner's strand of a family.
pub struct SolveDiagonals<'a> {
    /// The garment's particles.
    pub columns: ParticleColumns<'a>,
    /// All families of fibers along the bias.
    pub diagonals: &'a Diagonals,
    /// Rest length (m) and compliance (m/N) of their links, as baked or as their curves have them now.
    pub links: [ReadColumn<'a>; 2],
    /// The owner's share of the family.
    pub strand: &'a DiagonalShare,
    /// Intermediate results of the solve; see [`DiagonalScratch`].
    pub scratch_columns: [WriteColumn<'a>; KEPT],
    /// 1 / dt^2 of the time that the solve stands for (1/s2).
    pub per_dt2: f32,
    /// Damping time over the substep (1).
    pub gamma: f32,
}

impl Kernel for SolveDiagonals<'_> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(mut self) {
        self.columns = self.columns.level();
        let len = self.columns.w.len();
        self.scratch_columns = self.scratch_columns.map(|c| c.cut(len));
        // What a family before has left must not pull at what begins here; not even a NaN direction.
        for &p in &self.diagonals.starts[self.strand.starts.start as usize..self.strand.starts.end as usize] {
            self.scratch_columns.iter().for_each(|c| c.set(p as usize, 0.0));
        }
        let runs = &self.diagonals.runs[self.strand.runs.start as usize..self.strand.runs.end as usize];
        for run in runs {
            if self.gamma > 0.0 {
                self.down::<L, true>(run);
            } else {
                self.down::<L, false>(run);
            }
        }
        for run in runs.iter().rev() {
            self.back::<L>(run);
        }
    }
}

impl SolveDiagonals<'_> {
    /// Rest length, compliance over the square of time, and the weights of both ends of `n` links of a run.
    #[inline(always)]
    fn parameters<L: Lanes>(&self, run: &ConstraintRun<2>, t: usize, n: usize) -> [L; 4] {
        let [rest, soft] = self.links;
        let ([a, b], at, w) = (run.first.map(|f| f as usize), run.at as usize, self.columns.w);
        let [rest, soft, wa, wb] = if run.alike {
            [L::splat(rest.get(at)), L::splat(soft.get(at)), L::splat(w.get(a)), L::splat(w.get(b))]
        } else {
            [some(rest, at + t, n), some(soft, at + t, n), some(w, a + t, n), some(w, b + t, n)]
        };
        [rest, soft * L::splat(self.per_dt2), wa, wb]
    }

    /// The way down: directions, pivots, and tensions as if nothing followed.
    #[inline(always)]
    fn down<L: Lanes, const DAMPED: bool>(&self, run: &ConstraintRun<2>) {
        let (c, [nx, ny, nz, pivots, tensions, lengths]) = (&self.columns, self.scratch_columns);
        let more = L::splat(1.0 + self.gamma);
        let mut t = 0;
        while t < run.len as usize {
            let n = (run.len as usize - t).min(L::N);
            let [a, b] = run.first.map(|f| f as usize + t);
            let [rest, stiff, wa, wb] = self.parameters::<L>(run, t, n);
            let d = V3::<L>::load(c.x, b, n) - V3::load(c.x, a, n);
            let length2 = d.dot(d);
            let inverse = reciprocal_root(length2);
            let (normal, length) = (d * inverse, length2 * inverse);
            let mut stretch = length - rest;
            if DAMPED {
                let moved = (V3::load(c.x, b, n) - V3::load(c.previous, b, n))
                    - (V3::load(c.x, a, n) - V3::load(c.previous, a, n));
                stretch = stretch + normal.dot(moved) * L::splat(self.gamma);
            }
            // L D L^T: `beside` is minus the entry beside the diagonal.
            let beside = wa * normal.dot(V3::load([nx, ny, nz], a, n)) * more;
            let diagonal = (wa + wb) * more + stiff;
            let rest_pivot = diagonal - beside * beside * some(pivots, a, n);
            let rest_pivot = rest_pivot.max((diagonal * L::splat(LEAST_PIVOT)).max(L::splat(NO_PIVOT)));
            let pivot = L::splat(1.0).div(rest_pivot);
            let tension = (stretch + beside * some(tensions, a, n)) * pivot;
            normal.store([nx, ny, nz], b, n);
            put(pivot, pivots, b, n);
            put(tension, tensions, b, n);
            put(tension - pivot * more * length, lengths, b, n);
            t += n;
        }
    }

    /// The way back: tensions, and the motion that they cause.
    #[inline(always)]
    fn back<L: Lanes>(&self, run: &ConstraintRun<2>) {
        let (c, [nx, ny, nz, pivots, _, lengths]) = (&self.columns, self.scratch_columns);
        let more = L::splat(1.0 + self.gamma);
        let mut t = 0;
        while t < run.len as usize {
            let n = (run.len as usize - t).min(L::N);
            let [a, b] = run.first.map(|f| f as usize + t);
            let [rest, _, wa, wb] = self.parameters::<L>(run, t, n);
            let (pa, pb) = (V3::<L>::load(c.x, a, n), V3::<L>::load(c.x, b, n));
            let normal = V3::<L>::load([nx, ny, nz], b, n);
            let tension = some::<L>(lengths, b, n) + some::<L>(pivots, b, n) * more * normal.dot(pb - pa);
            // No end moves farther than half the link, beyond which the directions mean nothing.
            let reach = rest * L::splat(FARTHEST);
            let by_a = (tension * wa).min(reach).max(-reach);
            let by_b = (tension * wb).min(reach).max(-reach);
            (pa + normal * by_a).store(c.x, a, n);
            (pb - normal * by_b).store(c.x, b, n);
            t += n;
        }
    }
}

/// `n <= N` numbers side by side.
#[inline(always)]
fn some<L: Numbers>(from: impl Readable, at: usize, n: usize) -> L {
    if n == L::N { L::load(from, at) } else { L::load_part(from, at, n) }
}

/// Writes `n <= N` numbers side by side.
#[inline(always)]
fn put<L: Numbers>(numbers: L, to: WriteColumn<'_>, at: usize, n: usize) {
    if n == L::N { numbers.store(to, at) } else { numbers.store_part(to, at, n) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cloth::state::State;
    use crate::lanes::Width;
    use glam::{DVec3, Vec3};

    const COLUMNS: u32 = 21;
    const ROWS: u32 = 9;

    /// Fibers that run down a grid and one column on from row to row, a link from every particle that has one.
    fn grid(alike: bool) -> Diagonals {
        let run = |r: u32| {
            let serial = r * (COLUMNS - 1);
            let at = if alike { 0 } else { serial };
            ConstraintRun { first: [r * COLUMNS, (r + 1) * COLUMNS + 1], len: COLUMNS - 1, at, serial, alike }
        };
        let runs: Box<[_]> = (0..ROWS - 1).map(run).collect();
        let places = if alike { 1 } else { (ROWS - 1) * (COLUMNS - 1) };
        let starts = (0..COLUMNS - 1).chain((1..ROWS - 1).map(|r| r * COLUMNS)).collect::<Box<[u32]>>();
        let strand = DiagonalShare { runs: 0..ROWS - 1, starts: 0..starts.len() as u32 };
        Diagonals {
            families: [[strand, DiagonalShare::default()]].into(),
            runs,
            starts,
            rest: (0..places).map(|i| 0.1 + 0.002 * (i % 5) as f32).collect(),
            compliance: (0..places).map(|i| 0.3 + 0.1 * (i % 3) as f32).collect(),
        }
    }

    fn place(i: u32) -> Vec3 {
        let (r, c) = ((i / COLUMNS) as f32, (i % COLUMNS) as f32);
        Vec3::new(0.08 * c + 0.01 * (i as f32 * 0.7).sin(), -0.07 * r, 0.03 * (i as f32 * 1.3).cos())
    }

    fn positions() -> Vec<Vec3> {
        (0..COLUMNS * ROWS).map(place).collect()
    }

    fn solved(width: Width, weights: &[f32], diagonals: &Diagonals, gamma: f32) -> Vec<Vec3> {
        let mut state = State::new(&positions(), weights);
        let mut scratch_columns = DiagonalScratch::new(diagonals, weights.len());
        // What another family has left, the worst that it can be.
        scratch_columns.0.iter_mut().for_each(|c| c.as_mut().fill(f32::NAN));
        let strand = &diagonals.families[0][0];
        let (columns, scratch_columns) = (state.columns(), scratch_columns.columns());
        let links = [&diagonals.rest, &diagonals.compliance].map(|c| ReadColumn::new(c));
        width.run(SolveDiagonals { columns, diagonals, links, strand, scratch_columns, per_dt2: 2.0, gamma });
        (0..weights.len()).map(|i| Vec3::from_array(state.positions().map(|a| a[i]))).collect()
    }

    /// The same system in f64, a fiber at a time, by elimination over the whole matrix.
    fn exact(weights: &[f32], diagonals: &Diagonals, gamma: f64) -> Vec<DVec3> {
        let mut x: Vec<DVec3> = positions().iter().map(|p| p.as_dvec3()).collect();
        let mut next = vec![None; x.len()];
        diagonals.for_each(|at, [a, b]| next[a as usize] = Some((at, b as usize)));
        for &start in &diagonals.starts {
            let (mut at, mut links) = (start as usize, Vec::new());
            while let Some((place, b)) = next[at] {
                links.push((place, at, b));
                at = b;
            }
            let w = |i: usize| f64::from(weights[i]);
            let normals: Vec<DVec3> = links.iter().map(|l| (x[l.2] - x[l.1]).normalize()).collect();
            let n = links.len();
            let mut m = vec![vec![0.0; n + 1]; n];
            for (k, &(place, a, b)) in links.iter().enumerate() {
                m[k][k] = (1.0 + gamma) * (w(a) + w(b)) + 2.0 * f64::from(diagonals.compliance[place]);
                m[k][n] = x[a].distance(x[b]) - f64::from(diagonals.rest[place]);
                if k + 1 < n {
                    let beside = -(1.0 + gamma) * w(b) * normals[k].dot(normals[k + 1]);
                    (m[k][k + 1], m[k + 1][k]) = (beside, beside);
                }
            }
            for k in 0..n {
                let row = m[k].clone();
                for below in m.iter_mut().skip(k + 1) {
                    let share = below[k] / row[k];
                    below.iter_mut().zip(&row).for_each(|(to, from)| *to -= share * from);
                }
            }
            let mut tension = vec![0.0; n];
            for k in (0..n).rev() {
                let known: f64 = (k + 1..n).map(|j| m[k][j] * tension[j]).sum();
                tension[k] = (m[k][n] - known) / m[k][k];
            }
            for ((&(_, a, b), normal), tension) in links.iter().zip(&normals).zip(&tension) {
                x[a] += *normal * *tension * w(a);
                x[b] -= *normal * *tension * w(b);
            }
        }
        x
    }

    #[test]
    fn every_width_gives_the_bits_of_one_lane_and_the_system_of_f64() {
        let weights: Vec<f32> =
            (0..COLUMNS * ROWS).map(|i| if i < COLUMNS { 0.0 } else { 1.0 + 0.1 * (i % 4) as f32 }).collect();
        for (alike, gamma) in [(false, 0.0), (true, 0.0), (false, 0.4)] {
            let even = vec![1.5; weights.len()];
            let weights = if alike { &even } else { &weights };
            let diagonals = grid(alike);
            let plain = solved(Width::One, weights, &diagonals, gamma);
            for width in Width::ALL.into_iter().filter(|w| w.available()) {
                assert_eq!(solved(width, weights, &diagonals, gamma), plain, "{width} lanes");
            }
            let errors = plain.iter().zip(exact(weights, &diagonals, f64::from(gamma)));
            let worst = errors.map(|(p, e)| p.as_dvec3().distance(e)).fold(0.0, f64::max);
            assert!(worst < 2e-6, "{worst} m from f64");
        }
    }

    #[test]
    fn a_link_without_length_has_no_direction_and_pulls_nothing() {
        let mut diagonals = grid(false);
        diagonals.rest.fill(0.0);
        let mut state = State::new(&[Vec3::ONE; (COLUMNS * ROWS) as usize], &[1.0; (COLUMNS * ROWS) as usize]);
        let mut scratch_columns = DiagonalScratch::new(&diagonals, (COLUMNS * ROWS) as usize);
        let strand = &diagonals.families[0][0];
        let (columns, scratch_columns) = (state.columns(), scratch_columns.columns());
        let diagonals = &diagonals;
        let links = [&diagonals.rest, &diagonals.compliance].map(|c| ReadColumn::new(c));
        Width::widest().run(SolveDiagonals {
            columns,
            diagonals,
            links,
            strand,
            scratch_columns,
            per_dt2: 2.0,
            gamma: 0.0,
        });
        assert!(state.positions().iter().all(|axis| axis.iter().all(|p| *p == 1.0)));
    }
}
