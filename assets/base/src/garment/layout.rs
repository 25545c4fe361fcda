//! How constraints lie in memory: side by side, so that kernels take many at a time without looking up indices.
//!
//! Particles are numbered so that what is solved together is contiguous. A [`ConstraintRun`] is a row of constraints whose
//! particles all advance by one; a [`FiberBundle`] is a row of fibers of which every step lies contiguous. What fits neither
//! is kept as an index list. Each particle, and each constraint, has one of two owners: two workers may solve a set at
//! once, because no two constraints of a set share a particle.

use std::ops::Range;

use super::bend_friction::BendFriction;
use super::link_curves::LinkCurves;
use super::{Direction, Solver};

/// Workers that a garment can be shared between.
pub const OWNERS: usize = 2;

/// Most fibers of one index list: the widest lanes.
pub const MAX_LISTED: usize = 16;

/// Constraints side by side: constraint `t < len` holds the particles `first[k] + t`. Where they are all alike, in their
/// parameters and in the masses of their particles, they share the parameters at `at`; else its own are at `at + t`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ConstraintRun<const K: usize> {
    /// Particles of the first constraint.
    pub first: [u32; K],
    /// Number of constraints.
    pub len: u32,
    /// Index of its first parameters.
    pub at: u32,
    /// Number of its first constraint among all.
    pub serial: u32,
    /// Whether all are alike.
    pub alike: bool,
}

impl<const K: usize> ConstraintRun<K> {
    /// Where the parameters of constraint `t` are.
    #[inline(always)]
    pub fn place(&self, t: u32) -> usize {
        (if self.alike { self.at } else { self.at + t }) as usize
    }
}

/// Constraints in a zigzag between two rows (rails) of particles: straight constraint `t` from particle `t` of the first rail
/// to the one of the second beside it, slanted constraint `t` from there to the next one of the first. Solved in this order,
/// straights before slants.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Zigzag {
    /// Constraints straight across, from rail to rail.
    pub straights: ConstraintRun<2>,
    /// The slants, one less than straights; as many where the last one leads back to the first particle.
    pub slants: ConstraintRun<2>,
}

impl Zigzag {
    /// Whether the last slant leads back to the first particle.
    #[inline(always)]
    pub fn closed(&self) -> bool {
        self.slants.len == self.straights.len
    }

    /// The particles of slant `t`.
    #[inline(always)]
    pub fn slant(&self, t: u32) -> [u32; 2] {
        let [from, to] = self.slants.first;
        [from + t, if t + 1 == self.straights.len { self.straights.first[0] } else { to + t }]
    }
}

/// One owner's share of a set.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct OwnerShare {
    /// Its zigzags, a range of [`Tuples::zigzags`]; a set has them or the others.
    pub zigzags: Range<u32>,
    /// Its runs, a range of [`Tuples::runs`].
    pub runs: Range<u32>,
    /// Its constraints that are in no run, a range of [`Tuples::loose`].
    pub loose: Range<u32>,
    /// Where the parameters of the first loose one are.
    pub loose_at: u32,
    /// Number of the first loose one among all constraints.
    pub loose_serial: u32,
}

/// Constraints of one direction; in a set of [`Links`] no two share a particle.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ConstraintSet {
    /// Direction of its first constraint.
    pub direction: Direction,
    /// Whether its constraints touch particles of both owners and nothing keeps them apart: one worker's then.
    pub crosses: bool,
    /// Share of each owner (worker).
    pub shares: [OwnerShare; OWNERS],
}

/// Constraints over `K` particles, in sets.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Tuples<const K: usize> {
    /// Zigzags, set after set, owner after owner; only pairs have any.
    pub zigzags: Box<[Zigzag]>,
    /// Runs, set after set, owner after owner.
    pub runs: Box<[ConstraintRun<K>]>,
    /// Particles of the constraints that are in no zigzag and no run, set after set, owner after owner.
    pub loose: Box<[[u32; K]]>,
    /// The sets in the order in which they are solved.
    pub sets: Box<[ConstraintSet]>,
    /// Number of constraints, of all kinds above.
    pub count: usize,
    /// Places of parameters: fewer than constraints where some are alike.
    pub places: usize,
}

