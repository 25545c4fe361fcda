//! One step: what the CPU has to say of it, and its dispatches.

use glam::Affine3A;
use toile_assets::garment::Garment;
use toile_assets::limits::MAX_CAPSULES;
use toile_engine::cloth::Settings;
use toile_engine::cloth::contact::ContactSettings;
use toile_engine::cloth::root::RootStep;
use wgpu::{CommandEncoder, CommandEncoderDescriptor, ComputePass, ComputePassDescriptor};

use super::constants::{CARRY, Constants, DRESS, columns};
use super::flat::{Scale, WIDTH};
use super::kernels::Kernel;
use super::program::Entry;
use super::touch::{self, FlatCone, PLANES};
use super::{Offload, Step, takes};
use crate::device::GpuError;
use crate::maker::ALIGNED;

impl Offload {
    /// Takes in what has come back, and sends the next step of every garment on its way; waits for nothing. `steps` has
    /// each garment's surroundings in their order; the settings are those of the first.
    ///
    /// # Errors
    /// [`GpuError`]: the device was lost, or a setting that only the CPU can take. Nothing has been sent then, and the
    /// positions are those that came back last.
    pub fn step(&mut self, garments: &[&Garment], steps: &[Step<'_>]) -> Result<(), GpuError> {
        self.take()?;
        let Some(first) = steps.first() else { return Ok(()) };
        let settings = first.settings.sound();
        self.prepare(garments, &settings)?;
        let jumps = self.begin(garments, steps, &settings);
        let mut encoder = self.encoder();
        {
            let mut pass =
                encoder.begin_compute_pass(&ComputePassDescriptor { label: Some("step"), ..Default::default() });
            self.encode(&mut pass, jumps);
        }
        self.submit(encoder);
        self.device.sound()
    }

    pub(super) fn encoder(&self) -> CommandEncoder {
        self.device.device.create_command_encoder(&CommandEncoderDescriptor { label: Some("step") })
    }

    /// Sends commands, and what they leave behind them back.
    fn submit(&mut self, mut encoder: CommandEncoder) {
        let place = self.ring.send(&mut encoder, &[&self.buffers.good, &self.buffers.reports]);
        self.device.queue.submit([encoder.finish()]);
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
            takes(garment, &own.prepared, settings)?;
            if own.prepared.substeps as usize >= self.sets {
                let what = "the settings ask for more substeps than it was laid out for";
                return Err(GpuError::Unsupported { garment: garment.name.clone(), what });
            }
        }
        for (place, &k) in self.flat.order.iter().enumerate() {
            let (prepared, queue, buffers) = (&self.own[k].prepared, &self.device.queue, &self.buffers);
            for (links, gain, buffer) in [
                (&mut self.flat.shear, &prepared.shear_gain, &buffers.shear_measures),
                (&mut self.flat.weft, &prepared.weft_gain, &buffers.weft_measures),
            ] {
                let range = links.prepare(place, gain);
                queue.write_buffer(buffer, 16 * range.start as u64, bytemuck::cast_slice(&links.measures[range]));
            }
            let range = self.flat.bending.prepare(place, |scale| match scale {
                Scale::Bend(at) => prepared.bend_scale[at as usize],
                Scale::Skewed(at) => prepared.skewed_scale[at as usize],
                Scale::Hub(number) => prepared.hub_scale[number as usize],
            });
            let scales = bytemuck::cast_slice(&self.flat.bending.scales[range.clone()]);
            queue.write_buffer(&buffers.scales, 4 * range.start as u64, scales);
            self.constants[place] = Constants::new(garments[k], prepared, settings);
        }
        for (substep, active) in (0..).zip(&mut self.active) {
            *active = self.constants.iter().filter(|c| c.substeps > substep).count() as u32;
        }
        self.quality = settings.quality;
        self.settings_seen = Some(*settings);
        Ok(())
    }

