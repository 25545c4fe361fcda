//! Work of each worker in each phase of a step of several garments.
//!
//! A barrier of the workers stands between two phases. Within a phase a worker alone writes its data. Particles belong to the worker
//! of their owner's share, or of their garment if one worker owns it whole. Contacts belong to the worker of their half of the
//! particles. Pushes of contacts on particles belong to the worker of one half of the touched particles.
//!
//! Debug builds check that the shares keep to the order of the phases, and that each phase uses only the data that it may use.

use std::marker::PhantomData;
use std::sync::atomic::AtomicU64;
use std::sync::atomic::Ordering::Relaxed;
use std::time::Instant;

use toile_base::garment::layout::OWNERS;
use toile_base::limits::MAX_GARMENTS;

use super::bearing::{Bearing, GarmentBearing, give_way};
use super::contact::{Resting, VERTICES};
use super::contact_list::ContactList;
use super::garment_surface::{GarmentMotion, GarmentSurface};
use super::pace::{PairPace, Search};
use super::pair::{GarmentPair, PairScene, Wearing};
use super::pair_share::PairShare;
use super::phases::{LayerPhase, LayerPhases};
use super::touch::TouchLists;
use super::turns::{Turn, Turns};
use crate::cloth::state::ParticleColumns;
use crate::cloth::step::program::{BEFORE, LAYERS_METERED, METERED_STAGES};
use crate::cloth::step::work::StepWork;
use crate::lanes::Width;
use crate::workers::PhaseCheck;

/// Things of which each belongs to one worker at a time.
struct Cells<'a, T> {
    data: *mut T,
    len: usize,
    owner: PhantomData<&'a mut [T]>,
}

// SAFETY: a shared reference gives out `&mut T` and `&T` through unsafe functions only, whose callers keep threads apart. `T` may be
// sent to other threads and shared with them.
unsafe impl<T: Send + Sync> Sync for Cells<'_, T> {}

impl<'a, T> Cells<'a, T> {
    fn new(items: &'a mut [T]) -> Self {
        Self { data: items.as_mut_ptr(), len: items.len(), owner: PhantomData }
    }

    /// # Safety
    /// Until the next barrier, no other thread reads or writes the item. While the result is used, this thread makes no other
    /// reference to the item.
    #[expect(clippy::mut_from_ref, reason = "each item is one worker's")]
    unsafe fn own(&self, i: usize) -> &mut T {
        assert!(i < self.len, "there is no such item");
        // SAFETY: `i` was compared with the length of the slice, which `new` borrowed for 'a. The caller makes no other reference to
        // the item meanwhile.
        unsafe { &mut *self.data.add(i) }
    }

    /// # Safety
    /// Until the next barrier, no other thread reads or writes any of them. While the result is used, this thread makes no other
    /// reference to one of them.
    #[expect(clippy::mut_from_ref, reason = "all are one worker's")]
    unsafe fn own_all(&self) -> &mut [T] {
        // SAFETY: pointer and length are those of the slice that `new` borrowed for 'a. The caller makes no other reference to its
        // items meanwhile.
        unsafe { std::slice::from_raw_parts_mut(self.data, self.len) }
    }

    /// # Safety
    /// Until the next barrier, no thread writes the item or holds a result of [`Self::own`] for it.
    unsafe fn read(&self, i: usize) -> &T {
        assert!(i < self.len, "there is no such item");
        // SAFETY: `i` was compared with the length of the slice, which `new` borrowed for 'a. The caller sees to it that no thread
        // writes the item meanwhile.
        unsafe { &*self.data.add(i) }
    }
}

/// Everything that the phases of a step share.
pub struct LayerWork<'a> {
    works: &'a [StepWork<'a>],
    surfaces: &'a [GarmentSurface],
    pairs: &'a [GarmentPair],
    paces: &'a [PairPace],
    worker: &'a [usize],
    turns: Turns,
    motions: Cells<'a, GarmentMotion>,
    shares: Cells<'a, PairShare>,
    touching: Cells<'a, TouchLists>,
    resting: heapless::Vec<Cells<'a, Resting>, MAX_GARMENTS>,
    bearing: heapless::Vec<Cells<'a, Bearing>, MAX_GARMENTS>,
    phases: LayerPhases,
    /// Time of the stages of all garments (ns), where they are timed.
    times: [AtomicU64; METERED_STAGES.len()],
    /// Finds shares that do not keep to the order of the phases.
    check: PhaseCheck,
}

