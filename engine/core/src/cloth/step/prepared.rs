//! Data that depends on the settings: gains, the choice of program, the pace of bending.
//!
//! Made again in steps in which the settings have changed; the storage stays.

use toile_base::garment::Garment;
use toile_base::garment::layout::{ENDED, Layout};
use toile_base::limits::STEP_SECONDS;

use super::program::{Bending, Program};
use crate::cloth::forces::bending_matrix::BendingMatrix;
use crate::cloth::forces::friction_rows::{FrictionRows, STICKING};
use crate::cloth::forces::stiff_bending::{self, ChebyshevStage};
use crate::cloth::links::LinkGains;
use crate::cloth::links::link_curves::{self, CurveRows};
use crate::cloth::links::link_gain::Passes;
use crate::cloth::links::record_links::RecordLinks;
use crate::cloth::{Quality, Settings, forces::bending, links::fibers};

/// Pull across a fiber's links from which on its solves are calmed. Garments in the substeps that they ask for are below
/// 1: a linearised solve is stable there, and calming would slow their swing.
const TAUT: f32 = 1.0;

/// One particle in so many may ask for more of bending than the others get.
const NEEDLES: usize = 50;

/// What depends on the settings, made again when they change; the storage stays.
#[derive(Debug, Clone)]
pub struct Prepared {
    /// Substeps, their length (s), damping time: what the figures below were made for.
    made_for: Option<(Quality, u32, f32, f32)>,
    /// The stages of a step.
    pub program: Program,
    /// The quality last asked for.
    pub quality: Quality,
    /// Substeps of a step.
    pub substeps: u32,
    /// Length of a substep (s).
    pub dt: f32,
    /// Damping time of stretch over the substep (1).
    pub gamma: f32,
    /// Whether fibers pull more across themselves than one linearised solve can take.
    pub taut: bool,
    /// Shear along whole fibers acts every so many substeps, for all of them.
    pub shear_every: u32,
    /// Of the shear links.
    pub shear: LinkGains,
    /// Of the weft links.
    pub weft: LinkGains,
    /// Shear and weft links as records, where that is the faster form.
    records: [Option<RecordLinks>; 2],
    /// Bending of the garment, as much of it as the substep carries.
    pub matrix: BendingMatrix,
    /// Friction in bending of the garment.
    pub friction: FrictionRows,
    /// Links that have curves, by kind.
    pub link_curves: [CurveRows; link_curves::KINDS],
    /// How bending goes on.
    pub bend: bending::BendingPace,
    /// Bending's phases of a substep, and its stages where it is stiff.
    pub bending: Bending,
    /// The stages of stiff bending; as many as `bending` says count.
    pub stages: [ChebyshevStage; stiff_bending::MAX_BENDING_STAGES as usize],
    /// Whether there is room for stages.
    stiff: bool,
    load: Box<[f32]>,
    /// Whether weft links, fibers, crossing fibers have any compliance.
    pub soft: [bool; 3],
}

impl Prepared {
    /// Storage for a garment; nothing is prepared yet. At load.
    pub fn new(garment: &Garment) -> Self {
        let layout = garment.layout();
        let zeros = |n: usize| vec![0.0; n].into_boxed_slice();
        let mut load = zeros(garment.start.len());
        let longest = STEP_SECONDS / Quality::Draft.substeps(garment.substeps) as f32;
        bending::add_load(layout, &garment.inverse_mass, longest, &mut load);
        let stiff = load.iter().any(|l| *l > bending::STABLE);
        let matrix = BendingMatrix::new(garment);
        let friction = FrictionRows::new(garment);
        let bending = Bending { friction: friction.acts(), ..Bending::plain(&matrix) };
        Self {
            made_for: None,
            program: Program::new(layout, bending, stiff),
            quality: Quality::default(),
            substeps: 1,
            dt: 0.0,
            gamma: 0.0,
            taut: false,
            shear_every: 1,
            shear: LinkGains::new(&layout.shear),
            weft: LinkGains::new(&layout.weft),
            // Records hold baked values, which curves change in each substep.
            records: [(&layout.shear, &layout.link_curves.shear), (&layout.weft, &layout.link_curves.weft)]
                .map(|(l, link_curves)| RecordLinks::of(l, &garment.inverse_mass).filter(|_| link_curves.is_empty())),
            matrix,
            friction,
            link_curves: CurveRows::of(garment),
            bend: bending::BendingPace { every: 1, stages: 1, least: 1.0, friction_every: 1, sticking: STICKING },
            bending,
            stages: [ChebyshevStage::default(); stiff_bending::MAX_BENDING_STAGES as usize],
            stiff,
            load,
            soft: [
                (&layout.weft.compliance, &layout.link_curves.weft),
                (&layout.fibers.compliance, &layout.link_curves.fibers),
                (&layout.crossing.compliance, &layout.link_curves.crossing),
            ]
            .map(|(compliance, link_curves)| !link_curves.is_empty() || soft(compliance)),
        }
    }

