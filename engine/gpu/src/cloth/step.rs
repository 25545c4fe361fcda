//! One step: what the CPU writes to the device for it, and its dispatches.

use glam::Affine3A;
use toile_base::garment::Garment;
use toile_base::limits::MAX_CAPSULES;
use toile_engine::cloth::Settings;
use toile_engine::cloth::contact::body::ContactSettings;
use toile_engine::cloth::forces::root::RootStep;
use toile_engine::cloth::step::prepared::Prepared;
use wgpu::{CommandEncoder, CommandEncoderDescriptor, ComputePass, ComputePassDescriptor};

use super::buffers::{ClothBuffers, STAGES};
use super::constants::{CARRY, COMPENSATE, DRESS, GarmentConstants, WIND, carried, columns};
use super::contact_data::{self, PLANES};
use super::flat::WIDTH;
use super::kernels::Kernel;
use super::program::Dispatch;
use super::stage_timer::StageTimer;
use super::{Offload, Step, takes};
use crate::buffer_builder::ALIGNED;
use crate::device::GpuError;

impl Offload {
    /// Takes in what has come back, and sends the next step of every garment on its way; waits for nothing. `steps` has
    /// each garment's surroundings in their order; the settings are those of the first.
    ///
    /// # Errors
    /// [`GpuError`]: the device was lost, or the settings ask for too many substeps. Nothing has been sent then, and the
    /// positions are those that came back last.
    pub fn step(&mut self, garments: &[&Garment], steps: &[Step<'_>]) -> Result<(), GpuError> {
        self.take()?;
        let Some(first) = steps.first() else { return Ok(()) };
        let settings = first.settings.sound();
        self.prepare(garments, &settings)?;
        let asked = self.begin(garments, steps, &settings);
        let mut encoder = self.encoder();
        let meter = if settings.timed { self.meter.take() } else { None };
        match meter {
            Some(mut meter) => {
                self.metered(&mut encoder, asked, &mut meter);
                self.submit(encoder);
                meter.ask();
                self.meter = Some(meter);
            }
            None => {
                let descriptor = ComputePassDescriptor { label: Some("step"), ..Default::default() };
                let mut pass = encoder.begin_compute_pass(&descriptor);
                self.entries(asked, |entry, substep, garments| self.dispatch(&mut pass, entry, substep, garments));
                drop(pass);
                self.submit(encoder);
            }
        }
        self.opened.device.sound()
    }

    pub(super) fn encoder(&self) -> CommandEncoder {
        self.opened.device.device.create_command_encoder(&CommandEncoderDescriptor { label: Some("step") })
    }

    /// Sends commands, and what they leave behind them back.
    pub(super) fn submit(&mut self, mut encoder: CommandEncoder) {
        let ClothBuffers { good, state, reports, .. } = &self.buffers;
        let velocities = state.slice(2 * good.size()..3 * good.size());
        let place = self.ring.send(&mut encoder, &[good.slice(..), velocities, reports.slice(..)]);
        self.opened.device.queue.submit([encoder.finish()]);
        if let Some(place) = place {
            self.ring.ask(place);
        }
    }

    /// What depends on the settings, in steps in which they have changed.
    pub(super) fn prepare(&mut self, garments: &[&Garment], settings: &Settings) -> Result<(), GpuError> {
        if self.settings_seen == Some(*settings) {
            return Ok(());
        }
        // Until all is done, the settings are those of no step.
        self.settings_seen = None;
        for (own, garment) in self.own.iter_mut().zip(garments) {
            own.prepared.make(garment, settings);
            own.root.settings = settings.root;
            takes(garment, &own.prepared, self.sets)?;
        }
        for (place, &k) in self.flat.order.iter().enumerate() {
            let (prepared, queue, buffers) = (&self.own[k].prepared, &self.opened.device.queue, &self.buffers);
            for (links, gains, buffer) in [
                (&mut self.flat.shear, &prepared.shear, &buffers.shear_measures),
                (&mut self.flat.weft, &prepared.weft, &buffers.weft_measures),
            ] {
                let range = links.prepare(place, gains);
                queue.write_buffer(buffer, 16 * range.start as u64, bytemuck::cast_slice(&links.measures[range]));
            }
            let range = self.flat.bending.prepare(place, &prepared.matrix);
            let entries = bytemuck::cast_slice(&self.flat.bending.entries[range.clone()]);
            queue.write_buffer(&buffers.bending, 8 * range.start as u64, entries);
            if prepared.bending.stages > 1 {
                let (stages, first) = (stages(prepared), 16 * (place * STAGES) as u64);
                queue.write_buffer(&buffers.stages, first, bytemuck::cast_slice(&stages));
            }
        }
        self.stages =
            self.own.iter().map(|own| own.prepared.bending.stages).filter(|stages| *stages > 1).max().unwrap_or(0);
        for (substep, active) in (0..).zip(&mut self.active) {
            *active = self.own.iter().filter(|own| own.prepared.substeps > substep).count() as u32;
        }
        self.quality = settings.quality;
        self.settings_seen = Some(*settings);
        Ok(())
    }

    /// What comes before the substeps: targets of the skinned particles, the roots.
    pub(super) fn begin(&mut self, garments: &[&Garment], steps: &[Step<'_>], settings: &Settings) -> StepConditions {
        let mut asked = StepConditions { wind: settings.wind.is_some(), ..StepConditions::default() };
        for ((own, garment), step) in self.own.iter_mut().zip(garments).zip(steps) {
            own.events.held_settings += u64::from(*settings != *step.settings);
            own.events.held_pins += own.pins.attach(garment, step.palette);
            own.events.held_colliders = step.colliders.held();
            let root = step.palette[0] * Affine3A::from_translation(own.origin.into());
            let constants = &mut self.constants[own.place];
            // A garment's fabric may change between steps.
            *constants = GarmentConstants::new(garment, &own.prepared, settings);
            constants.root = columns(&step.palette[0]);
            constants.bits &= if own.feels_wind { u32::MAX } else { !WIND };
            match own.root.advance(&root, settings.step_seconds) {
                RootStep::Plain => {}
                RootStep::Carried(felt_less) => {
                    constants.bits |= COMPENSATE;
                    constants.carried = carried(&felt_less);
                    asked.carried = true;
                }
                RootStep::Keep(moved) => {
                    constants.bits |= CARRY;
                    constants.motion = columns(&moved.motion);
                    own.pins.start.iter_mut().for_each(|p| *p = moved.point(*p));
                    own.events.teleports += 1;
                    asked.jumps = true;
                }
                RootStep::Reset => {
                    constants.bits |= DRESS;
                    own.pins.rest();
                    own.events.teleports += 1;
                    asked.jumps = true;
                }
            }
            let first = 2 * self.flat.pins_from[own.place] as usize;
            let places = own.pins.start.iter().zip(&own.pins.end).flat_map(|(a, b)| [a, b]);
            for (to, p) in self.targets[first..].iter_mut().zip(places) {
                *to = [p.x, p.y, p.z, 0.0];
            }
        }
        self.touch(garments, steps, settings);
        self.opened.device.queue.write_buffer(&self.buffers.garments, 0, bytemuck::cast_slice(&self.constants));
        self.opened.device.queue.write_buffer(&self.buffers.targets, 0, bytemuck::cast_slice(&self.targets));
        asked
    }

    /// What each garment may touch, for every substep.
    fn touch(&mut self, garments: &[&Garment], steps: &[Step<'_>], settings: &Settings) {
        let mut first = 0;
        for ((own, garment), step) in self.own.iter_mut().zip(garments).zip(steps) {
            let (place, how) = (own.place, ContactSettings::new(&garment.fabric, settings));
            let count = (1 + own.prepared.substeps as usize) * MAX_CAPSULES;
            let cones = &mut self.cones[first..first + count];
            let ends = &mut self.ends[place * MAX_CAPSULES..][..MAX_CAPSULES];
            let planes = &mut self.planes[place * PLANES..][..PLANES];
            let sound = own.touch.capsules(settings.width, step.colliders, &how, cones, ends);
            let many = contact_data::planes(step.colliders, planes);
            self.constants[place].touch = [(first / MAX_CAPSULES) as u32, sound, many, (place * PLANES) as u32];
            // Only what can be touched takes room, one garment's behind the other's.
            first += if sound != 0 { count } else { 0 };
        }
        let queue = &self.opened.device.queue;
        queue.write_buffer(&self.buffers.cones, 0, bytemuck::cast_slice(&self.cones[..first]));
        queue.write_buffer(&self.buffers.ends, 0, bytemuck::cast_slice(&self.ends));
        queue.write_buffer(&self.buffers.planes, 0, bytemuck::cast_slice(&self.planes));
    }

    /// All dispatches of a step, in their order: what runs, in which substep or stage, over how many garments.
    pub(super) fn entries<'a>(&'a self, asked: StepConditions, mut run: impl FnMut(&'a Dispatch, u32, usize)) {
        let all = self.own.len();
        let before = self.program.before.iter().filter(|entry| asked.runs(entry.kernel));
        before.for_each(|entry| run(entry, 0, all));
        for (substep, &active) in (0..).zip(&self.active).take_while(|(_, active)| **active > 0) {
            self.staged(active as usize, &mut run);
            self.program.each(self.quality).iter().for_each(|entry| run(entry, substep, active as usize));
        }
        self.program.after.iter().for_each(|entry| run(entry, 0, all));
    }

    /// Those of bending that is stiffer than a substep: a turn before the forces of each stage, and one behind the last.
    fn staged<'a>(&'a self, active: usize, run: &mut impl FnMut(&'a Dispatch, u32, usize)) {
        if self.stages == 0 {
            return;
        }
        for stage in 0..=self.stages {
            let entries =
                self.program.stages.iter().filter(|e| stage < self.stages || e.kernel == Kernel::StageCombine);
            entries.for_each(|entry| run(entry, stage, active));
        }
    }

    /// One dispatch over the first garments, in a substep, or in a stage if the kernel has stages.
    pub(super) fn dispatch(&self, pass: &mut ComputePass<'_>, entry: &Dispatch, at: u32, garments: usize) {
        let moment = if entry.kernel.in_stages() { self.sets as u32 + at } else { at };
        let groups = match entry.kernel {
            // An invocation a garment.
            Kernel::UpdateReports => (garments as u32).div_ceil(WIDTH),
            _ => self.program.tables[entry.table].0.of(garments),
        };
        if groups == 0 {
            return;
        }
        pass.set_pipeline(self.opened.pipelines.of(entry.kernel));
        pass.set_bind_group(0, &self.buffers.scene, &[entry.op, moment].map(|k| k * ALIGNED as u32));
        pass.set_bind_group(1, &self.buffers.own[entry.kernel.number()], &[]);
        pass.dispatch_workgroups(groups, 1, 1);
    }

    /// A whole step, a pass for each run of dispatches of one stage.
    fn metered(&self, encoder: &mut CommandEncoder, asked: StepConditions, meter: &mut StageTimer) {
        meter.stages.clear();
        let mut entries = Vec::new();
        self.entries(asked, |entry, substep, garments| entries.push((entry, substep, garments)));
        for run in entries.chunk_by(|a, b| a.0.kernel.stage() == b.0.kernel.stage()) {
            let mut pass = meter.pass(encoder, run[0].0.kernel.stage() as u8);
            run.iter().for_each(|(entry, substep, garments)| self.dispatch(&mut pass, entry, *substep, *garments));
        }
        meter.send(encoder);
    }
}

/// Which dispatches before the substeps a step asks for that not every step does.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct StepConditions {
    /// Whether a root has jumped.
    jumps: bool,
    /// Whether part of a root's motion is compensated.
    carried: bool,
    /// Whether there is wind.
    wind: bool,
}

impl StepConditions {
    /// Whether a kernel is to run.
    fn runs(self, kernel: Kernel) -> bool {
        match kernel {
            Kernel::Teleport => self.jumps,
            Kernel::RootCompensation => self.carried,
            Kernel::Wind | Kernel::WindForces => self.wind,
            _ => true,
        }
    }
}

/// A garment's stages as `shaders/stage_combine.wgsl` has them, and what their forces are multiplied by.
fn stages(p: &Prepared) -> [[f32; 4]; STAGES] {
    // The first stage's forces are those of the place ahead, over the substep.
    let by = |j: usize, forced: f32| if j == 0 { p.dt } else { forced * p.dt * p.dt };
    std::array::from_fn(|j| {
        let s = p.stages[j];
        [s.ahead, s.behind, s.forced, by(j, s.forced)]
    })
}
