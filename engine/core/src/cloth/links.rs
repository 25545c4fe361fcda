//! Links: stretch between two particles, set by set, by Gauss-Seidel.
//!
//! Extended position-based dynamics (Macklin, Mueller, Chentanez 2016, eq. 18 and 26): for C = |b - a| - rest with
//! compliance alpha and damping time tau, one pass a substep moves the ends by -+ w n lambda with
//! lambda = (C + gamma n.(db - da)) / ((1 + gamma)(w_a + w_b) + alpha / dt^2), gamma = tau / dt, where da and db are the
//! ends' motion in this substep. No two links of a set share a particle, so their order changes no bit.

use toile_assets::garment::layout::{Links, Set};

use super::state::Columns;
use crate::lanes::{Column, Kernel, Lanes, MOST, V3, reciprocal_root};

/// 1 / ((1 + gamma)(w_a + w_b) + alpha / dt^2) of each link, in the order of the parameters; 0 where nothing can move.
pub fn prepare(links: &Links, weights: &[f32], dt: f32, gamma: f32, gain: &mut [f32]) {
    let per_dt2 = (dt * dt).recip();
    links.tuples.for_each(|place, [a, b]| {
        let w = weights[a as usize] + weights[b as usize];
        let weight = (1.0 + gamma) * w + links.compliance[place] * per_dt2;
        gain[place] = if w > 0.0 && weight > 0.0 { weight.recip() } else { 0.0 };
    });
}

/// One owner's share of one set.
pub struct Solve<'a> {
    /// The garment's particles.
    pub columns: Columns<'a>,
    /// All links.
    pub links: &'a Links,
    /// What [`prepare`] made.
    pub gain: &'a [f32],
    /// The set.
    pub set: &'a Set,
    /// Whose share of it.
    pub owner: usize,
    /// Damping time over the substep (1).
    pub gamma: f32,
    /// The tension of each link so far in this substep, and 1 / dt^2, where links with compliance are solved more than
    /// once a substep: without it, each pass would add a spring of its own.
    pub tension: Option<(Column<'a>, f32)>,
}

impl Kernel for Solve<'_> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(mut self) {
        self.columns = self.columns.level();
        if self.gamma > 0.0 || self.tension.is_some() { self.all::<L, true>() } else { self.all::<L, false>() }
    }
}