/// What of the layers a step works on.
pub struct LayerParts<'a> {
    /// Surfaces of the garments.
    pub surfaces: &'a [GarmentSurface],
    /// The pairs.
    pub pairs: &'a [GarmentPair],
    /// What this step does to find the contacts of each.
    pub paces: &'a [PairPace],
    /// Who steps which garment.
    pub worker: &'a [usize],
    /// The turns of a substep.
    pub turns: Turns,
    /// Motions of the garments.
    pub motions: &'a mut [GarmentMotion],
    /// Shares of the pairs.
    pub shares: &'a mut [PairShare],
    /// Touches of the garments.
    pub touching: &'a mut [TouchLists],
    /// What holds their particles, and what these bear.
    pub bearing: &'a mut [GarmentBearing],
}

impl<'a> LayerWork<'a> {
    /// The work of a step.
    pub fn new(works: &'a [StepWork<'a>], parts: LayerParts<'a>, substeps: usize) -> Self {
        let LayerParts { surfaces, pairs, paces, worker, turns, motions, shares, touching, bearing } = parts;
        let shared = (0..works.len()).filter(|&g| is_shared(&works[g])).map(|g| (g, last_stage(&works[g]))).collect();
        let whole = works.iter().any(|work| !is_shared(work));
        let phases = LayerPhases { shared, whole, turns: turns.count(), substeps };
        let (motions, shares, touching) = (Cells::new(motions), Cells::new(shares), Cells::new(touching));
        let (resting, bearing) =
            bearing.iter_mut().map(|b| (Cells::new(&mut b.resting), Cells::new(&mut b.bearing))).unzip();
        Self {
            works,
            surfaces,
            pairs,
            paces,
            worker,
            turns,
            motions,
            shares,
            touching,
            resting,
            bearing,
            phases,
            times: Default::default(),
            check: PhaseCheck::default(),
        }
    }

    /// Time of the stages of all garments (ns), where they are timed.
    pub fn times(&self) -> [u64; METERED_STAGES.len()] {
        self.times.each_ref().map(|t| t.load(Relaxed))
    }

    /// Number of phases of the step.
    pub fn phases(&self) -> usize {
        self.phases.count()
    }

    /// Does one worker's share of a phase.
    ///
    /// # Safety
    /// The layers and the cloths were made of the garments of this step. The phases are done in their order, from 0 to [`Self::phases`],
    /// and each share of a phase is done once. All shares of earlier phases happened before this call, and no share of a later phase
    /// begins before its end.
    pub unsafe fn run(&self, phase: usize, share: usize) {
        let _running = self.check.begin(phase, share);
        LayerShare { work: self, phase: self.phases.at(phase), share }.run();
    }
}

/// Whether both workers own particles of a garment.
fn is_shared(work: &StepWork<'_>) -> bool {
    !work.garment.layout().spans[1].is_empty()
}

/// The place within a substep of its last stage, which is contact with the body.
fn last_stage(work: &StepWork<'_>) -> usize {
    work.prepared.program.of_substep().len().saturating_sub(1)
}

/// One worker's share of one phase. Debug builds check that each method is called in the phases that make it sound.
struct LayerShare<'w, 'a> {
    work: &'w LayerWork<'a>,
    phase: LayerPhase,
    share: usize,
}

impl LayerShare<'_, '_> {
    fn run(&self) {
        let garments = || 0..self.work.works.len();
        match self.phase {
            LayerPhase::Motions => self.meter(LAYERS_METERED, || {
                self.each_garment(|g| {
                    self.give_way(g);
                    self.motion(g);
                });
            }),
            LayerPhase::Find => self.meter(LAYERS_METERED, || {
                self.each_pair(|p, own| match self.work.paces[p].search {
                    Search::Anew(steps) => own.find(&self.work.pairs[p], &self.scene(p, steps)),
                    Search::Keep => own.asked = 0,
                    Search::Off => own.rest(),
                });
            }),
            LayerPhase::Lists => self.meter(LAYERS_METERED, || self.each_garment(|g| self.fill_lists(g))),
            LayerPhase::Before(phase) => garments().for_each(|g| self.stage(g, phase)),
            LayerPhase::Finish(g, substep) => self.finish_before(g, substep),
            LayerPhase::Stage(g, at, substep) => self.stage_of_substep(g, at, substep),
            LayerPhase::Whole(substep) => {
                garments().filter(|&g| !is_shared(&self.work.works[g])).for_each(|g| {
                    self.finish_before(g, substep);
                    (0..last_stage(&self.work.works[g])).for_each(|at| self.stage_of_substep(g, at, substep));
                });
            }
            LayerPhase::Solve(substep, at) => self.meter(LAYERS_METERED, || self.turn(substep, at)),
            LayerPhase::Apply(at) => self.meter(LAYERS_METERED, || {
                garments().for_each(|g| self.apply(g, self.work.turns.at(at)));
            }),
            LayerPhase::End => garments().for_each(|g| self.finish(g, self.work.phases.substeps - 1)),
        }
    }

