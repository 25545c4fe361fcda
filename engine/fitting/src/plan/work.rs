//! Work of a step of a garment, counted from its layout in units that each take about the same time: one pass of the lanes, or one
//! value that is gathered.

use glam::Vec3;
use toile_base::garment::layout::{ENDED, Links};
use toile_base::garment::{Garment, Part};
use toile_engine::cloth::forces::bending_matrix::{BendingMatrix, RowBlock, RowStrip};
use toile_engine::cloth::forces::friction_rows::{FrictionRows, FrictionStrip, FrictionTable};
use toile_engine::cloth::step::program::{self, BEFORE, Bending, Stage};
use toile_engine::cloth::{Cloth, Quality, Settings, contact, forces::bending, links::record_links};
use toile_engine::colliders::Colliders;

/// Kinds of unit in each stage.
pub const KINDS: usize = 4;

/// The stages of the cloth as the engine meters them, and what none of them counts: the guard, the skinned particles'
/// targets, the copy of the positions.
pub const STAGES: [&str; 10] =
    ["predict", "bend", "shear", "weft", "fibers", "contact", "wind", "tethers", "layers", "rest"];

/// What is counted in each stage, in one step.
pub const UNITS: [[&str; KINDS]; STAGES.len()] = [
    ["lanes of particles", "skinned particles", "tensions", ""],
    ["lanes of entries of rows", "lanes of scattered entries", "lanes of records", "lanes of entries that rub"],
    ["lanes of links along fibers", "lanes of links", "lanes of scattered links", ""],
    ["lanes of links", "lanes of scattered links", "phases", ""],
    ["lanes of rows", "lanes of rows by index", "lanes of closed hoops", ""],
    ["blocks of particles", "near pairs", "phases", "blocks of particles by the skin"],
    ["lanes of triangles", "", "", ""],
    ["lanes of particles", "", "", ""],
    ["lanes of particles that may fold", "lanes of particles by other garments", "phases", ""],
    ["lanes of particles", "skinned particles", "", ""],
];

/// How much of each unit.
pub type Counts = [[f64; KINDS]; STAGES.len()];

/// Particles of a block of the broad phase.
const BLOCK: f64 = 16.0;

/// The work of one step of one garment.
#[derive(Debug, Clone, PartialEq)]
pub struct Work {
    /// Units, in the order of [`UNITS`].
    pub counts: Counts,
    /// Number of phases, which is the number of barriers of two workers.
    pub phases: f64,
    /// Share of the particles that the busier of two workers has.
    pub share: f64,
    /// Substeps of a step.
    pub substeps: u32,
}

/// Cloth nearer to the body than this, as it is laid on, counts as near (m): what it moves towards the body in a step, and
/// the ease that gives way where it hangs.
const NEAR_M: f32 = 0.015;

/// Pairs of a particle that moves and a capsule that its part can touch, near as the garment is laid on.
pub fn near(garment: &Garment, colliders: &Colliders) -> f64 {
    let cones = colliders.cones_at(1.0);
    let free = garment.parts.iter().zip(&garment.start).zip(&garment.inverse_mass).filter(|(_, w)| **w > 0.0);
    let of = |((part, p), _): ((&Part, &Vec3), &f32)| {
        let bits = contact::body::reach(*part, colliders);
        let touches = |c: &usize| bits >> c & 1 != 0 && cones[*c].distance(*p).0 < NEAR_M;
        (0..colliders.capsules().len()).filter(touches).count() as f64
    };
    free.map(of).sum()
}

/// Particles of a garment that are within this of where another one is laid on (m): what cloth comes nearer in a step.
const BESIDE_M: f32 = 0.03;

/// Particles of a garment that are within reach of another, summed over the others.
pub fn beside(garment: usize, all: &[Garment]) -> f64 {
    let around = |other: &Garment| {
        let none = [Vec3::INFINITY, Vec3::NEG_INFINITY];
        other.start.iter().fold(none, |[low, high], p| [low.min(*p), high.max(*p)])
    };
    let others = all.iter().enumerate().filter(|(k, _)| *k != garment).map(|(_, other)| around(other));
    let within = |[low, high]: [Vec3; 2]| {
        let inside = |p: &&Vec3| p.cmpge(low - BESIDE_M).all() && p.cmple(high + BESIDE_M).all();
        all[garment].start.iter().filter(inside).count() as f64
    };
    others.map(within).sum()
}