impl Solve<'_> {
    #[inline(always)]
    fn all<L: Lanes, const SOFT: bool>(&self) {
        let (rest, gain) = (Column::read_only(&self.links.rest), Column::read_only(self.gain));
        let soft = Column::read_only(&self.links.compliance);
        let share = &self.set.shares[self.owner];
        let w = self.columns.w;
        for run in &self.links.tuples.runs[share.runs.start as usize..share.runs.end as usize] {
            let [a, b] = run.first.map(|f| f as usize);
            let (at, len) = (run.at as usize, run.len as usize);
            let one = |c: Column<'_>, i: usize| L::splat(c.get(i));
            let mut p = [one(rest, at), one(gain, at), one(w, a), one(w, b)];
            let mut t = 0;
            while t + L::N <= len {
                if !run.alike {
                    p = [L::load(rest, at + t), L::load(gain, at + t), L::load(w, a + t), L::load(w, b + t)];
                }
                let slack =
                    self.slack::<L, SOFT>(soft, [run.place(t as u32), run.serial as usize + t], run.alike, L::N);
                let pull = self.side_by_side::<L, SOFT>([a + t, b + t], p, slack, L::N);
                self.count::<L, SOFT>(pull, run.serial as usize + t, L::N);
                t += L::N;
            }
            if t < len && L::N > 1 {
                // Less than a vector, and the compiler is told so.
                let n = (len - t).min(L::N - 1);
                if !run.alike {
                    let part = |c, i| L::load_part(c, i + t, n);
                    p = [part(rest, at), part(gain, at), part(w, a), part(w, b)];
                }
                let slack = self.slack::<L, SOFT>(soft, [run.place(t as u32), run.serial as usize + t], run.alike, n);
                let pull = self.side_by_side::<L, SOFT>([a + t, b + t], p, slack, n);
                self.count::<L, SOFT>(pull, run.serial as usize + t, n);
            }
        }
        let loose = &self.links.tuples.loose;
        let mut k = 0;
        while k < share.loose.len() {
            let n = (share.loose.len() - k).min(L::N);
            let first = share.loose.start as usize + k;
            let (at, number) = (share.loose_at as usize + k, share.loose_serial as usize + k);
            let slack = self.slack::<L, SOFT>(soft, [at, number], false, n);
            let pull = self.listed::<L, SOFT>(&loose[first..first + n], [rest, gain], at, slack);
            self.count::<L, SOFT>(pull, number, n);
            k += n;
        }
    }

    /// What links give by their compliance under the tension that they have (m).
    #[inline(always)]
    fn slack<L: Lanes, const SOFT: bool>(
        &self,
        soft: Column<'_>,
        [at, number]: [usize; 2],
        alike: bool,
        n: usize,
    ) -> L {
        let Some((tension, per_dt2)) = self.tension.filter(|_| SOFT) else { return L::splat(0.0) };
        let part = |c: Column<'_>, i| if n == L::N { L::load(c, i) } else { L::load_part(c, i, n) };
        let soft = if alike { L::splat(soft.get(at)) } else { part(soft, at) };
        part(tension, number) * soft * L::splat(per_dt2)
    }

    /// Adds to the tension of links.
    #[inline(always)]
    fn count<L: Lanes, const SOFT: bool>(&self, by: L, number: usize, n: usize) {
        let Some((tension, _)) = self.tension.filter(|_| SOFT) else { return };
        if n == L::N {
            (L::load(tension, number) + by).store(tension, number);
        } else {
            (L::load_part(tension, number, n) + by).store_part(tension, number, n);
        }
    }

    /// Links by index list; gives by how much their tension grew.
    #[inline(always)]
    fn listed<L: Lanes, const SOFT: bool>(
        &self,
        links: &[[u32; 2]],
        [rest, gain]: [Column<'_>; 2],
        at: usize,
        slack: L,
    ) -> L {
        let c = &self.columns;
        let n = links.len();
        let mut ends = [[0u32; MOST]; 2];
        for (t, link) in links.iter().enumerate() {
            (ends[0][t], ends[1][t]) = (link[0], link[1]);
        }
        let [a, b] = &ends;
        let part = |c| if n == L::N { L::load(c, at) } else { L::load_part(c, at, n) };
        let (pa, pb) = (V3::<L>::gather(c.x, a, n), V3::gather(c.x, b, n));
        let moved = || (pb - V3::gather(c.previous, b, n)) - (pa - V3::gather(c.previous, a, n));
        let (push, by) = self.push::<L, SOFT>(pb - pa, [part(rest), part(gain), slack], moved);
        (pa + push * L::gather(c.w, a, n)).scatter(c.x, a, n);
        (pb - push * L::gather(c.w, b, n)).scatter(c.x, b, n);
        by
    }

    /// `n` links whose ends lie side by side; gives by how much their tension grew.
    #[inline(always)]
    fn side_by_side<L: Lanes, const SOFT: bool>(
        &self,
        [a, b]: [usize; 2],
        parameters: [L; 4],
        slack: L,
        n: usize,
    ) -> L {
        let [rest, gain, wa, wb] = parameters;
        let c = &self.columns;
        let (pa, pb) = (V3::<L>::load(c.x, a, n), V3::load(c.x, b, n));
        let moved = || (pb - V3::load(c.previous, b, n)) - (pa - V3::load(c.previous, a, n));
        let (push, by) = self.push::<L, SOFT>(pb - pa, [rest, gain, slack], moved);
        (pa + push * wa).store(c.x, a, n);
        (pb - push * wb).store(c.x, b, n);
        by
    }

    /// How far a link of vector `d` draws an end of weight 1, and by how much its tension grows.
    #[inline(always)]
    fn push<L: Lanes, const SOFT: bool>(
        &self,
        d: V3<L>,
        [rest, gain, slack]: [L; 3],
        moved: impl Fn() -> V3<L>,
    ) -> (V3<L>, L) {
        let length2 = d.dot(d);
        let inverse = reciprocal_root(length2);
        if !SOFT {
            // lambda / |d|: (|d| - rest) / |d| times the gain.
            return (d * ((L::splat(1.0) - rest * inverse) * gain), L::splat(0.0));
        }
        let mut stretch = length2 * inverse - rest - slack;
        if self.gamma > 0.0 {
            stretch = stretch + d.dot(moved()) * inverse * L::splat(self.gamma);
        }
        let by = stretch * gain;
        (d * (by * inverse), by)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cloth::state::State;
    use crate::lanes::Width;
    use glam::Vec3;
    use toile_assets::garment::Direction;
    use toile_assets::garment::layout::{Run, Share, Tuples};

    /// Links between particles i and i + n.
    fn ladder(n: u32, rest: f32, compliance: f32) -> Links {
        let share = Share { runs: 0..1, loose: 0..0, loose_at: n, loose_serial: n };
        let set = Set { direction: Direction::Weft, crosses: false, shares: [share, Share::default()] };
        let runs = [Run { first: [0, n], len: n, at: 0, serial: 0, alike: false }].into();
        Links {
            tuples: Tuples { runs, loose: [].into(), sets: [set].into(), count: n as usize, places: n as usize },
            rest: vec![rest; n as usize].into(),
            compliance: vec![compliance; n as usize].into(),
        }
    }

    fn solved(width: Width, positions: &[Vec3], weights: &[f32], links: &Links, gamma: f32) -> Vec<Vec3> {
        let mut state = State::new(positions, weights);
        let mut gain = vec![0.0; links.rest.len()];
        prepare(links, weights, 1.0, gamma, &mut gain);
        let set = &links.tuples.sets[0];
        width.run(Solve { columns: state.columns(), links, gain: &gain, set, owner: 0, gamma, tension: None });
        (0..positions.len()).map(|i| Vec3::from_array(state.positions().map(|a| a[i]))).collect()
    }

    #[test]
    fn a_stiff_link_reaches_its_length_and_keeps_the_centre_of_mass() {
        let p = solved(Width::widest(), &[Vec3::ZERO, Vec3::X * 2.0], &[1.0, 3.0], &ladder(1, 1.0, 0.0), 0.0);
        assert!(((p[1] - p[0]).length() - 1.0).abs() < 2e-6);
        assert!((p[0].x + p[1].x / 3.0 - 2.0 / 3.0).abs() < 2e-6);
    }

    #[test]
    fn collapsed_and_fixed_links_do_nothing() {
        for (w, b) in [([1.0, 1.0], Vec3::ZERO), ([0.0, 0.0], Vec3::X * 3.0)] {
            assert_eq!(solved(Width::widest(), &[Vec3::ZERO, b], &w, &ladder(1, 1.0, 0.0), 0.0), [Vec3::ZERO, b]);
        }
    }

    #[test]
    fn every_width_gives_the_same_bits_and_f64_agrees() {
        let n = 37;
        let place = |i: u32| Vec3::new((i as f32 * 0.37).sin(), 0.1 * (i / n) as f32, (i as f32 * 0.71).cos()) * 0.3;
        let positions: Vec<Vec3> = (0..2 * n).map(place).collect();
        let weights: Vec<f32> = (0..2 * n).map(|i| if i % 5 == 0 { 0.0 } else { 1.0 + i as f32 }).collect();
        let links = ladder(n, 0.12, 2.0);
        let plain = solved(Width::One, &positions, &weights, &links, 0.25);
        for width in Width::ALL.into_iter().filter(|w| w.available()) {
            assert_eq!(solved(width, &positions, &weights, &links, 0.25), plain, "{width} lanes");
        }
        for i in 0..n as usize {
            let (a, b) = (positions[i].as_dvec3(), positions[i + n as usize].as_dvec3());
            let (wa, wb) = (f64::from(weights[i]), f64::from(weights[i + n as usize]));
            if wa + wb == 0.0 {
                continue;
            }
            let d = b - a;
            // Nothing has moved yet in this substep: damping only weakens the pull.
            let lambda = (d.length() - f64::from(0.12f32)) / (1.25 * (wa + wb) + 2.0);
            let expected = b - d.normalize() * lambda * wb;
            let error = (expected - plain[i + n as usize].as_dvec3()).length();
            assert!(error < 1e-6, "link {i}: {error} m");
        }
    }
}