    /// What comes before the substeps: targets of the skinned particles, the roots. Gives whether any root has jumped.
    pub(super) fn begin(&mut self, garments: &[&Garment], steps: &[Step<'_>], settings: &Settings) -> bool {
        let mut jumps = false;
        for ((own, garment), step) in self.own.iter_mut().zip(garments).zip(steps) {
            own.report.held_pins += own.pins.attach(garment, step.palette);
            let root = step.palette[0] * Affine3A::from_translation(own.origin.into());
            let constants = &mut self.constants[own.place];
            constants.bits &= !(DRESS | CARRY);
            constants.root = columns(&step.palette[0]);
            match own.root.advance(&root, settings.step_seconds) {
                RootStep::Plain | RootStep::Carried(_) => {}
                RootStep::Keep(moved) => {
                    constants.bits |= CARRY;
                    constants.motion = columns(&moved.motion);
                    own.pins.start.iter_mut().for_each(|p| *p = moved.point(*p));
                    jumps = true;
                }
                RootStep::Reset => {
                    constants.bits |= DRESS;
                    own.pins.rest();
                    jumps = true;
                }
            }
            let first = 2 * self.flat.pins_from[own.place] as usize;
            let places = own.pins.start.iter().zip(&own.pins.end).flat_map(|(a, b)| [a, b]);
            for (to, p) in self.targets[first..].iter_mut().zip(places) {
                *to = [p.x, p.y, p.z, 0.0];
            }
        }
        self.touch(garments, steps, settings);
        self.device.queue.write_buffer(&self.buffers.garments, 0, bytemuck::cast_slice(&self.constants));
        self.device.queue.write_buffer(&self.buffers.targets, 0, bytemuck::cast_slice(&self.targets));
        jumps
    }

    /// What each garment may touch, for every substep.
    fn touch(&mut self, garments: &[&Garment], steps: &[Step<'_>], settings: &Settings) {
        let queue = &self.device.queue;
        for ((own, garment), step) in self.own.iter_mut().zip(garments).zip(steps) {
            let (place, how) = (own.place, ContactSettings::new(&garment.fabric, settings));
            let first = place * self.sets * MAX_CAPSULES;
            let count = (1 + own.prepared.substeps as usize) * MAX_CAPSULES;
            let cones = &mut self.cones[first..first + count];
            let ends = &mut self.ends[place * MAX_CAPSULES..][..MAX_CAPSULES];
            let planes = &mut self.planes[place * PLANES..][..PLANES];
            let sound = own.touch.capsules(settings.width, step.colliders, &how, cones, ends);
            let many = touch::planes(step.colliders, planes);
            self.constants[place].touch = [(place * self.sets) as u32, sound, many, (place * PLANES) as u32];
            if sound != 0 {
                let at = (first * size_of::<FlatCone>()) as u64;
                queue.write_buffer(&self.buffers.cones, at, bytemuck::cast_slice(cones));
            }
        }
        queue.write_buffer(&self.buffers.ends, 0, bytemuck::cast_slice(&self.ends));
        queue.write_buffer(&self.buffers.planes, 0, bytemuck::cast_slice(&self.planes));
    }

    /// All dispatches of a step.
    fn encode(&self, pass: &mut ComputePass<'_>, jumps: bool) {
        let all = self.own.len();
        if jumps {
            self.program.jump.iter().for_each(|entry| self.dispatch(pass, entry, 0, all));
        }
        self.program.before.iter().for_each(|entry| self.dispatch(pass, entry, 0, all));
        for (substep, &active) in (0..).zip(&self.active).take_while(|(_, active)| **active > 0) {
            for entry in self.program.each(self.quality) {
                self.dispatch(pass, entry, substep, active as usize);
            }
        }
        self.program.after.iter().for_each(|entry| self.dispatch(pass, entry, 0, all));
    }

    /// One dispatch over the first so many garments.
    pub(super) fn dispatch(&self, pass: &mut ComputePass<'_>, entry: &Entry, substep: u32, garments: usize) {
        let groups = match entry.kernel {
            // An invocation a garment.
            Kernel::Conclude => (garments as u32).div_ceil(WIDTH),
            _ => self.program.tables[entry.table].0.of(garments),
        };
        if groups == 0 {
            return;
        }
        let (pipeline, own) = &self.buffers.kernels[entry.kernel.number()];
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, &self.buffers.scene, &[entry.op, substep].map(|k| k * ALIGNED as u32));
        pass.set_bind_group(1, own, &[]);
        pass.dispatch_workgroups(groups, 1, 1);
    }
}
