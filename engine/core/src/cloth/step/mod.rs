//! One step: its stages in their order, on one core or on two, and the guard at both ends.

pub mod guard;
pub mod measure;
pub mod prepared;
pub mod program;
pub mod settings;
pub mod settle;
#[expect(unsafe_code, reason = "the workers of a step share its columns")]
pub(in crate::cloth) mod work;

use std::sync::atomic::AtomicU64;
use std::time::Instant;

use glam::{Affine3A, Vec3A};
use toile_base::garment::Garment;
use toile_base::garment::layout::OWNERS;
use toile_base::numeric::portable;

use super::forces::root::{Carried, RootStep};
use super::{Cloth, Settings, Step};
use crate::lanes::{Shared, Store};
use crate::workers::{PerShare, PhaseCheck, WorkerPool};
use program::METERED_STAGES;
use work::{StepWork, WorkColumns};

impl Cloth {
    /// One step of the settings' length, both owners' shares on the caller's thread. Another garment than the state's own is refused
    /// and counted ([`guard::GuardEvents::refused`]).
    #[expect(unsafe_code, reason = "the stages of a step are done in their order")]
    pub fn step(&mut self, garment: &Garment, step: &Step<'_>) {
        if !self.accepts(garment) {
            return;
        }
        let settings = self.sound(step.settings);
        let step = &Step { settings: &settings, ..*step };
        let carried = self.begin(garment, step);
        let timed = step.settings.timed;
        let (mut stage_ns, mut greater_share_ns) = ([0; METERED_STAGES.len()], [0; METERED_STAGES.len()]);
        let work = self.work(garment, step, carried);
        let mut begun = timed.then(Instant::now);
        for phase in 0..work.prepared.program.len() {
            let (stage, _) = work.prepared.program.stage(phase);
            let mut greater = 0;
            for owner in 0..OWNERS {
                // SAFETY: the cloth was made of this garment, as was checked above. This thread does the shares one after the other, in
                // the order of the program. `work` borrows the cloth alone.
                unsafe { work.run(phase, owner) };
                if let Some(start) = begun {
                    let now = Instant::now();
                    let share = (now - start).as_nanos() as u64;
                    stage_ns[stage.metered()] += share;
                    greater = greater.max(share);
                    begun = Some(now);
                }
            }
            greater_share_ns[stage.metered()] += greater;
        }
        let limited = work.limited();
        (self.stage_ns, self.greater_share_ns) = (stage_ns, greater_share_ns);
        self.end(garment, step, limited, false);
    }

    /// The same with the pool's workers, an owner's share each: the same bits. A step that is timed is the caller's alone, so
    /// that each share's time is its own.
    #[expect(unsafe_code, reason = "the stages of a step are done in their order")]
    pub fn step_with(&mut self, pool: &mut WorkerPool, garment: &Garment, step: &Step<'_>) {
        if pool.workers() < OWNERS || garment.layout().spans[1].is_empty() || step.settings.timed {
            return self.step(garment, step);
        }
        if !self.accepts(garment) {
            return;
        }
        let settings = self.sound(step.settings);
        let step = &Step { settings: &settings, ..*step };
        let carried = self.begin(garment, step);
        let work = self.work(garment, step, carried);
        let share = |phase: usize, owner: usize| {
            // SAFETY: the cloth was made of this garment, as was checked above. `WorkerPool::run` calls this once for each share of each
            // phase of the program, in their order, and has a barrier after each phase. `work` borrows the cloth alone.
            unsafe { work.run(phase, owner) };
        };
        let failed = pool.run(work.prepared.program.len(), share).is_err();
        let limited = work.limited();
        self.end(garment, step, limited, failed);
    }

    /// Settings that a step can be made with.
    pub(super) fn sound(&mut self, settings: &Settings) -> Settings {
        let sound = settings.sound();
        self.events.held_settings += u64::from(sound != *settings);
        sound
    }

    /// What comes before the phases: targets of the skinned particles, the root's motion, repairs.
    pub(super) fn begin(&mut self, garment: &Garment, step: &Step<'_>) -> Option<Carried> {
        let settings = step.settings;
        self.prepared.make(garment, settings);
        self.events.held_pins += self.pins.attach(garment, step.palette);
        let columns = self.state.columns();
        let width = settings.width;
        // Both are looked at, because both are calmed.
        if !self.checked && [columns.x, columns.v].map(|c| width.run(guard::AllFinite(c))) != [true; 2] {
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
    pub(super) fn end(&mut self, garment: &Garment, step: &Step<'_>, limited: u64, failed: bool) {
        self.events.speed_limited += limited;
        self.events.held_colliders = step.colliders.held();
        let columns = self.state.columns();
        let width = step.settings.width;
        self.checked = !failed && [columns.x, columns.v].map(|c| width.run(guard::AllFinite(c))) == [true; 2];
        if self.checked {
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

    pub(super) fn work<'a>(
        &'a mut self,
        garment: &'a Garment,
        step: &'a Step<'a>,
        carried: Option<Carried>,
    ) -> StepWork<'a> {
        let dt = self.prepared.dt;
        let [one, two] = &mut self.scratch;
        let columns = WorkColumns {
            particles: self.state.columns(),
            acceleration: self.acceleration.columns(),
            tension: self.tension.each_mut().map(Store::column),
            scratch: [one.column(), two.column()],
            records: self.records.column(),
            scratch_columns: self.bending_scratch.columns(),
            friction: self.friction.columns(),
            link_curves: self.link_curves.columns(),
            bias_scratch: self.bias_scratch.columns(),
        };
        StepWork {
            garment,
            step,
            prepared: &self.prepared,
            columns: Shared::new(columns),
            faces: self.faces.as_ref().zip(step.settings.wind),
            carried,
            contacts: PerShare::new(self.contacts.owners()),
            limited: [AtomicU64::new(0), AtomicU64::new(0)],
            pins: &self.pins,
            gravity_step: step.settings.gravity * dt,
            damping_factor: portable::exp(-garment.fabric.damping_per_s * dt),
            width: step.settings.width,
            check: PhaseCheck::default(),
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;
    use toile_bake::{Shape, bake};
    use toile_base::fabric::Fabric;
    use toile_base::skeleton::BONES;

    use super::*;
    use crate::colliders::Colliders;

    #[test]
    fn another_garment_is_refused_and_counted() {
        let place = |r: u32, c: u32| (Vec3::new(0.02 * c as f32, 1.0 - 0.02 * r as f32, 0.0), r == 0);
        let [own, other] = [(); 2].map(|()| {
            bake("sheet", "one", &Shape::sheet(6, 6, place), &Fabric::cotton_lawn()).expect("a sheet can be baked")
        });
        let colliders = Colliders::new(&[], &[], false).expect("no colliders are within every limit");
        let (palette, settings) = ([Affine3A::IDENTITY; BONES], Settings::default());
        let step = Step { palette: &palette, colliders: &colliders, settings: &settings };
        let mut cloth = Cloth::new(&own, &colliders);
        let start = cloth.positions.clone();
        cloth.prepare(&other, &settings);
        cloth.step(&other, &step);
        cloth.step_with(&mut WorkerPool::new(1).expect("one worker is the caller"), &other, &step);
        assert_eq!((cloth.events.refused, &cloth.positions), (3, &start), "an equal garment is another one");
        cloth.step(&own.clone(), &step);
        assert_eq!(cloth.events.refused, 3, "a clone is the same garment");
        assert_ne!(cloth.positions, start);
    }
}