impl<const K: usize> Tuples<K> {
    /// Calls `each(place, particles)` for every constraint with the place of its parameters.
    pub fn for_each(&self, mut each: impl FnMut(usize, [u32; K])) {
        let pair = |pair: [u32; 2]| std::array::from_fn(|k| pair[k % 2]);
        for zigzag in &self.zigzags {
            let Zigzag { straights, slants } = zigzag;
            (0..straights.len).for_each(|t| each(straights.place(t), pair(straights.first.map(|f| f + t))));
            (0..slants.len).for_each(|t| each(slants.place(t), pair(zigzag.slant(t))));
        }
        for run in &self.runs {
            for t in 0..run.len {
                each(run.place(t), run.first.map(|f| f + t));
            }
        }
        for share in self.sets.iter().flat_map(|s| &s.shares) {
            for (k, i) in share.loose.clone().enumerate() {
                each(share.loose_at as usize + k, self.loose[i as usize]);
            }
        }
    }
}

/// Stretch constraints between two particles.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Links {
    /// Pairs of particles that are linked.
    pub tuples: Tuples<2>,
    /// Length as cut (m).
    pub rest: Box<[f32]>,
    /// Inverse stiffness (m/N).
    pub compliance: Box<[f32]>,
}

/// Bending stencils over `K` particles: energy (1/2) |sum c_i x_i|^2, the root of the stiffness within the coefficients.
#[derive(Debug, Clone, PartialEq)]
pub struct Bends<const K: usize> {
    /// Who is bent; the particle in the middle comes first. The sets of bends may share particles: they are forces, not
    /// projections. The first set keeps within the owners, the second crosses them.
    pub tuples: Tuples<K>,
    /// Coefficients (sqrt(N/m)), one array a particle of the stencil.
    pub coefficients: [Box<[f32]>; K],
}

impl<const K: usize> Default for Bends<K> {
    fn default() -> Self {
        Self { tuples: Tuples::default(), coefficients: std::array::from_fn(|_| [].into()) }
    }
}

/// One owner's part of a family of [`Diagonals`].
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct DiagonalShare {
    /// Its runs, a range of [`Diagonals::runs`], in the order of solving.
    pub runs: Range<u32>,
    /// The particles at which its fibers begin, a range of [`Diagonals::starts`].
    pub starts: Range<u32>,
}

/// Fibers along the bias that are solved directly, side by side. In a family at most one link leads to a particle and one
/// leads on from it, the one that leads to it in an earlier run.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Diagonals {
    /// Families: fibers that lean the same way.
    pub families: Box<[[DiagonalShare; OWNERS]]>,
    /// Links, family after family, owner after owner; the first particle of each is the one that the fiber comes from.
    pub runs: Box<[ConstraintRun<2>]>,
    /// Particles that no link leads to.
    pub starts: Box<[u32]>,
    /// Length as cut (m).
    pub rest: Box<[f32]>,
    /// Inverse stiffness (m/N).
    pub compliance: Box<[f32]>,
}

impl Diagonals {
    /// Number of links.
    pub fn count(&self) -> usize {
        self.runs.iter().map(|r| r.len as usize).sum()
    }

    /// Calls `each(place, particles)` for every link with the place of its parameters.
    pub fn for_each(&self, mut each: impl FnMut(usize, [u32; 2])) {
        for run in &self.runs {
            (0..run.len).for_each(|t| each(run.place(t), run.first.map(|f| f + t)));
        }
    }

    /// Heap memory that it holds (bytes).
    pub fn bytes(&self) -> usize {
        size_of_val(&*self.families) + size_of_val(&*self.runs) + 4 * self.starts.len() + 8 * self.rest.len()
    }
}

/// Hubs side by side with equally many particles and sums: vertices whose bending is measured over their whole ring.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct HubGroup {
    /// Particles of each: the vertex and its ring.
    pub points: u32,
    /// Sums of each over these particles, 1 to 3.
    pub sums: u32,
    /// Number of hubs in the group.
    pub count: u32,
    /// Number of the first among all hubs.
    pub number: u32,
    /// Where the particles of the first are in [`Hubs::particles`].
    pub particles: u32,
    /// Where its coefficients are in [`Hubs::coefficients`].
    pub coefficients: u32,
}