/// What only a step tells: how it was prepared, and how much of the garment is near the body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FirstStep {
    /// Substeps of a step.
    pub substeps: u32,
    /// How bending goes on.
    pub bend: bending::BendingPace,
    /// Pairs of particle and capsule that are near.
    pub near: f64,
    /// Particles within reach of another garment, summed over these.
    pub beside: f64,
    /// Particles that lie by the skin.
    pub on_skin: f64,
}

impl FirstStep {
    /// Of a cloth that was made, and stepped once.
    pub fn of(cloth: &Cloth, near: f64) -> Self {
        Self { substeps: cloth.substeps(), bend: cloth.bend_pace(), near, beside: 0.0, on_skin: cloth.on_skin() as f64 }
    }
}

impl Work {
    /// The same work and that of another garment, one after the other.
    #[must_use]
    pub fn and(mut self, other: &Self) -> Self {
        for (to, from) in self.counts.iter_mut().zip(&other.counts) {
            to.iter_mut().zip(from).for_each(|(to, from)| *to += from);
        }
        Self { phases: self.phases + other.phases, ..self }
    }

    /// Counts the work of a garment under some settings.
    pub fn of(garment: &Garment, settings: &Settings, first: &FirstStep) -> Self {
        let count = Count { garment, quality: settings.quality, lanes: settings.width.lanes() };
        let n = f64::from(first.substeps);
        let (particles, fixed) = (count.vectors(garment.particles()), garment.fixed.len() as f64);
        let held = settings.tethers || settings.quality == Quality::Draft;
        let when = |on: bool, amount: f64| if on { amount } else { 0.0 };
        let only = |on: bool, amount: f64| [when(on, amount), 0.0, 0.0, 0.0];
        let per = |counts: [f64; KINDS]| counts.map(|c| c * n);
        let bent = n / f64::from(first.bend.every.max(1)) * f64::from(first.bend.stages);
        // Shear along whole fibers acts in every second of an even number of substeps.
        let half = first.substeps.is_multiple_of(2) && settings.quality != Quality::Fine;
        let leaning = if half { 0.5 } else { 1.0 };
        let (matrix, friction) = (BendingMatrix::new(garment), FrictionRows::new(garment));
        let [shear, scattered] = count.links(&garment.layout().shear);
        let rubs = n / f64::from(first.bend.friction_every.max(1));
        let mut bends = count.bending(&matrix).map(|c| c * bent);
        bends[3] = count.rubbing(&friction) * rubs;
        let touching = first.near / BLOCK * n;
        let beside = first.beside / count.lanes as f64;
        let every = settings.contact;
        let rate = |every: u8, amount: f64| if every == 0 { 0.0 } else { amount / f64::from(every) };
        let barriers = when(every.folds > 0 || (every.layers > 0 && beside > 0.0), n);
        let counts = [
            per([particles, fixed, count.tensions(), 0.0]),
            bends,
            per([count.leaning() * leaning, shear, scattered, 0.0]),
            per(count.weft()),
            per(count.fibers()),
            [garment.particles() as f64 / BLOCK, touching, n, first.on_skin / BLOCK * n],
            only(settings.wind.is_some(), count.vectors(garment.triangles.len())),
            only(held, particles * n),
            [rate(every.folds, particles), rate(every.layers, beside), barriers, 0.0],
            [particles, fixed, 0.0, 0.0],
        ];
        let bending = Bending { stages: first.bend.stages, friction: friction.acts(), ..Bending::plain(&matrix) };
        let each = bending.len() + program::constraints(garment.layout(), settings.quality).len();
        let own = garment.layout().spans[0].iter().map(|s| f64::from(s.1)).sum::<f64>() / garment.particles() as f64;
        Self {
            counts,
            phases: BEFORE.len() as f64 + n * each as f64,
            share: own.max(1.0 - own),
            substeps: first.substeps,
        }
    }
}

struct Count<'a> {
    garment: &'a Garment,
    quality: Quality,
    lanes: usize,
}

