//! What each worker does in each phase of a step of several garments.
//!
//! Between two phases the workers meet. Within one, what a worker writes belongs to it alone: garments to the worker that
//! steps them, contacts to the worker whose half of the particles they are of.

use std::marker::PhantomData;
use std::sync::atomic::AtomicU64;
use std::sync::atomic::Ordering::Relaxed;
use std::time::Instant;

use super::garment_surface::{GarmentMotion, GarmentSurface};
use super::pace::{PairPace, Search};
use super::pair::{LayerPair, PairScene, Wearing};
use super::pair_share::PairShare;
use super::touch::TouchLists;
use super::turns::{Turn, Turns};
use crate::cloth::program::{BEFORE, LAYERS_METERED, METERED_STAGES, Stage};
use crate::cloth::state::ParticleColumns;
use crate::cloth::work::StepWork;
use crate::lanes::Width;

/// One phase of a step: both workers' shares of it may run at once.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LayerPhase {
    /// Where each garment is and how fast.
    Motions,
    /// What is near what.
    Find,
    /// Which contacts act on each particle.
    Lists,
    /// A substep of each garment up to where garments meet, after the end of the one before.
    Substep(usize),
    /// What the contacts make of it, in a substep and in one of its turns.
    Solve(usize, usize),
    /// What they do to the garments, between two turns.
    Apply(usize),
    /// The end of the last substep.
    End,
    /// A stage of a substep of the only garment, shared by the owners of its particles.
    Stage(Stage, usize),
    /// What the contacts do to the only garment, before contact with the body.
    Gather,
    /// Where the body has held it.
    Note,
}

impl LayerPhase {
    /// Phases of a step of so many substeps with so many solves each.
    pub fn count(substeps: usize, solves: usize) -> usize {
        4 + 2 * solves * substeps
    }

    /// Phases of a step of so many substeps where there is one garment only, with these stages of a substep.
    pub fn count_of_one(stages: &[Stage], substeps: usize) -> usize {
        3 + BEFORE.len() + (stages.len() + 3) * substeps
    }

    /// One of them: its stages are phases, so that two workers share it.
    pub fn of_one(phase: usize, stages: &[Stage]) -> Self {
        match phase {
            0 => Self::Motions,
            1 => Self::Find,
            2 => Self::Lists,
            before if before < 3 + BEFORE.len() => Self::Stage(BEFORE[before - 3], 0),
            later => {
                let later = later - 3 - BEFORE.len();
                let (substep, at) = (later / (stages.len() + 3), later % (stages.len() + 3));
                let last = stages.len() - 1;
                match at {
                    at if at < last => Self::Stage(stages[at], substep),
                    at if at == last => Self::Solve(substep, 0),
                    at if at == last + 1 => Self::Gather,
                    at if at == last + 2 => Self::Stage(stages[last], substep),
                    _ => Self::Note,
                }
            }
        }
    }

    /// One of them. A substep is the garments' own stages, then solves and what they do in turn; what the last one does is part
    /// of what comes after.
    pub fn of(phase: usize, substeps: usize, solves: usize) -> Self {
        match phase {
            0 => Self::Motions,
            1 => Self::Find,
            2 => Self::Lists,
            last if last + 1 == Self::count(substeps, solves) => Self::End,
            later => {
                let (substep, at) = ((later - 3) / (2 * solves), (later - 3) % (2 * solves));
                match at {
                    0 => Self::Substep(substep),
                    odd if odd % 2 == 1 => Self::Solve(substep, odd / 2),
                    even => Self::Apply(even / 2 - 1),
                }
            }
        }
    }
}

/// Things of which each belongs to one worker at a time.
struct Cells<'a, T> {
    data: *mut T,
    len: usize,
    owner: PhantomData<&'a mut [T]>,
}

// SAFETY: it hands out `&mut T` and `&T` to whoever keeps to the rules of `own` and `read`, and T may go to other threads.
unsafe impl<T: Send + Sync> Sync for Cells<'_, T> {}

impl<'a, T> Cells<'a, T> {
    fn new(items: &'a mut [T]) -> Self {
        Self { data: items.as_mut_ptr(), len: items.len(), owner: PhantomData }
    }

    /// # Safety
    /// Until the workers next meet, nobody else reads or writes the item.
    #[expect(clippy::mut_from_ref, reason = "each item is one worker's")]
    unsafe fn own(&self, i: usize) -> &mut T {
        assert!(i < self.len, "there is no such item");
        // SAFETY: within the slice; see above.
        unsafe { &mut *self.data.add(i) }
    }

    /// # Safety
    /// Until the workers next meet, nobody writes the item.
    unsafe fn read(&self, i: usize) -> &T {
        assert!(i < self.len, "there is no such item");
        // SAFETY: within the slice; see above.
        unsafe { &*self.data.add(i) }
    }
}

