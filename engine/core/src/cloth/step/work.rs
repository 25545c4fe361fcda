//! The stages of a step: the work of each on one owner's share of a garment.
//!
//! [`OwnerShare::run`] is the list of all stages; their order is [`program`](super::program)'s. A stage has two shares, one for
//! each owner of particles, which may run at once; all of a stage is over before any of the next begins. Debug builds check that.

use std::sync::atomic::AtomicU64;
use std::sync::atomic::Ordering::Relaxed;

use glam::Vec3A;
use toile_base::garment::Garment;
use toile_base::garment::layout::{FiberLists, Layout, Links, OWNERS};
use toile_base::numeric::portable;

use super::prepared::Prepared;
use super::program::Stage;
use super::settle;
use crate::cloth::forces::root::Carried;
use crate::cloth::links::link_curves::{self, CurveColumns, CurveGain, FollowCurves};
use crate::cloth::links::link_gain::Passes;
use crate::cloth::links::record_links::RecordLinks;
use crate::cloth::links::{LinkColumns, LinkGains};
use crate::cloth::state::pins::Pins;
use crate::cloth::state::{self, ParticleColumns};
use crate::cloth::{
    Quality, Step, Wind, contact,
    forces::{bend_friction, bending, predict, stiff_bending, wind},
    links::{self, diagonals, fibers, lists, record_links, records, tethers},
};
use crate::lanes::{ReadColumn, Shared, Width, WriteColumn};
use crate::workers::{PerShare, PhaseCheck};

/// Everything that the shares of one step have in common.
pub struct StepWork<'a> {
    /// The garment that is stepped.
    pub garment: &'a Garment,
    /// What surrounds the garment in this step.
    pub step: &'a Step<'a>,
    /// What was prepared for the settings.
    pub prepared: &'a Prepared,
    /// Columns that the shares write to.
    pub columns: Shared<WorkColumns<'a>>,
    /// The triangles that feel the wind, and the wind.
    pub faces: Option<(&'a wind::Faces, Wind)>,
    /// What of the root's motion the cloth is not to feel.
    pub carried: Option<Carried>,
    /// The contact of each owner's particles.
    pub contacts: PerShare<'a, contact::body::OwnerContacts>,
    /// Particle substeps that each owner held at the speed limit.
    pub limited: [AtomicU64; OWNERS],
    /// Skinned particles at the start and the end of the step.
    pub pins: &'a Pins,
    /// Gravity over the substep (m/s).
    pub gravity_step: Vec3A,
    /// Share of a velocity that damping leaves in a substep (1).
    pub damping_factor: f32,
    /// Lanes that the kernels run on.
    pub width: Width,
    /// Finds shares that do not keep to the program.
    pub check: PhaseCheck,
}

