//! The discretisation in f64: particles, links, bending stencils; plain data, or what a baked garment holds.

use glam::DVec3;
use toile_base::fabric::link_curve::LinkCurve;
use toile_base::garment::Garment;
use toile_base::garment::layout::{Bends, Diagonals, ENDED, FiberLists, Fibers, Hubs, Links};
use toile_base::garment::link_curves::CurveTable;

use super::error::OracleError;

/// Stretch between two particles: energy (1/2) C^2 / compliance of C = |b - a| - rest, in tension and in compression.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Link {
    /// Indices of the two particles.
    pub ends: [u32; 2],
    /// Length as cut (m).
    pub rest: f64,
    /// Inverse stiffness (m/N); 0 is inextensible.
    pub compliance: f64,
}

/// Bending: energy (1/2) |sum c_i x_i|^2.
#[derive(Debug, Clone, PartialEq)]
pub struct Bend {
    /// Indices of the particles.
    pub particles: Vec<u32>,
    /// Their coefficients (sqrt(N/m)).
    pub coefficients: Vec<f64>,
}

/// What is to be solved: the same particles, masses, links and stencils as the engine's.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Problem {
    /// Mass (kg), 0 where the particle is pinned `[particles]`.
    pub mass: Vec<f64>,
    /// Where the garment starts (m) `[particles]`.
    pub start: Vec<DVec3>,
    /// Stretch links of the garment.
    pub links: Vec<Link>,
    /// What each link does beyond one slope, and where its friction sticks: strain (1) and force (N), in place of its compliance `[links]`;
    /// empty where one slope is all that any has.
    pub link_curves: Vec<LinkCurve>,
    /// Bending stencils of the garment.
    pub bends: Vec<Bend>,
    /// Acceleration of gravity (m/s2).
    pub gravity: DVec3,
    /// Distance kept from every solid (m).
    pub offset_m: f64,
    /// Coulomb coefficient, sticking and sliding alike.
    pub friction: f64,
    /// Which of the first 32 cones each particle can touch, a bit each; empty where each may touch all `[particles]`.
    pub reach: Vec<u32>,
}

impl Problem {
    /// What a baked garment says, in standard gravity; tethers, wind and the speed limit are the engine's own.
    ///
    /// Which limb's colliders a particle can meet is left open: set [`Self::reach`] where the garment has parts.
    pub fn of(garment: &Garment) -> Self {
        let layout = garment.layout();
        let [of_bias, of_shear, of_weft, of_fibers, of_lists] = layout.link_curves.tables();
        let mut found = LinkCollector::default();
        tuples(&layout.shear, &mut found.of(of_shear));
        tuples(&layout.weft, &mut found.of(of_weft));
        diagonals(&layout.diagonals, &mut found.of(of_bias));
        fibers(&layout.fibers, &mut found.of(of_fibers));
        lists(&layout.crossing, &mut found.of(of_lists));
        let LinkCollector { links, link_curves } = found;
        let mut stencils = Vec::new();
        bends(&layout.bends, &mut stencils);
        bends(&layout.skewed, &mut stencils);
        hubs(&layout.hubs, &mut stencils);
        let mass = |w: &f32| if *w > 0.0 { f64::from(*w).recip() } else { 0.0 };
        Self {
            mass: garment.inverse_mass.iter().map(mass).collect(),
            start: garment.start.iter().map(|p| p.as_dvec3()).collect(),
            links,
            link_curves: if layout.link_curves.acts() { link_curves } else { Vec::new() },
            bends: stencils,
            gravity: DVec3::new(0.0, -9.81, 0.0),
            offset_m: f64::from(garment.fabric.contact_offset_mm) * 1e-3,
            friction: f64::from(garment.fabric.friction),
            reach: Vec::new(),
        }
    }

    /// Number of particles.
    pub fn particles(&self) -> usize {
        self.mass.len()
    }

    /// Whether a particle is held in place.
    pub fn pinned(&self, particle: usize) -> bool {
        self.mass[particle] <= 0.0
    }

    /// Mass of what is free (kg).
    pub fn free_mass(&self) -> f64 {
        self.mass.iter().sum()
    }

