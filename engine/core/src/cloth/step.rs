//! One step: substeps of phases, on one core or on two, and the doors of the guard at both ends.

use std::sync::atomic::AtomicU64;
use std::sync::atomic::Ordering::Relaxed;
use std::time::Instant;

use glam::{Affine3A, Vec3A};
use toile_assets::garment::Garment;
use toile_assets::garment::layout::{Bends, OWNERS};

use super::prepared::Prepared;
use super::program::{self, Op, STAGES};
use super::root::{Carried, RootStep};
use super::stages;
use super::state::{self, Columns};
use super::{
    Cloth, Quality, Settings, Step, Wind, bending, contact, diagonals, fibers, guard, hubs, links, lists, predict,
    settle, tethers, wind,
};
use crate::lanes::{Column, Store, Width};
use crate::workers::{PerShare, WorkerPool};

/// Everything that the phases of one step share.
struct Work<'a> {
    garment: &'a Garment,
    step: &'a Step<'a>,
    prepared: &'a Prepared,
    columns: Columns<'a>,
    faces: Option<(&'a wind::Faces, Wind)>,
    carried: Option<Carried>,
    pushed: [Column<'a>; 3],
    contacts: PerShare<'a, contact::Owner>,
    /// Particle substeps that each owner held at the speed limit.
    limited: [AtomicU64; OWNERS],
    fixed: [&'a [Vec3A]; 2],
    /// Tensions of weft links, of fibers, of crossing fibers so far in the substep; empty where they have no compliance.
    tension: [Column<'a>; 3],
    scratch: [Column<'a>; OWNERS],
    /// Room for stiff bending; empty where there is none.
    room: [[Column<'a>; 3]; 3],
    leaning: [Column<'a>; diagonals::KEPT],
    fall: Vec3A,
    kept: f32,
    width: Width,
}

impl Cloth {
    /// One step of the settings' length, both shares on the caller's thread.
    pub fn step(&mut self, garment: &Garment, step: &Step<'_>) {
        let settings = self.sound(step.settings);
        let step = &Step { settings: &settings, ..*step };
        let carried = self.begin(garment, step);
        let timed = step.settings.timed;
        let mut stage_ns = [0; STAGES.len()];
        let work = self.work(garment, step, carried);
        let mut begun = timed.then(Instant::now);
        for phase in 0..work.phases() {
            (0..OWNERS).for_each(|share| work.phase(phase, share));
            if let Some(start) = begun {
                let now = Instant::now();
                stage_ns[work.op(phase).0.stage()] += (now - start).as_nanos() as u64;
                begun = Some(now);
            }
        }
        let limited = work.limited();
        self.stage_ns = stage_ns;
        self.end(garment, step, limited, false);
    }

    /// The same with the crew's workers, a share each: the same bits.
    pub fn step_with(&mut self, pool: &mut WorkerPool, garment: &Garment, step: &Step<'_>) {
        if pool.workers() < OWNERS || garment.layout.spans[1].is_empty() {
            return self.step(garment, step);
        }
        let settings = self.sound(step.settings);
        let step = &Step { settings: &settings, ..*step };
        let carried = self.begin(garment, step);
        let work = self.work(garment, step, carried);
        let failed = pool.run(work.phases(), |phase, share| work.phase(phase, share)).is_err();
        let limited = work.limited();
        self.end(garment, step, limited, failed);
    }

    /// Settings that a step can be made with.
    fn sound(&mut self, settings: &Settings) -> Settings {
        let sound = settings.sound();
        self.events.held_settings += u64::from(sound != *settings);
        sound
    }

    /// What comes before the phases: targets of the skinned particles, the root's motion, repairs.
    fn begin(&mut self, garment: &Garment, step: &Step<'_>) -> Option<Carried> {
        let settings = step.settings;
        self.prepared.make(garment, settings);
        self.events.held_pins += self.pins.attach(garment, step.palette);
        let columns = self.state.columns();
        let width = settings.width;
        // Both are looked at, because both are calmed.
        if [columns.x, columns.v].map(|c| width.run(guard::Sound(c))) != [true; 2] {
            self.events.repaired += guard::repair(columns, &self.positions);
        }
        self.root.settings = settings.root;
        let root = step.palette[0] * Affine3A::from_translation(self.origin.into());
        let all = (0, garment.start.len() as u32);
        match self.root.advance(&root, settings.step_seconds) {
            RootStep::Plain => return None,
            RootStep::Carried(carried) => return Some(carried),
            RootStep::Keep(moved) => {
                moved.apply(width, columns, all);
                self.pins.start.iter_mut().for_each(|p| *p = moved.point(*p));
                // What the guard would roll back to goes along.
                self.positions.iter_mut().for_each(|p| *p = moved.point(*p));
            }
            RootStep::Reset => {
                let dressed = |i: usize| step.palette[0].transform_point3a(garment.start[i].into());
                guard::roll_back(columns, &self.positions, dressed, 1.0);
                self.pins.rest();
            }
        }
        self.events.teleports += 1;
        None
    }

    /// What comes after them: nothing that is not finite is published. `failed` says that a worker panicked.
    fn end(&mut self, garment: &Garment, step: &Step<'_>, limited: u64, failed: bool) {
        self.events.speed_limited += limited;
        self.events.held_colliders = step.colliders.held();
        let columns = self.state.columns();
        let width = step.settings.width;
        if !failed && width.run(guard::Sound(columns.x)) && width.run(guard::Sound(columns.v)) {
            self.rolled = 0;
        } else {
            // Rolled back again and again, it is drawn to where it was dressed.
            let towards = (self.rolled as f32 * 0.25).min(1.0);
            let root = step.palette[0];
            let dressed = |i: usize| root.transform_point3a(garment.start[i].into());
            guard::roll_back(columns, &self.positions, dressed, towards);
            self.rolled += 1;
            self.events.rolled_back += 1;
        }
        let [x, y, z] = self.state.positions();
        for (i, p) in self.positions.iter_mut().enumerate() {
            *p = Vec3A::new(x[i], y[i], z[i]);
        }
    }

    fn work<'a>(&'a mut self, garment: &'a Garment, step: &'a Step<'a>, carried: Option<Carried>) -> Work<'a> {
        let dt = self.prepared.dt;
        let [one, two] = &mut self.scratch;
        let room = self.room.columns();
        let leaning = self.leaning.columns();
        Work {
            garment,
            step,
            prepared: &self.prepared,
            columns: self.state.columns(),
            faces: self.faces.as_ref().zip(step.settings.wind),
            carried,
            pushed: self.pushed.columns(),
            contacts: PerShare::new(self.contacts.owners()),
            limited: [AtomicU64::new(0), AtomicU64::new(0)],
            fixed: [&self.pins.start, &self.pins.end],
            tension: self.tension.each_mut().map(Store::column),
            scratch: [one.column(), two.column()],
            room,
            leaning,
            fall: step.settings.gravity * dt,
            kept: (-garment.fabric.damping_per_s * dt).exp(),
            width: step.settings.width,
        }
    }
}

impl Work<'_> {
    /// Phases of the step.
    fn phases(&self) -> usize {
        program::BEFORE.len() + self.prepared.substeps as usize * self.substep_phases()
    }

    /// Phases of a substep.
    fn substep_phases(&self) -> usize {
        self.prepared.bending.phases() + self.prepared.program().len()
    }

    /// What a phase does, and in which substep.
    fn op(&self, phase: usize) -> (Op, u32) {
        let Some(later) = phase.checked_sub(program::BEFORE.len()) else { return (program::BEFORE[phase], 0) };
        let (each, bending) = (self.substep_phases(), self.prepared.bending);
        let (substep, at) = ((later / each) as u32, later % each);
        let op = at.checked_sub(bending.phases()).map_or_else(|| bending.op(at), |k| self.prepared.program()[k]);
        (op, substep)
    }

    /// One owner's share of one phase.
    fn phase(&self, phase: usize, share: usize) {
        let (op, substep) = self.op(phase);
        self.run(op, substep, share);
    }

    /// Particle substeps that were held at the speed limit.
    fn limited(&self) -> u64 {
        self.limited.iter().map(|l| l.load(Relaxed)).sum()
    }

    /// The broad phase, once a step.
    fn find(&self, share: usize) {
        let how = self.contact_settings();
        self.contacts.with(share, |own| own.find(self.width, self.columns, self.step.colliders, &how));
    }

    /// The wind of the whole step, as accelerations.
    fn wind(&self, part: wind::Part) {
        if let Some((faces, wind)) = self.faces {
            faces.blow(self.width, part, &wind, self.step.settings.step_seconds, self.columns, self.pushed);
        }
    }

    /// What of the root's motion the cloth is not to feel, beside the wind.
    fn carry(&self, share: usize) {
        let Some(carried) = self.carried else { return };
        for &span in &self.garment.layout.spans[share] {
            if self.faces.is_none() {
                for i in span.0..span.0 + span.1 {
                    state::set(self.pushed, i as usize, Vec3A::ZERO);
                }
            }
            carried.apply(self.width, self.columns, span, self.pushed);
        }
    }

    fn contact_settings(&self) -> contact::ContactSettings {
        contact::ContactSettings::new(&self.garment.fabric, self.step.settings)
    }

    fn run(&self, op: Op, substep: u32, share: usize) {
        let (columns, layout) = (self.columns, &self.garment.layout);
        let p = self.prepared;
        let per_dt2 = (p.dt * p.dt).recip();
        let scratch = self.scratch[share];
        let link = |links, gain, set, tension| links::Solve {
            columns,
            links,
            gain,
            set,
            owner: share,
            gamma: p.gamma,
            tension,
        };
        let tension = |k: usize| p.soft[k].then_some(self.tension[k]);
        let list = |lists, set: u16, tension| lists::Solve {
            columns,
            lists,
            set: usize::from(set),
            owner: share,
            scratch,
            per_dt2,
            tension,
        };
        match op {
            Op::Find => self.find(share),
            Op::Wind => self.wind([wind::Part::First, wind::Part::Second][share]),
            Op::CrossWind if share == 0 => self.wind(wind::Part::Crossing),
            Op::CrossWind => {}
            Op::Carry => self.carry(share),
            Op::Tether if self.step.settings.tethers || p.quality == Quality::Draft => {
                let spans = &layout.spans[share];
                self.width.run(tethers::Hold { columns, tethers: &layout.tethers, spans });
            }
            Op::Tether => {}
            Op::Bend(set) if substep.is_multiple_of(p.bend.every) => {
                self.bend(set, [columns.x, columns.v], p.dt * p.bend.every as f32, share);
            }
            Op::Bend(_) => {}
            Op::Turn(stage) => self.turn(stage, share),
            Op::Stage(0, set) => self.bend(set, [self.room[1], self.room[0]], p.dt, share),
            Op::Stage(stage, set) => {
                let by = p.stages[stage as usize % p.stages.len()].forced * p.dt * p.dt;
                self.bend(set, [stage, stage + 1].map(|j| self.room[stages::place(j)]), by, share);
            }
            Op::Predict => self.predict(substep, share),
            Op::Diagonals(family) if substep.is_multiple_of(p.shear_every) => {
                let strand = &layout.diagonals.families[usize::from(family)][share];
                let per_dt2 = per_dt2 / p.shear_every as f32;
                let (diagonals, room, gamma) = (&layout.diagonals, self.leaning, p.gamma);
                self.width.run(diagonals::Solve { columns, diagonals, strand, room, per_dt2, gamma });
            }
            Op::Diagonals(_) => {}
            Op::Shear(set) => {
                let set = &layout.shear.tuples.sets[usize::from(set)];
                self.width.run(link(&layout.shear, &p.shear_gain, set, None));
            }
            Op::Weft(set) => {
                let set = &layout.weft.tuples.sets[usize::from(set)];
                self.width.run(link(&layout.weft, &p.weft_gain, set, tension(0).map(|t| (t, per_dt2))));
            }
            Op::Fibers => self.width.run(fibers::Solve {
                columns,
                fibers: &layout.fibers,
                owner: share,
                scratch,
                per_dt2,
                gamma: p.gamma,
                taut: p.taut,
                tension: tension(1),
            }),
            Op::Crossing(set) => self.width.run(list(&layout.crossing, set, tension(2))),
            Op::Finish => self.finish(substep, share),
        }
    }

    /// A set of the stencils bends one thing and pushes another.
    fn bend(&self, set: u16, from_to: [[Column<'_>; 3]; 2], by: f32, share: usize) {
        let (layout, p) = (&self.garment.layout, self.prepared);
        self.stencils(&layout.bends, &p.bend_scale, set, from_to, by, share);
        self.stencils(&layout.skewed, &p.skewed_scale, set, from_to, by, share);
        self.hubs(set, from_to, by, share);
    }

    /// Those of whole rings.
    fn hubs(&self, set: u16, [from, to]: [[Column<'_>; 3]; 2], by: f32, share: usize) {
        let hubs = &self.garment.layout.hubs;
        let Some(groups) = hubs.sets.get(usize::from(set)) else { return };
        let scale = (self.prepared.bend.least < 1.0).then_some(&*self.prepared.hub_scale);
        let bend = |owner: usize| {
            let groups = groups[owner].clone();
            self.width.run(hubs::Bend { w: self.columns.w, hubs, groups, from, to, by, scale });
        };
        // The second set crosses the owners.
        if set == 0 {
            bend(share);
        } else if share == 0 {
            (0..OWNERS).for_each(bend);
        }
    }

    /// Those of one kind; what crosses the owners is the first worker's alone.
    fn stencils<const K: usize>(
        &self,
        bends: &Bends<K>,
        scale: &[f32],
        set: u16,
        [from, to]: [[Column<'_>; 3]; 2],
        by: f32,
        share: usize,
    ) {
        let Some(set) = bends.tuples.sets.get(usize::from(set)) else { return };
        let (w, scratch) = (self.columns.w, self.scratch[share]);
        let scale = (self.prepared.bend.least < 1.0).then_some(scale);
        let bend = |owner| self.width.run(bending::Bend { w, bends, set, owner, from, to, by, scale, scratch });
        if !set.crosses {
            bend(share);
        } else if share == 0 {
            (0..OWNERS).for_each(bend);
        }
    }

    /// What comes before the forces of a stage of stiff bending, or behind the last.
    fn turn(&self, stage: u32, share: usize) {
        let p = self.prepared;
        let turn = match stage {
            0 => stages::Turn::Begin { fall: self.fall, pushed: self.pushed().map(|(by, _)| by), dt: p.dt },
            last if last == p.bending.stages => stages::Turn::End(last),
            1 => stages::Turn::First([p.stages[0], p.stages[1]]),
            later => stages::Turn::Next(later + 1, p.stages[later as usize % p.stages.len()]),
        };
        let spans = &self.garment.layout.spans[share];
        self.width.run(stages::Take { columns: self.columns, spans, room: self.room, turn });
    }

    /// What accelerates the particles besides gravity, and the substep (s).
    fn pushed(&self) -> Option<([Column<'_>; 3], f32)> {
        (self.faces.is_some() || self.carried.is_some()).then_some((self.pushed, self.prepared.dt))
    }

    fn predict(&self, substep: u32, share: usize) {
        let (columns, p) = (self.columns, self.prepared);
        // Half of the tensions each: they start from none in every substep.
        for tension in self.tension {
            let half = tension.len().div_ceil(OWNERS);
            let from = share * half;
            (from..(from + half).min(tension.len())).for_each(|i| tension.set(i, 0.0));
        }
        let spans = &self.garment.layout.spans[share];
        let (kept, dt) = (self.kept, p.dt);
        // Stages have accelerated everything already.
        let (fall, pushed) = if p.bending.stages > 1 { (Vec3A::ZERO, None) } else { (self.fall, self.pushed()) };
        self.width.run(predict::Predict { columns, spans, fall, pushed, kept, dt });
        let to = (substep + 1) as f32 / p.substeps as f32;
        for (k, &i) in self.garment.fixed.iter().enumerate() {
            if usize::from(self.garment.layout.owner[i as usize]) == share {
                state::set(columns.x, i as usize, self.fixed[0][k].lerp(self.fixed[1][k], to));
            }
        }
    }

    fn contact(&self, substep: u32, share: usize) {
        let p = self.prepared;
        let [from, to] = [substep, substep + 1].map(|s| s as f32 / p.substeps as f32);
        let how = self.contact_settings();
        self.contacts.with(share, |own| own.solve(self.width, self.columns, [from, to], &how));
    }

    fn finish(&self, substep: u32, share: usize) {
        let p = self.prepared;
        self.contact(substep, share);
        let (spans, max_speed) = (&self.garment.layout.spans[share], self.step.settings.max_speed);
        let held = self.width.run(settle::Settle { columns: self.columns, spans, max_speed, dt: p.dt });
        // Relaxed: a counter that one share adds to and that is read when all is done.
        self.limited[share].fetch_add(u64::from(held), Relaxed);
    }
}