/// Everything that the phases of a step share.
pub struct LayerWork<'a> {
    works: &'a [StepWork<'a>],
    surfaces: &'a [GarmentSurface],
    pairs: &'a [LayerPair],
    paces: &'a [PairPace],
    worker: &'a [usize],
    turns: Turns,
    motions: Cells<'a, GarmentMotion>,
    shares: Cells<'a, PairShare>,
    touching: Cells<'a, TouchLists>,
    substeps: usize,
    /// Time of the stages of all garments (ns), where they are timed.
    times: [AtomicU64; METERED_STAGES.len()],
}

/// What of the layers a step works on.
pub struct LayerParts<'a> {
    /// Surfaces of the garments.
    pub surfaces: &'a [GarmentSurface],
    /// The pairs.
    pub pairs: &'a [LayerPair],
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
}

impl<'a> LayerWork<'a> {
    /// The work of a step.
    pub fn new(works: &'a [StepWork<'a>], parts: LayerParts<'a>, substeps: usize) -> Self {
        let LayerParts { surfaces, pairs, paces, worker, turns, motions, shares, touching } = parts;
        let (motions, shares, touching) = (Cells::new(motions), Cells::new(shares), Cells::new(touching));
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
            substeps,
            times: Default::default(),
        }
    }

    /// Time of the stages of all garments (ns), where they are timed.
    pub fn times(&self) -> [u64; METERED_STAGES.len()] {
        self.times.each_ref().map(|t| t.load(Relaxed))
    }

    /// Does something that counts towards a metered stage.
    fn meter(&self, stage: usize, act: impl FnOnce()) {
        let begun = self.works[0].step.settings.timed.then(Instant::now);
        act();
        if let Some(begun) = begun {
            // Relaxed: a sum that is read when all is done.
            self.times[stage].fetch_add(begun.elapsed().as_nanos() as u64, Relaxed);
        }
    }

    /// Does one worker's share of a phase; no share of a phase is done twice.
    pub fn run(&self, phase: LayerPhase, share: usize) {
        match phase {
            LayerPhase::Substep(_) | LayerPhase::End | LayerPhase::Stage(..) => self.part(phase, share),
            _ => self.meter(LAYERS_METERED, || self.part(phase, share)),
        }
    }

    fn part(&self, phase: LayerPhase, share: usize) {
        match phase {
            LayerPhase::Motions => self.each_garment(share, |g| {
                self.give_way(g);
                self.motion(g);
            }),
            LayerPhase::Find => self.each_pair(share, |p, own| match self.paces[p].search {
                Search::Anew(steps) => own.find(&self.pairs[p], &self.scene(p, steps)),
                Search::Keep => own.asked = 0,
                Search::Off => own.rest(),
            }),
            LayerPhase::Lists => self.each_garment(share, |g| self.fill_lists(g)),
            LayerPhase::Substep(k) => self.each_garment(share, |g| {
                if k > 0 {
                    self.finish(g, k - 1);
                }
                self.begin(g, k);
            }),
            LayerPhase::Solve(k, at) => {
                let turn = self.turns.at(at);
                self.each_pair(share, |p, own| match (self.pairs[p].level == turn.level, turn.up) {
                    (false, _) => {}
                    (true, true) => self.solve(p, own, k == 0),
                    (true, false) => self.pass(p, own),
                });
            }
            LayerPhase::Apply(at) => self.each_garment(share, |g| self.gather(g, self.turns.at(at))),
            LayerPhase::End => self.each_garment(share, |g| self.finish(g, self.substeps - 1)),
            LayerPhase::Stage(stage, substep) => {
                let work = &self.works[0];
                self.meter(stage.metered(), || work.run(stage, substep as u32, share));
            }
            LayerPhase::Gather => self.each_garment(share, |g| self.gather(g, self.turns.last())),
            LayerPhase::Note => self.each_garment(share, |g| self.touching(g).note_support(self.particles(g))),
        }
    }

    fn each_garment(&self, share: usize, act: impl Fn(usize)) {
        (0..self.works.len()).filter(|&g| self.worker[g] == share).for_each(act);
    }

    fn each_pair(&self, share: usize, act: impl Fn(usize, &mut PairShare)) {
        for p in 0..self.pairs.len() {
            // SAFETY: the shares of pairs are written in the phases that call this, by the worker of the share alone, and
            // read in the others.
            act(p, unsafe { self.shares.own(share * self.pairs.len() + p) });
        }
    }

    /// Particles of a garment. In a phase that writes some, by the garment's worker alone; in one that only reads them, by
    /// all.
    fn particles(&self, garment: usize) -> ParticleColumns<'_> {
        // SAFETY: positions and velocities are written in `Substep`, `Apply` and `End`, where each worker opens the garments
        // that it steps and no other; they are read by both in `Find` and `Solve`, in which nobody writes them.
        unsafe { self.works[garment].columns.open() }.particles
    }

    fn width(&self) -> Width {
        self.works[0].width
    }

    /// What the last step has shown of where the body is in its own way. Its contacts stand until `Find`.
    fn give_way(&self, garment: usize) {
        let seconds = self.works[0].step.settings.step_seconds;
        self.touching(garment).give_way(self.particles(garment), seconds, |list| self.contacts(list));
    }

    fn motion(&self, garment: usize) {
        let looks = |(pair, pace): (&LayerPair, &PairPace)| {
            matches!(pace.search, Search::Anew(_)) && (pair.particles == garment || pair.faces == garment)
        };
        if !self.pairs.iter().zip(self.paces).any(looks) {
            return;
        }
        // SAFETY: written in this phase by the garment's worker, read in the next.
        let motion = unsafe { self.motions.own(garment) };
        let meets = self.works.len() > 1 && self.works[0].step.settings.contact().layers > 0;
        motion.take(&self.surfaces[garment], self.particles(garment), self.width(), meets);
    }

    /// What a pair is found from, for so many steps.
    fn scene(&self, pair: usize, steps: u8) -> PairScene<'_> {
        let LayerPair { particles, faces, .. } = self.pairs[pair];
        PairScene {
            columns: [particles, faces].map(|g| self.particles(g)),
            surfaces: [particles, faces].map(|g| &self.surfaces[g]),
            // SAFETY: written in the phase before.
            motions: [particles, faces].map(|g| unsafe { self.motions.read(g) }),
            step_seconds: self.works[0].step.settings.step_seconds * f32::from(steps),
            tick: self.paces[pair].number,
            width: self.width(),
        }
    }

    /// The contacts of a list, in phases that do not write them.
    fn contacts(&self, list: usize) -> &[super::contact::LayerContact] {
        // SAFETY: contacts are written in `Find` and `Solve`, which do not call this.
        unsafe { &self.shares.read(list).contacts }
    }

    fn fill_lists(&self, garment: usize) {
        self.touching(garment).fill(self.pairs, |list| self.contacts(list));
    }

    /// The touches of a garment, in phases in which its worker alone has them.
    #[expect(clippy::mut_from_ref, reason = "each garment is one worker's")]
    fn touching(&self, garment: usize) -> &mut TouchLists {
        // SAFETY: written in `Lists`, `Substep`, `Apply` and `End` by the garment's worker, read in `Solve`.
        unsafe { self.touching.own(garment) }
    }

    fn stage(&self, garment: usize, stage: Stage, substep: usize) {
        let work = &self.works[garment];
        self.meter(stage.metered(), || (0..2).for_each(|owner| work.run(stage, substep as u32, owner)));
    }

    /// A substep up to where garments meet.
    fn begin(&self, garment: usize, substep: usize) {
        let before: &[_] = if substep == 0 { &BEFORE } else { &[] };
        let stages = self.works[garment].prepared.program.of_substep();
        let own = &stages[..stages.len() - 1];
        before.iter().chain(own).for_each(|&stage| self.stage(garment, stage, substep));
    }

    /// What the contacts between the garments do, then contact with the body, last as ever, and the velocities.
    fn finish(&self, garment: usize, substep: usize) {
        self.meter(LAYERS_METERED, || self.gather(garment, self.turns.last()));
        self.stage(garment, Stage::ContactAndVelocities, substep);
        self.meter(LAYERS_METERED, || self.touching(garment).note_support(self.particles(garment)));
    }

    fn gather(&self, garment: usize, turn: Turn) {
        let (touching, columns) = (self.touching(garment), self.particles(garment));
        match turn.up {
            true => touching.gather(columns, turn.level, |list| self.contacts(list)),
            false => touching.take_over(turn.level, |list| self.contacts(list)),
        }
        if turn == self.turns.last() {
            touching.bear(columns);
        }
    }

    fn pass(&self, pair: usize, own: &mut PairShare) {
        let pair = &self.pairs[pair];
        let above = if pair.wearing == Wearing::Outer { pair.particles } else { pair.faces };
        if !pair.is_fold() {
            // SAFETY: nobody writes them in `Solve`.
            let (bears, held_by) = unsafe { self.touching.read(above) }.borne();
            own.contacts.iter_mut().for_each(|c| c.pass(above == pair.particles, bears, held_by));
        }
    }

    fn solve(&self, pair: usize, own: &mut PairShare, first: bool) {
        let LayerPair { particles, faces, .. } = self.pairs[pair];
        let columns = [particles, faces].map(|g| self.particles(g));
        // SAFETY: nobody writes them in `Solve`.
        let touching = [particles, faces].map(|g| unsafe { self.touching.read(g) });
        if first {
            let load = touching.map(|t| t.load(self.pairs[pair].level));
            own.contacts.iter_mut().for_each(|c| c.weigh(columns, load));
        }
        let rest = touching.map(TouchLists::resting);
        let settings = self.works[0].step.settings;
        let law = self.pairs[pair].law(settings.step_seconds / self.substeps as f32, settings.static_friction);
        own.contacts.iter_mut().for_each(|c| c.solve(columns, rest, law));
    }
}