    /// Everything is of the right length, in range and finite.
    pub(super) fn check(&self) -> Result<(), OracleError> {
        let n = self.particles();
        let lengths = [("start", self.start.len())].into_iter();
        let lengths = lengths.chain((!self.reach.is_empty()).then_some(("reach", self.reach.len())));
        for (what, got) in lengths {
            expect(what, got, n)?;
        }
        let sound =
            |ok: bool, what: &'static str, at: usize| ok.then_some(()).ok_or(OracleError::Unusable { what, at });
        for (at, m) in self.mass.iter().enumerate() {
            sound(m.is_finite() && *m >= 0.0, "mass", at)?;
        }
        for (at, l) in self.links.iter().enumerate() {
            let [a, b] = l.ends.map(|i| i as usize);
            let figures = l.rest.is_finite() && l.rest > 0.0 && l.compliance.is_finite() && l.compliance >= 0.0;
            sound(figures && a != b && a < n && b < n, "link", at)?;
        }
        if !self.link_curves.is_empty() {
            expect("link curves", self.link_curves.len(), self.links.len())?;
        }
        for (at, l) in self.link_curves.iter().enumerate() {
            let slopes = l.slope > 0.0 && l.slope.is_finite() && l.behind.iter().all(|s| *s > 0.0 && s.is_finite());
            let knees = l.knees[0] <= 0.0 && l.knees[1] >= 0.0 && l.stuck.is_finite();
            sound(slopes && knees && l.half_width >= 0.0 && l.half_width.is_finite(), "link curve", at)?;
        }
        for (at, b) in self.bends.iter().enumerate() {
            let within = b.particles.iter().all(|&i| (i as usize) < n);
            sound(within && b.coefficients.iter().all(|c| c.is_finite()), "bend", at)?;
        }
        sound(self.gravity.is_finite() && self.offset_m.is_finite() && self.friction >= 0.0, "gravity or contact", 0)
    }
}

/// Refuses an array of another length than asked for.
pub(super) fn expect(what: &'static str, got: usize, expected: usize) -> Result<(), OracleError> {
    if got == expected { Ok(()) } else { Err(OracleError::Length { what, got, expected }) }
}

/// Links as they are found, each with its curve.
#[derive(Default)]
struct LinkCollector {
    links: Vec<Link>,
    link_curves: Vec<LinkCurve>,
}

impl LinkCollector {
    /// Takes links of one kind: a place of their parameters, their ends, rest length and compliance.
    fn of<'a>(&'a mut self, table: &'a CurveTable) -> impl FnMut(usize, [u32; 2], f32, f32) + 'a {
        move |at, ends, rest, compliance| {
            if compliance >= ENDED || rest <= 0.0 {
                return;
            }
            let (rest, compliance) = (f64::from(rest), f64::from(compliance));
            self.links.push(Link { ends, rest, compliance });
            self.link_curves.push(link_curve(table, at, rest / compliance));
        }
    }
}

/// Curve at a place of the table; `slope` is the force at a strain of 1 (N).
fn link_curve(table: &CurveTable, at: usize, slope: f64) -> LinkCurve {
    if table.is_empty() || !slope.is_finite() {
        return LinkCurve::plain(slope.min(HARD_N));
    }
    let [lower, below, upper, above, friction] =
        [&table.lower, &table.lower_slope, &table.upper, &table.upper_slope, &table.friction].map(|c| c[at].into());
    LinkCurve { slope, knees: [lower, upper], behind: [below, above], half_width: friction * slope, stuck: 0.0 }
}

/// Force for a strain of 1 of what does not stretch, beside links with curves (N).
const HARD_N: f64 = 1e9;

fn tuples(from: &Links, add: &mut impl FnMut(usize, [u32; 2], f32, f32)) {
    from.tuples.for_each(|at, ends| add(at, ends, from.rest[at], from.compliance[at]));
}

fn diagonals(from: &Diagonals, add: &mut impl FnMut(usize, [u32; 2], f32, f32)) {
    from.for_each(|at, ends| add(at, ends, from.rest[at], from.compliance[at]));
}

fn fibers(from: &Fibers, add: &mut impl FnMut(usize, [u32; 2], f32, f32)) {
    for bundle in &from.bundles {
        let rows = &from.rows[bundle.rows.start as usize..bundle.rows.end as usize];
        for (step, pair) in rows.windows(2).enumerate() {
            for lane in 0..pair[1].lanes {
                let apart = step as u32 * bundle.lanes + lane;
                let at = (bundle.at + if bundle.alike { step as u32 } else { apart }) as usize;
                add(at, [pair[0].first + lane, pair[1].first + lane], from.rest[at], from.compliance[at]);
            }
        }
    }
}

fn lists(from: &FiberLists, add: &mut impl FnMut(usize, [u32; 2], f32, f32)) {
    for list in &from.lists {
        for step in 0..list.links() {
            for lane in 0..list.lanes {
                let particle = |row: u32| from.index[(list.first + row % list.rows * list.lanes + lane) as usize];
                let at = (list.at + step * list.lanes + lane) as usize;
                add(at, [particle(step), particle(step + 1)], from.rest[at], from.compliance[at]);
            }
        }
    }
}

fn bends<const K: usize>(from: &Bends<K>, to: &mut Vec<Bend>) {
    from.tuples.for_each(|at, v| {
        let coefficients = from.coefficients.iter().map(|c| c[at].into()).collect();
        to.push(Bend { particles: v.into(), coefficients });
    });
}

fn hubs(from: &Hubs, to: &mut Vec<Bend>) {
    from.for_each(|_, particles, coefficients| {
        let sums = coefficients.len() / particles.len();
        to.extend((0..sums).map(|sum| Bend {
            particles: particles.into(),
            coefficients: coefficients[sum..].iter().step_by(sums).map(|c| f64::from(*c)).collect(),
        }));
    });
}