/// The columns of a step.
#[derive(Clone, Copy)]
pub struct WorkColumns<'a> {
    /// State of the particles.
    pub particles: ParticleColumns<'a>,
    /// Accelerations besides gravity (m/s2).
    pub acceleration: [WriteColumn<'a>; 3],
    /// Tensions of weft links, of fibers, of crossing fibers so far in the substep; empty where they have no compliance.
    pub tension: [WriteColumn<'a>; 3],
    /// Scratch of each owner.
    pub scratch: [WriteColumn<'a>; OWNERS],
    /// Records of the particles; empty where nothing reads any.
    pub records: WriteColumn<'a>,
    /// Scratch of stiff bending; empty where there is none.
    pub scratch_columns: [[WriteColumn<'a>; 3]; 3],
    /// What bending remembers by friction; empty where nothing rubs.
    pub friction: bend_friction::FrictionColumns<'a>,
    /// Stretch curves of links; empty where one slope is all.
    pub link_curves: [CurveColumns<'a>; link_curves::KINDS],
    /// Scratch of what is solved along the bias.
    pub bias_scratch: [WriteColumn<'a>; diagonals::KEPT],
}

/// One owner's share of one stage.
struct OwnerShare<'w, 'a> {
    work: &'w StepWork<'a>,
    columns: WorkColumns<'a>,
    owner: usize,
    substep: u32,
}

impl StepWork<'_> {
    /// Does one owner's share of a phase of the program.
    ///
    /// # Safety
    /// The cloth was made of `garment`. The phases are done in the order of the program, each owner's share of each once. All shares of
    /// earlier phases happened before this call, and no share of a later phase begins before its end. At most the other owner's share of
    /// this phase runs meanwhile.
    pub unsafe fn run(&self, phase: usize, owner: usize) {
        let _running = self.check.begin(phase, owner);
        let (stage, substep) = self.prepared.program.stage(phase);
        // SAFETY: the caller keeps the stages apart, so earlier writes are seen. Within a stage no owner touches what the other writes:
        // - the ranges of `Layout::spans` hold each particle once (wind, root motion, prediction, contact, velocities, tethers, records
        //   filled and read back, and turns of stiff bending write nothing else; a tether reads anchors, which are not written);
        // - a row of the bending matrix is its particle's owner's, and what bends is not what is pushed; a slot of friction is the
        //   owner's of the particle in its middle, a row that it pushes its own particle's;
        // - the curves of links write to columns of their places, of which each is one owner's, and only read particles;
        // - constraints of one set and different owners share no particle (`garment::layout`), and each has its own tension; links by
        //   records fill up with one spare record an owner;
        // - each owner has a scratch of its own, and half of the tensions to clear.
        // `Garment::new` checks spans, anchors, sets and places, and the caller knows that the columns are of this garment.
        let columns = unsafe { self.columns.open() };
        OwnerShare { work: self, columns, owner, substep }.run(stage);
    }

    /// Particle substeps that were held at the speed limit.
    pub fn limited(&self) -> u64 {
        self.limited.iter().map(|l| l.load(Relaxed)).sum()
    }

    fn layout(&self) -> &Layout {
        self.garment.layout()
    }

    fn contact_settings(&self) -> contact::body::ContactSettings {
        contact::body::ContactSettings::new(&self.garment.fabric, self.step.settings)
    }
}

impl OwnerShare<'_, '_> {
    /// Runs this owner's share of a stage.
    fn run(&self, stage: Stage) {
        match stage {
            Stage::BroadPhase => self.broad_phase(),
            Stage::Wind => self.wind([wind::WindPart::First, wind::WindPart::Second][self.owner]),
            Stage::WindAcross => self.wind_across(),
            Stage::RootMotion => self.root_motion(),
            Stage::BendingRecords => self.bending_records(),
            Stage::Bending => self.bending(),
            Stage::FrictionMoments => self.friction_moments(),
            Stage::FrictionForces => self.friction_forces(),
            Stage::StiffBendingTurn(stage) => self.stiff_bending_turn(stage),
            Stage::StiffBendingRecords(stage) => self.fill_records(self.stiffly_bent(stage)[0]),
            Stage::StiffBending(stage) => self.stiff_bending(stage),
            Stage::LinkCurves => self.link_curves(),
            Stage::Predict => self.predict(),
            Stage::Diagonals(family) => self.diagonals(family),
            Stage::EnterRecords => self.fill_records(self.columns.particles.x),
            Stage::LeaveRecords => self.read_records(),
            Stage::Shear(set) => self.shear(set),
            Stage::Weft(set) => self.weft(set),
            Stage::Fibers => self.fibers(),
            Stage::Crossing(set) => self.crossing(set),
            Stage::Tethers => self.tethers(),
            Stage::ContactAndVelocities => {
                self.contact();
                self.velocities();
            }
        }
    }

    /// What contact may meet in this step.
    fn broad_phase(&self) {
        let (work, how) = (self.work, self.work.contact_settings());
        let particles = self.columns.particles;
        work.contacts.with(self.owner, |own| own.find(work.width, particles, work.step.colliders, &how));
    }

    /// The wind of the whole step, as accelerations.
    fn wind(&self, part: wind::WindPart) {
        let (work, c) = (self.work, &self.columns);
        if let Some((faces, wind)) = work.faces {
            faces.blow(work.width, part, &wind, work.step.settings.step_seconds, c.particles, c.acceleration);
        }
    }

    /// The triangles that cross the owners: the first owner's alone.
    fn wind_across(&self) {
        if self.owner == 0 {
            self.wind(wind::WindPart::Crossing);
        }
    }

    /// What of the root's motion the cloth is not to feel, beside the wind.
    fn root_motion(&self) {
        let (work, c) = (self.work, &self.columns);
        let Some(carried) = work.carried else { return };
        for &span in &work.layout().spans[self.owner] {
            if work.faces.is_none() {
                for i in span.0..span.0 + span.1 {
                    state::set(c.acceleration, i as usize, Vec3A::ZERO);
                }
            }
            carried.apply(work.width, c.particles, span, c.acceleration);
        }
    }

    /// Records of the places, where bending acts in this substep.
    fn bending_records(&self) {
        if self.substep.is_multiple_of(self.work.prepared.bend.every) {
            self.fill_records(self.columns.particles.x);
        }
    }

    /// Records of what bends.
    fn fill_records(&self, from: [WriteColumn<'_>; 3]) {
        let (w, records) = (self.columns.particles.w, self.columns.records);
        let spans = &self.work.layout().spans[self.owner];
        self.work.width.run(records::FillRecords { from, w, spans, records });
    }

    /// Places from their records.
    fn read_records(&self) {
        let (columns, records) = (self.columns.particles, self.columns.records);
        let spans = &self.work.layout().spans[self.owner];
        self.work.width.run(records::ReadRecords { columns, spans, records });
    }

    /// Bending as a force.
    fn bending(&self) {
        let (p, particles) = (self.work.prepared, self.columns.particles);
        if self.substep.is_multiple_of(p.bend.every) {
            self.bend([particles.x, particles.v], p.dt * p.bend.every as f32);
        }
    }

    /// Whether friction in bending acts in this substep.
    fn rubs(&self) -> bool {
        self.substep.is_multiple_of(self.work.prepared.friction.every)
    }

    /// What friction keeps of what is bent.
    fn friction_moments(&self) {
        if self.rubs() {
            let (friction, from) = (&self.work.prepared.friction, self.columns.particles.x);
            let (owner, state, turns) = (self.owner, self.columns.friction, self.substep.is_multiple_of(2));
            self.work.width.run(bend_friction::FrictionMoments { friction, owner, from, state, turns });
        }
    }

    /// It pushes the velocities, or what is to become their change where bending goes in stages.
    fn friction_forces(&self) {
        let p = self.work.prepared;
        if self.rubs() {
            let to = if p.bending.stages > 1 { self.columns.scratch_columns[0] } else { self.columns.particles.v };
            let (kept, by) = (self.columns.friction.kept, p.dt * p.friction.every as f32);
            self.work.width.run(bend_friction::FrictionForces {
                friction: &p.friction,
                owner: self.owner,
                kept,
                to,
                by,
            });
        }
    }

    /// What bends in a stage of stiff bending, and what is pushed.
    fn stiffly_bent(&self, stage: u32) -> [[WriteColumn<'_>; 3]; 2] {
        let scratch_columns = self.columns.scratch_columns;
        if stage == 0 {
            [scratch_columns[1], scratch_columns[0]]
        } else {
            [stage, stage + 1].map(|j| scratch_columns[stiff_bending::place(j)])
        }
    }

    /// The forces of a stage of stiff bending.
    fn stiff_bending(&self, stage: u32) {
        let p = self.work.prepared;
        let by = if stage == 0 { p.dt } else { p.stages[stage as usize].forced * p.dt * p.dt };
        self.bend(self.stiffly_bent(stage), by);
    }

    /// What comes before the forces of a stage of stiff bending, or behind the last.
    fn stiff_bending_turn(&self, stage: u32) {
        let (work, p) = (self.work, self.work.prepared);
        let turn = match stage {
            0 => stiff_bending::StiffBendingUpdate::Begin {
                gravity_step: work.gravity_step,
                acceleration: self.acceleration().map(|(by, _)| by),
                dt: p.dt,
            },
            last if last == p.bending.stages => stiff_bending::StiffBendingUpdate::End(last),
            1 => stiff_bending::StiffBendingUpdate::First([p.stages[0], p.stages[1]]),
            later => stiff_bending::StiffBendingUpdate::Next(later + 1, p.stages[later as usize]),
        };
        let (columns, scratch_columns) = (self.columns.particles, self.columns.scratch_columns);
        work.width.run(stiff_bending::ApplyStiffBending {
            columns,
            spans: &work.layout().spans[self.owner],
            scratch_columns,
            turn,
        });
    }

    /// What links are in this substep.
    fn link_curves(&self) {
        let (work, p) = (self.work, self.work.prepared);
        let layout = work.layout();
        let gain = |passes| Some(CurveGain { damped: 1.0 + p.gamma, passes });
        let baked = [
            [&layout.diagonals.rest, &layout.diagonals.compliance],
            [&layout.shear.rest, &layout.shear.compliance],
            [&layout.weft.rest, &layout.weft.compliance],
            [&layout.fibers.rest, &layout.fibers.compliance],
            [&layout.crossing.rest, &layout.crossing.compliance],
        ];
        let gains = [None, gain(Passes::Once), gain(Passes::Many), None, None];
        for (kind, table) in layout.link_curves.tables().into_iter().enumerate().filter(|(_, t)| !t.is_empty()) {
            work.width.run(FollowCurves {
                columns: self.columns.particles,
                rows: &p.link_curves[kind],
                owner: self.owner,
                table,
                baked: baked[kind].map(|c| &**c),
                to: self.columns.link_curves[kind],
                per_dt2: (p.dt * p.dt).recip(),
                gain: gains[kind],
            });
        }
    }

    /// Rest length and compliance of links of a kind, as baked or as their curves have them.
    fn parameters<'b>(&'b self, kind: usize, baked: [&'b [f32]; 2]) -> [ReadColumn<'b>; 2] {
        let link_curve = self.columns.link_curves[kind];
        if self.work.layout().link_curves.tables()[kind].is_empty() {
            baked.map(ReadColumn::new)
        } else {
            [link_curve.rest, link_curve.compliance].map(WriteColumn::to_read)
        }
    }

    /// Gravity, air, wind; skinned particles move on.
    fn predict(&self) {
        let (work, p, columns) = (self.work, self.work.prepared, self.columns.particles);
        // Half of the tensions each: they start from none in every substep.
        for tension in self.columns.tension {
            let half = tension.len().div_ceil(OWNERS);
            let from = self.owner * half;
            (from..(from + half).min(tension.len())).for_each(|i| tension.set(i, 0.0));
        }
        let spans = &work.layout().spans[self.owner];
        // Stages have accelerated everything already.
        let (gravity_step, acceleration) =
            if p.bending.stages > 1 { (Vec3A::ZERO, None) } else { (work.gravity_step, self.acceleration()) };
        work.width.run(predict::Predict {
            columns,
            spans,
            gravity_step,
            acceleration,
            damping_factor: work.damping_factor,
            dt: p.dt,
        });
        let to = (self.substep + 1) as f32 / p.substeps as f32;
        for run in work.pins.runs().iter().filter(|run| usize::from(run.owner) == self.owner) {
            let range = run.number as usize..(run.number + run.len) as usize;
            let places = work.pins.start[range.clone()].iter().zip(&work.pins.end[range]);
            for (i, (start, end)) in (run.first as usize..).zip(places) {
                state::set(columns.x, i, portable::lerp(*start, *end, to));
            }
        }
    }

    /// A family of fibers along the bias, solved directly.
    fn diagonals(&self, family: u16) {
        let (work, p, diagonals) = (self.work, self.work.prepared, &self.work.layout().diagonals);
        if !self.substep.is_multiple_of(p.shear_every) {
            return;
        }
        let strand = &diagonals.families[usize::from(family)][self.owner];
        let per_dt2 = (p.dt * p.dt).recip() / p.shear_every as f32;
        let (columns, scratch_columns, gamma) = (self.columns.particles, self.columns.bias_scratch, p.gamma);
        let links = self.parameters(0, [&diagonals.rest, &diagonals.compliance]);
        work.width.run(diagonals::SolveDiagonals {
            columns,
            diagonals,
            links,
            strand,
            scratch_columns,
            per_dt2,
            gamma,
        });
    }

    /// A set of shear links.
    fn shear(&self, set: u16) {
        let p = self.work.prepared;
        match p.records(0) {
            Some(links) => self.record_links(links, set, None),
            None => self.links(&self.work.layout().shear, &p.shear, link_curves::SHEAR, set, None),
        }
    }

    /// A set of weft links.
    fn weft(&self, set: u16) {
        let p = self.work.prepared;
        let tension = self.tension(0).map(|t| (t, (p.dt * p.dt).recip()));
        match p.records(1) {
            Some(links) => self.record_links(links, set, tension),
            None => self.links(&self.work.layout().weft, &p.weft, link_curves::WEFT, set, tension),
        }
    }

    /// Warp fibers, each solved directly.
    fn fibers(&self) {
        let (work, p) = (self.work, self.work.prepared);
        let fibers = &work.layout().fibers;
        work.width.run(fibers::SolveFibers {
            columns: self.columns.particles,
            fibers,
            links: self.parameters(link_curves::FIBERS, [&fibers.rest, &fibers.compliance]),
            least: (!work.layout().link_curves.fibers.is_empty())
                .then(|| self.columns.link_curves[link_curves::FIBERS].least.to_read()),
            owner: self.owner,
            scratch: self.columns.scratch[self.owner],
            per_dt2: (p.dt * p.dt).recip(),
            gamma: p.gamma,
            taut: p.taut,
            tension: self.tension(1),
        });
    }

    /// A set of warp fibers that cross others.
    fn crossing(&self, set: u16) {
        let (work, p) = (self.work, self.work.prepared);
        let lists: &FiberLists = &work.layout().crossing;
        work.width.run(lists::SolveCrossing {
            columns: self.columns.particles,
            lists,
            links: self.parameters(link_curves::CROSSING, [&lists.rest, &lists.compliance]),
            set: usize::from(set),
            owner: self.owner,
            scratch: self.columns.scratch[self.owner],
            per_dt2: (p.dt * p.dt).recip(),
            tension: self.tension(2),
        });
    }

    /// What strays from its anchor is drawn back.
    fn tethers(&self) {
        let (work, layout) = (self.work, self.work.layout());
        if work.step.settings.tethers || work.prepared.quality == Quality::Draft {
            let (columns, spans) = (self.columns.particles, &layout.spans[self.owner]);
            work.width.run(tethers::HoldTethers { columns, tethers: &layout.tethers, spans });
        }
    }

    /// Contact with the body, the floor and other planes.
    fn contact(&self) {
        let (work, how) = (self.work, self.work.contact_settings());
        let span = [self.substep, self.substep + 1].map(|s| s as f32 / work.prepared.substeps as f32);
        let particles = self.columns.particles;
        work.contacts.with(self.owner, |own| own.solve(work.width, particles, span, &how));
    }

    /// New velocities from the way of the substep, within the speed limit.
    fn velocities(&self) {
        let (work, columns) = (self.work, self.columns.particles);
        let (spans, max_speed) = (&work.layout().spans[self.owner], work.step.settings.max_speed);
        let held = work.width.run(settle::Settle { columns, spans, max_speed, dt: work.prepared.dt });
        // Relaxed: a counter that one share adds to and that is read when all is done.
        work.limited[self.owner].fetch_add(u64::from(held), Relaxed);
    }

    /// A set of links of one kind.
    fn links(&self, links: &Links, gains: &LinkGains, kind: usize, set: u16, tension: Option<(WriteColumn<'_>, f32)>) {
        let (columns, owner, gamma) = (self.columns.particles, self.owner, self.work.prepared.gamma);
        let set = &links.tuples.sets[usize::from(set)];
        let parameters = if self.work.layout().link_curves.tables()[kind].is_empty() {
            LinkColumns::baked(links, gains, gamma > 0.0 || tension.is_some())
        } else {
            LinkColumns::curved(self.columns.link_curves[kind])
        };
        self.work.width.run(links::SolveLinks { columns, links, parameters, set, owner, gamma, tension });
    }

    /// A set of links by records.
    fn record_links(&self, links: &RecordLinks, set: u16, tension: Option<(WriteColumn<'_>, f32)>) {
        let (owner, records) = (self.owner, self.columns.records);
        self.work.width.run(record_links::SolveRecordLinks { links, set: set.into(), owner, records, tension });
    }

    /// Tensions of weft links (0), fibers (1), crossing fibers (2), where these have any compliance.
    fn tension(&self, kind: usize) -> Option<WriteColumn<'_>> {
        self.work.prepared.soft[kind].then_some(self.columns.tension[kind])
    }

    /// What accelerates the particles besides gravity, and the substep (s).
    fn acceleration(&self) -> Option<([WriteColumn<'_>; 3], f32)> {
        let work = self.work;
        (work.faces.is_some() || work.carried.is_some()).then_some((self.columns.acceleration, work.prepared.dt))
    }

    /// One thing bends and pushes another.
    fn bend(&self, [from, to]: [[WriteColumn<'_>; 3]; 2], by: f32) {
        let (matrix, records) = (&self.work.prepared.matrix, self.columns.records);
        self.work.width.run(bending::Bend { matrix, owner: self.owner, from, records, to, by });
    }
}