impl Count<'_> {
    /// Passes of the lanes over so many things side by side.
    fn vectors(&self, things: usize) -> f64 {
        things.div_ceil(self.lanes) as f64
    }

    /// Lanes of runs, and of what is in none; all of them where they are solved by records.
    fn links(&self, links: &Links) -> [f64; 2] {
        let tuples = &links.tuples;
        if record_links::preferred(links, self.garment.particles()) && !self.garment.layout().link_curves.acts() {
            return [0.0, tuples.count as f64 / self.lanes as f64];
        }
        let zigzags = tuples.zigzags.iter().flat_map(|z| [z.straights.len, z.slants.len]);
        let runs = zigzags.chain(tuples.runs.iter().map(|r| r.len));
        [runs.map(|len| self.vectors(len as usize)).sum(), tuples.loose.len() as f64 / self.lanes as f64]
    }

    /// How often an operation is in a substep.
    fn times(&self, wanted: Stage) -> f64 {
        program::constraints(self.garment.layout(), self.quality).iter().filter(|op| **op == wanted).count() as f64
    }

    fn bending(&self, matrix: &BendingMatrix) -> [f64; KINDS] {
        let strip = |s: &RowStrip| f64::from(1 + s.entries) * self.vectors(s.len as usize);
        let block = |b: &RowBlock| f64::from(1 + b.entries) * self.vectors(b.len as usize);
        let records = if matrix.reads_records() { self.vectors(self.garment.particles()) } else { 0.0 };
        [matrix.strips.iter().map(strip).sum(), matrix.blocks.iter().map(block).sum(), records, 0.0]
    }

    /// Entries of slots and rows; by index they take some three times as long as side by side.
    fn rubbing(&self, friction: &FrictionRows) -> f64 {
        let table = |t: &FrictionTable, own: u32| {
            let entries = |s: &FrictionStrip| -> u32 {
                let parts = &t.parts[s.parts.start as usize..s.parts.end as usize];
                parts.iter().map(|p| own + p.offsets.end - p.offsets.start).sum()
            };
            let strips = t.strips.iter().map(|s| f64::from(entries(s)) * self.vectors(s.len as usize));
            let blocks = t.blocks.iter().map(|b| 3.0 * f64::from(own + b.entries) * self.vectors(b.len as usize));
            strips.sum::<f64>() + blocks.sum::<f64>()
        };
        // A slot reads its middle, its normal, three numbers of its own, and writes four; a row itself.
        table(&friction.slots, 4) + table(&friction.rows, 1)
    }

    fn leaning(&self) -> f64 {
        self.garment.layout().diagonals.runs.iter().map(|r| self.vectors(r.len as usize)).sum()
    }

    fn weft(&self) -> [f64; KINDS] {
        let weft = &self.garment.layout().weft;
        let [runs, loose] = self.links(weft);
        let passes = self.times(Stage::Weft(0));
        // Each stretch curve looks at its link once, which takes about as long as the link.
        let link_curves: usize = self.garment.layout().link_curves.tables().iter().map(|t| t.len()).sum();
        [runs * passes + self.vectors(link_curves), loose * passes, weft.tuples.sets.len() as f64 * passes, 0.0]
    }

    fn fibers(&self) -> [f64; KINDS] {
        let layout = self.garment.layout();
        let rows: f64 = layout.fibers.rows.iter().map(|r| self.vectors(r.lanes as usize)).sum();
        let listed = |closed: bool| {
            let lists = layout.crossing.lists.iter().filter(|l| l.closed == closed);
            lists.map(|l| l.links() as f64 * self.vectors(l.lanes as usize)).sum::<f64>()
        };
        let (whole, crossing) = (self.times(Stage::Fibers), self.times(Stage::Crossing(0)));
        [rows * whole, listed(false) * crossing, listed(true) * crossing, 0.0]
    }

    /// Tensions that a substep begins with none of.
    fn tensions(&self) -> f64 {
        let layout = self.garment.layout();
        let Links { tuples, compliance, .. } = &layout.weft;
        let all = [
            (compliance, tuples.count),
            (&layout.fibers.compliance, layout.fibers.links),
            (&layout.crossing.compliance, layout.crossing.rest.len()),
        ];
        let gives = |c: &[f32]| layout.link_curves.acts() || c.iter().any(|c| (1e-6..ENDED).contains(c));
        all.into_iter().filter(|(c, _)| gives(c)).map(|(_, count)| count as f64).sum()
    }
}