/// Bending stencils over whole rings: energy (1/2) |sum c_i x_i|^2 for each sum of a hub, the root of the stiffness within the
/// coefficients.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Hubs {
    /// Particles, hub after hub; the vertex in the middle comes first.
    pub particles: Box<[u32]>,
    /// Coefficients (sqrt(N/m)), hub after hub, particle after particle, those of its sums side by side.
    pub coefficients: Box<[f32]>,
    /// Group after group, owner after owner, set after set.
    pub groups: Box<[HubGroup]>,
    /// Each owner's groups, of two sets as [`Bends`] has them: what keeps within the owners, then what crosses them.
    pub sets: [[Range<u32>; OWNERS]; 2],
    /// Number of hubs.
    pub count: usize,
}

impl Hubs {
    /// Sets that are not empty, or come before one that is not.
    pub fn sets(&self) -> usize {
        let any = |set: &[Range<u32>; OWNERS]| set.iter().any(|r| !r.is_empty());
        self.sets.iter().rposition(any).map_or(0, |last| last + 1)
    }

    /// Calls `each(number, particles, coefficients)` for every hub.
    pub fn for_each(&self, mut each: impl FnMut(usize, &[u32], &[f32])) {
        for group in &self.groups {
            let (points, each_has) = (group.points as usize, (group.points * group.sums) as usize);
            for t in 0..group.count as usize {
                let particles = &self.particles[group.particles as usize + t * points..][..points];
                let coefficients = &self.coefficients[group.coefficients as usize + t * each_has..][..each_has];
                each(group.number as usize + t, particles, coefficients);
            }
        }
    }
}

/// How far each particle can get from where the garment hangs.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Tethers {
    /// The fixed particle nearest along the cloth; itself where nothing is fixed.
    pub anchor: Box<[u32]>,
    /// Length of the way to it as cut (m).
    pub length: Box<[f32]>,
}

/// One step down the fibers of a bundle: which particles lie there.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct BundleRow {
    /// The particle of the first fiber.
    pub first: u32,
    /// Fibers that reach so far; their particles are `first..first + lanes`.
    pub lanes: u32,
}

/// Fibers side by side, longest first.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FiberBundle {
    /// Solver of its fibers.
    pub solver: Solver,
    /// Owner (worker) that solves it.
    pub owner: u8,
    /// Number of fibers side by side.
    pub lanes: u32,
    /// Particles of its longest fiber, from the support on: a range of [`Fibers::rows`].
    pub rows: Range<u32>,
    /// Where its parameters begin: `lanes` for each link from row to row, or one where its fibers are alike.
    pub at: u32,
    /// Number of its first link among all: `lanes` for each link from row to row.
    pub serial: u32,
    /// Whether the fibers are all alike, in their links and in the masses of their particles.
    pub alike: bool,
}

/// Fibers whose particles lie contiguous, row after row.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Fibers {
    /// Bundles of all owners.
    pub bundles: Box<[FiberBundle]>,
    /// Rows of particles, bundle after bundle.
    pub rows: Box<[BundleRow]>,
    /// Links of all bundles, those that have ended among them.
    pub links: usize,
    /// Length of each link as cut (m); 0 where a fiber has ended.
    pub rest: Box<[f32]>,
    /// Inverse stiffness of each link (m/N); [`ENDED`] where a fiber has ended.
    pub compliance: Box<[f32]>,
}

/// Compliance of a link that is not there (m/N): it carries nothing, and over the square of a substep as short as a
/// microsecond it is still a number of f32 (1e30 was none from 184 substeps a step on, and rolled every step back).
pub const ENDED: f32 = 1e20;

/// Fibers of equal length by index list: hoops, and whatever crosses another fiber of its direction.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FiberList {
    /// Solver of its fibers.
    pub solver: Solver,
    /// Direction of the threads that it follows.
    pub direction: Direction,
    /// Whether the last particle is linked to the first.
    pub closed: bool,
    /// Fibers, at most [`MAX_LISTED`].
    pub lanes: u32,
    /// Particles of each fiber.
    pub rows: u32,
    /// Where its indices begin: `lanes` a row.
    pub first: u32,
    /// Where its parameters begin: `lanes` a link.
    pub at: u32,
}

impl FiberList {
    /// Links of each fiber. 0 where it has no particle, which no checked garment holds.
    pub fn links(&self) -> u32 {
        if self.closed { self.rows } else { self.rows.saturating_sub(1) }
    }
}

/// Fibers by index list, in sets within which none shares a particle.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct FiberLists {
    /// The lists, set after set.
    pub lists: Box<[FiberList]>,
    /// Sets: what each owner solves of `lists`.
    pub sets: Box<[[Range<u32>; OWNERS]]>,
    /// Indices of the particles, list after list, row after row: one for each lane.
    pub index: Box<[u32]>,
    /// Length of each link as cut (m).
    pub rest: Box<[f32]>,
    /// Inverse stiffness (m/N).
    pub compliance: Box<[f32]>,
}