    /// Prepares for some settings. Allocates nothing; a microsecond a hundred constraints, in steps in which the settings have changed.
    pub fn make(&mut self, garment: &Garment, settings: &Settings) {
        let asked = settings.substeps_of(garment.substeps);
        self.quality = settings.quality;
        self.make_for(garment, settings, asked);
        let records = [0, 1].map(|kind| self.records(kind).is_some());
        self.program.make(self.quality, self.bending, records, self.substeps);
    }

    fn make_for(&mut self, garment: &Garment, settings: &Settings, asked: u32) {
        let made_for = (self.quality, asked, settings.step_seconds, settings.stretch_damping_s);
        if self.made_for == Some(made_for) {
            return;
        }
        self.made_for = Some(made_for);
        self.substeps = asked;
        self.dt = settings.step_seconds / asked as f32;
        self.gamma = settings.stretch_damping_s / self.dt;
        let half = asked.is_multiple_of(2) && self.quality != Quality::Fine && self.gamma == 0.0;
        self.shear_every = if half { 2 } else { 1 };
        self.taut = fibers::pull_across(&garment.layout().fibers, &garment.inverse_mass, self.dt) > TAUT;
        let (layout, w) = (garment.layout(), &garment.inverse_mass);
        self.shear.prepare(&layout.shear, w, [self.dt, self.gamma], Passes::Once);
        self.weft.prepare(&layout.weft, w, [self.dt, self.gamma], Passes::Many);
        let [shear, weft] = &mut self.records;
        shear.iter_mut().for_each(|r| r.prepare(&layout.shear, &self.shear, false));
        weft.iter_mut().for_each(|r| r.prepare(&layout.weft, &self.weft, self.soft[0]));
        self.bend(garment);
    }

    /// How bending goes on with this substep: as a force, in stages, or weakened.
    fn bend(&mut self, garment: &Garment) {
        self.load.fill(0.0);
        bending::add_load(garment.layout(), &garment.inverse_mass, self.dt, &mut self.load);
        // A few needles of a mesh do not decide for all of it: they are weakened.
        let few = self.load.len() / NEEDLES;
        let carries = |limit: f32| self.load.iter().filter(|l| **l > limit).count() <= few;
        // Links that are pressed push sideways by where particles are about to be. A plain force of bending acts by where they were,
        // and beside it a mode grows by dt k_g / 2 a second, with k_g what the pressure is worth in it (1/s2); a stage acts by where
        // they are about to be, and damps the mode by dt k_b / 2, which is more as long as it is stable. A column clamped at
        // both ends stood two fifths of its load in 39 plain substeps; `fine` has to be right more than fast.
        let plain = !self.stiff || (self.quality != Quality::Fine && carries(bending::STABLE));
        let stages = if plain { 1 } else { stiff_bending::needed(carries) };
        let limit = if stages > 1 { stiff_bending::carried(stages) } else { bending::STABLE };
        if stages > 1 {
            stiff_bending::coefficients(stages, &mut self.stages);
        }
        let least = self.matrix.fill(garment, &self.load, limit);
        self.bending.stages = stages;
        let every = bending::every(&self.load, self.substeps);
        let sticking = self.friction.prepare(garment, self.dt, self.substeps, &mut self.load);
        let friction_every = self.friction.every;
        self.bend = bending::BendingPace { every, stages, least, friction_every, sticking };
    }

    /// Shear (0) and weft links (1) as records, where that is the faster form and nothing damps them: damping asks where the
    /// particles were, which records do not hold.
    pub fn records(&self, kind: usize) -> Option<&RecordLinks> {
        self.records[kind].as_ref().filter(|_| self.gamma == 0.0)
    }

    /// Whether anything may read records.
    pub fn reads_records(&self) -> bool {
        self.matrix.reads_records() || self.records.iter().any(Option::is_some)
    }

    /// Tensions that are kept of weft links (0), fibers (1), crossing fibers (2).
    pub fn tensions(&self, layout: &Layout) -> [usize; 3] {
        let records = self.records[1].as_ref().map_or(0, RecordLinks::len);
        let counts = [layout.weft.tuples.count.max(records), layout.fibers.links, layout.crossing.rest.len()];
        std::array::from_fn(|kind| if self.soft[kind] { counts[kind] } else { 0 })
    }

    /// How bending goes on.
    pub fn bend_pace(&self) -> bending::BendingPace {
        self.bend
    }

    /// Whether bending may have to go in stages.
    pub fn stiff(&self) -> bool {
        self.stiff
    }

    /// Substeps of a step.
    pub fn substeps(&self) -> u32 {
        self.substeps
    }

    /// Bytes held, but for those of the programs.
    pub fn bytes(&self) -> usize {
        4 * self.load.len()
            + self.shear.bytes()
            + self.weft.bytes()
            + self.matrix.bytes()
            + self.friction.bytes()
            + self.link_curves.iter().map(CurveRows::bytes).sum::<usize>()
            + self.records.iter().flatten().map(RecordLinks::bytes).sum::<usize>()
    }
}

/// Whether any of some links gives: a millimetre under a thousand newtons and more.
fn soft(compliance: &[f32]) -> bool {
    compliance.iter().any(|c| (1e-6..ENDED).contains(c))
}