    /// Does something that counts towards a metered stage.
    fn meter(&self, stage: usize, act: impl FnOnce()) {
        let begun = self.work.works[0].step.settings.timed.then(Instant::now);
        act();
        if let Some(begun) = begun {
            // Relaxed: a sum that is read when all is done.
            self.work.times[stage].fetch_add(begun.elapsed().as_nanos() as u64, Relaxed);
        }
    }

    fn each_garment(&self, act: impl Fn(usize)) {
        (0..self.work.works.len()).filter(|&g| self.work.worker[g] == self.share).for_each(act);
    }

    fn each_pair(&self, act: impl Fn(usize, &mut PairShare)) {
        debug_assert!(matches!(self.phase, LayerPhase::Find | LayerPhase::Solve(..)));
        for p in 0..self.work.pairs.len() {
            // SAFETY: `Find` and `Solve` alone call this. Each worker has its own half of the shares of pairs, and neither phase
            // reads them in another way. The other phases only read them.
            act(p, unsafe { self.work.shares.own(self.share * self.work.pairs.len() + p) });
        }
    }

    /// Particles of a garment. In a phase that writes some, each worker opens what it owns; in one that only reads them, all.
    fn particles(&self, garment: usize) -> ParticleColumns<'_> {
        // SAFETY: positions and velocities are written in `Before`, `Stage`, `Whole`, `Finish` and `End`, where each worker writes the
        // particles of its owner's share, as `StepWork::run` says, or of the garments that are its own, and in `Apply`, where each
        // writes those of its part; `Motions` writes what the body gives, by the garment's worker; they are read by both in `Find`,
        // `Lists` and `Solve`, in which no worker writes them.
        unsafe { self.work.works[garment].columns.open() }.particles
    }

    fn width(&self) -> Width {
        self.work.works[0].width
    }

    /// What the last step has shown of where the body is in its own way.
    fn give_way(&self, garment: usize) {
        let seconds = self.work.works[0].step.settings.step_seconds;
        let given = self.particles(garment).given;
        debug_assert!(matches!(self.phase, LayerPhase::Motions) && self.work.worker[garment] == self.share);
        // SAFETY: `Motions` alone calls this, for each garment by its worker.
        let touching = unsafe { self.touching(garment) };
        if touching.gives || touching.any() {
            // SAFETY: `Motions` alone calls this, for each garment by its worker. No other code of this phase touches the bearing.
            touching.gives = give_way(given, unsafe { self.work.bearing[garment].own_all() }, seconds);
        }
    }

    fn motion(&self, garment: usize) {
        let looks = |(pair, pace): (&GarmentPair, &PairPace)| {
            matches!(pace.search, Search::Anew(_)) && (pair.particles == garment || pair.faces == garment)
        };
        if !self.work.pairs.iter().zip(self.work.paces).any(looks) {
            return;
        }
        debug_assert!(matches!(self.phase, LayerPhase::Motions) && self.work.worker[garment] == self.share);
        // SAFETY: `Motions` alone calls this, for each garment by its worker. The motions are read in the next phase only.
        let motion = unsafe { self.work.motions.own(garment) };
        let meets = self.work.works.len() > 1 && self.work.works[0].step.settings.contact.layers > 0;
        motion.take(&self.work.surfaces[garment], self.particles(garment), self.width(), meets);
    }

    /// What a pair is found from, for so many steps.
    fn scene(&self, pair: usize, steps: u8) -> PairScene<'_> {
        debug_assert!(matches!(self.phase, LayerPhase::Find));
        let GarmentPair { particles, faces, .. } = self.work.pairs[pair];
        PairScene {
            columns: [particles, faces].map(|g| self.particles(g)),
            surfaces: [particles, faces].map(|g| &self.work.surfaces[g]),
            // SAFETY: `Find` alone calls this. The motions are written in `Motions`, the phase before.
            motions: [particles, faces].map(|g| unsafe { self.work.motions.read(g) }),
            step_seconds: self.work.works[0].step.settings.step_seconds * f32::from(steps),
            tick: self.work.paces[pair].number,
            width: self.width(),
        }
    }

    /// The contacts of a list, in phases that do not write them.
    fn contacts(&self, list: usize) -> &ContactList {
        debug_assert!(!matches!(self.phase, LayerPhase::Find | LayerPhase::Solve(..)));
        // SAFETY: contacts are written in `Find` and `Solve`, which do not call this.
        unsafe { &self.work.shares.read(list).contacts }
    }

    fn fill_lists(&self, garment: usize) {
        debug_assert!(matches!(self.phase, LayerPhase::Lists) && self.work.worker[garment] == self.share);
        // SAFETY: `Lists` alone calls this, for each garment by its worker.
        let touching = unsafe { self.touching(garment) };
        touching.fill(self.work.pairs, |list| self.contacts(list).contacts());
        // SAFETY: `Lists` alone calls this, for each garment by its worker. No other code of this phase touches what its particles
        // bear or rest on.
        let all = unsafe { (self.work.bearing[garment].own_all(), self.work.resting[garment].own_all()) };
        for (i, (bearing, resting)) in all.0.iter_mut().zip(all.1).enumerate() {
            if !touching.touches(i) {
                bearing.rest(resting);
            }
        }
    }

    /// The touches of a garment, to write.
    ///
    /// # Safety
    /// The caller is the worker of the garment in `Motions` or `Lists`, and makes no other reference to the touches meanwhile.
    #[expect(clippy::mut_from_ref, reason = "each garment is one worker's")]
    unsafe fn touching(&self, garment: usize) -> &mut TouchLists {
        // SAFETY: the caller is the garment's worker in one of the two phases that write the touches and read them in no other way.
        unsafe { self.work.touching.own(garment) }
    }

    /// The same in phases that write none.
    fn touches(&self, garment: usize) -> &TouchLists {
        debug_assert!(!matches!(self.phase, LayerPhase::Motions | LayerPhase::Lists));
        // SAFETY: `Motions` and `Lists` alone write the touches, and neither calls this.
        unsafe { self.work.touching.read(garment) }
    }

    /// A worker's share of a phase of a garment's program: of a garment that is one worker's all or nothing.
    fn stage(&self, garment: usize, phase: usize) {
        let own = &self.work.works[garment];
        let run = |owner: usize| {
            // SAFETY: the phases follow the program of the garment. If both workers own particles of it, a stage is one phase, and each
            // worker does its share of it. Otherwise the garment's worker alone does both shares of one stage after the other. The
            // caller of `LayerWork::run` knows that the cloth was made of the garment.
            unsafe { own.run(phase, owner) };
        };
        let metered = own.prepared.program.stage(phase).0.metered();
        self.each_part(garment, metered, run);
    }

    /// The same of a place within a substep.
    fn stage_of_substep(&self, garment: usize, at: usize, substep: usize) {
        let stages = self.work.works[garment].prepared.program.of_substep().len();
        self.stage(garment, BEFORE.len() + substep * stages + at);
    }

    /// Does something to the parts of a garment that are this worker's: one of a shared garment, both or none of another.
    fn each_part(&self, garment: usize, metered: usize, act: impl Fn(usize)) {
        if is_shared(&self.work.works[garment]) {
            self.meter(metered, || act(self.share));
        } else if self.work.worker[garment] == self.share {
            self.meter(metered, || (0..OWNERS).for_each(act));
        }
    }

    /// The end of the substep before this one, if there is one.
    fn finish_before(&self, garment: usize, substep: usize) {
        substep.checked_sub(1).into_iter().for_each(|before| self.finish(garment, before));
    }

    /// Contact with the body and the velocities, and what was seen of what holds what. Of a shared garment one owner's particles,
    /// which no other particles depend on.
    fn finish(&self, garment: usize, substep: usize) {
        self.stage_of_substep(garment, last_stage(&self.work.works[garment]), substep);
        self.each_part(garment, LAYERS_METERED, |part| {
            self.each_touched(garment, part, |i, resting, bearing, columns| bearing.note_support(resting, i, columns));
        });
    }

    /// Does something to each particle of a part of a garment that anything touches.
    fn each_touched(
        &self,
        garment: usize,
        part: usize,
        act: impl Fn(usize, &mut Resting, &mut Bearing, ParticleColumns<'_>),
    ) {
        debug_assert!(matches!(
            self.phase,
            LayerPhase::Apply(_) | LayerPhase::Finish(..) | LayerPhase::Whole(_) | LayerPhase::End
        ));
        let (touches, columns) = (self.touches(garment), self.particles(garment));
        for touched in touches.touched(touches.own_level(), part) {
            let i = touched.particle as usize;
            // SAFETY: each particle is in one part, whose worker alone has them in the phases that call this: `Apply`,
            // `Finish`, `Whole` and `End`.
            let (resting, bearing) = unsafe { (self.work.resting[garment].own(i), self.work.bearing[garment].own(i)) };
            act(i, resting, bearing, columns);
        }
    }

    /// What the contacts of a turn do to the particles of this worker's part of a garment; after the last turn these get what they bear.
    fn apply(&self, garment: usize, turn: Turn) {
        self.gather(garment, turn, self.share);
        if turn == self.work.turns.last() {
            self.each_touched(garment, self.share, |i, _, bearing, columns| bearing.bear(i, columns));
        }
    }

    fn gather(&self, garment: usize, turn: Turn, part: usize) {
        debug_assert!(matches!(self.phase, LayerPhase::Apply(_)));
        let (touches, columns) = (self.touches(garment), self.particles(garment));
        let is_own = turn.level == touches.own_level();
        if !turn.up && touches.height() == turn.level {
            return self.each_touched(garment, part, |_, _, bearing, _| bearing.let_go());
        }
        if !turn.up && touches.height() > turn.level {
            return;
        }
        for touched in touches.touched(turn.level, part) {
            let i = touched.particle as usize;
            // SAFETY: `Apply` alone calls this. Each particle is in one part, whose worker alone has what it bears and rests on.
            let (resting, bearing) = unsafe { (self.work.resting[garment].own(i), self.work.bearing[garment].own(i)) };
            let own = touches.of(touched);
            match turn.up {
                true => bearing.gather(resting, i, own, is_own, columns, |list| self.contacts(list.into()).pushes()),
                false => own.iter().for_each(|touch| {
                    let contacts = self.contacts(touch.list.into()).contacts();
                    bearing.take_over(touch, &contacts[touch.contact as usize]);
                }),
            }
        }
    }

    /// One turn's share of the contacts.
    fn turn(&self, substep: usize, at: usize) {
        let turn = self.work.turns.at(at);
        self.each_pair(|p, own| match (self.work.pairs[p].level == turn.level, turn.up) {
            (false, _) => {}
            (true, true) => self.solve(p, own, substep == 0),
            (true, false) => self.pass(p, own),
        });
    }

    fn pass(&self, pair: usize, own: &mut PairShare) {
        let pair = &self.work.pairs[pair];
        if pair.is_fold() {
            return;
        }
        debug_assert!(matches!(self.phase, LayerPhase::Solve(..)));
        let (above, of) = if pair.wearing == Wearing::Outer { (0, pair.particles) } else { (1, pair.faces) };
        let borne = |i: u32| {
            // SAFETY: `Solve` alone calls this. What particles bear is written in other phases only.
            let bearing = unsafe { self.work.bearing[of].read(i as usize) };
            (bearing.owed, bearing.held_by)
        };
        own.contacts.pairs_mut().for_each(|(contact, push)| contact.pass(push, above, borne));
    }

    fn solve(&self, pair: usize, own: &mut PairShare, first: bool) {
        debug_assert!(matches!(self.phase, LayerPhase::Solve(..)));
        let GarmentPair { particles, faces, level, .. } = self.work.pairs[pair];
        let of = [particles, faces];
        let columns = of.map(|g| self.particles(g));
        if first {
            let load = of.map(|g| self.touches(g).load(level));
            own.contacts.pairs_mut().for_each(|(contact, _)| contact.weigh(columns, load));
        }
        let settings = self.work.works[0].step.settings;
        let dt = settings.step_seconds / self.work.phases.substeps as f32;
        let constants = self.work.pairs[pair].constants(dt, settings.static_friction);
        let resting = of.map(|g| &self.work.resting[g]);
        for (contact, push) in own.contacts.pairs_mut() {
            let mut rest = [Resting::default(); VERTICES];
            for (k, rest) in rest.iter_mut().enumerate() {
                // SAFETY: `Solve` alone calls this. What particles rest on is written in other phases only.
                *rest = *unsafe { resting[contact.side(k)].read(contact.vertices[k] as usize) };
            }
            contact.solve(columns, &rest, constants, push);
        }
    }
}