/// Everything that holds a garment together.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Layout {
    /// Shear: fibers along the bias, solved directly.
    pub diagonals: Diagonals,
    /// Shear that lies in no such fiber: links along the bias, in coloured sets.
    pub shear: Links,
    /// Links along the weft, and along the warp where no fiber carries them, in coloured sets.
    pub weft: Links,
    /// Fibers along the warp.
    pub fibers: Fibers,
    /// Fibers that are solved directly by index list: warp that crosses warp, waistbands, whatever was chosen to be.
    pub crossing: FiberLists,
    /// Bending over three particles in a row.
    pub bends: Bends<3>,
    /// Bending where a fiber turns within the cloth: a fourth particle keeps flat cloth free of it.
    pub skewed: Bends<4>,
    /// Bending where the mesh is uneven: measured over whole rings.
    pub hubs: Hubs,
    /// What links do beyond one slope; none where the fabric has no numbers for it.
    pub link_curves: LinkCurves,
    /// Which of the three rub, and how much; none where the fabric has no numbers for it.
    pub friction: BendFriction,
    /// What holds the garment together when all else gives way.
    pub tethers: Tethers,
    /// The particles that each owner has, as ranges `(first, len)`.
    pub spans: [Vec<(u32, u32)>; OWNERS],
    /// Owner (worker) of each particle `[particles]`.
    pub owner: Box<[u8]>,
}

impl Layout {
    /// Links of shear and weft that lie in no row, and all of them.
    pub fn loose_links(&self) -> [usize; 2] {
        let all = [&self.shear.tuples, &self.weft.tuples];
        all.iter().fold([0, self.diagonals.count()], |[loose, all], t| [loose + t.loose.len(), all + t.count])
    }

    /// Whether most of them lie in no row: then more substeps that solve everything once are worth more than fewer that solve
    /// hoops and fibers in turn.
    pub fn is_scattered(&self) -> bool {
        let [loose, all] = self.loose_links();
        2 * loose > all
    }

    /// Calls `each(particles, coefficient)` for every sum that bends: the stencils of three, those of four, the sums of each
    /// hub; `coefficient(k)` is that of the `k`th particle (sqrt(N/m)).
    pub fn for_each_bend(&self, mut each: impl FnMut(&[u32], &dyn Fn(usize) -> f32)) {
        self.bends.tuples.for_each(|at, v| each(&v, &|k| self.bends.coefficients[k][at]));
        self.skewed.tuples.for_each(|at, v| each(&v, &|k| self.skewed.coefficients[k][at]));
        self.hubs.for_each(|_, particles, coefficients| {
            let sums = coefficients.len() / particles.len();
            (0..sums).for_each(|sum| each(particles, &|k| coefficients[k * sums + sum]));
        });
    }

    /// Bytes that a garment's constraints hold.
    pub fn bytes(&self) -> usize {
        let links = |l: &Links| {
            let Tuples { zigzags, runs, loose, .. } = &l.tuples;
            size_of_val(&**zigzags) + size_of_val(&**runs) + size_of_val(&**loose) + l.rest.len() * 8
        };
        let lists = |l: &FiberLists| l.lists.len() * size_of::<FiberList>() + l.index.len() * 4 + l.rest.len() * 8;
        fn bends<const K: usize>(b: &Bends<K>) -> usize {
            b.tuples.runs.len() * size_of::<ConstraintRun<K>>()
                + b.tuples.loose.len() * 4 * K
                + b.coefficients[0].len() * 4 * K
        }
        self.diagonals.bytes()
            + links(&self.shear)
            + links(&self.weft)
            + self.fibers.rows.len() * size_of::<BundleRow>()
            + self.fibers.rest.len() * 8
            + lists(&self.crossing)
            + bends(&self.bends)
            + bends(&self.skewed)
            + 4 * (self.hubs.particles.len() + self.hubs.coefficients.len())
            + size_of_val(&*self.hubs.groups)
            + self.friction.bytes()
            + self.link_curves.bytes()
            + self.tethers.anchor.len() * 8
            + self.owner.len()
            + self.spans.iter().map(Vec::len).sum::<usize>() * 8
    }
}
