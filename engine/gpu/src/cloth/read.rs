//! Results that come back from the device, and access for tests: a single kernel, a state written, a state read.

use glam::Vec3A;
use toile_base::garment::Garment;
use toile_engine::cloth::step::guard::{self, InjectedFault};
use wgpu::{Buffer, BufferDescriptor, BufferUsages, ComputePassDescriptor, MapMode};

use super::buffers::REPORT;
use super::flat::GarmentSpan;
use super::kernels::Kernel;
use super::stage_timer::StageTimer;
use super::{Offload, Step};
use crate::device::GpuError;

/// A garment's particles as the device has them.
#[derive(Debug, Clone, PartialEq)]
pub struct Particles {
    /// World positions (m) `[particles]`.
    pub x: Vec<Vec3A>,
    /// Where the substep began (m) `[particles]`.
    pub previous: Vec<Vec3A>,
    /// Velocities (m/s) `[particles]`.
    pub v: Vec<Vec3A>,
}

impl Offload {
    /// Takes in the newest step that has come back, if any; waits for nothing.
    ///
    /// # Errors
    /// [`GpuError::Lost`].
    pub fn take(&mut self) -> Result<(), GpuError> {
        self.opened.device.sound()?;
        // What a driver has to say about it comes by way of the device's own callbacks.
        let _ = self.opened.device.device.poll(wgpu::PollType::Poll);
        let (own, spans) = (&mut self.own, &self.flat.spans);
        let places = 16 * self.flat.particles as usize;
        self.ring.take(|bytes| {
            let (good, rest) = bytes.split_at(places.min(bytes.len()));
            let (speeds, reports) = rest.split_at(places.min(rest.len()));
            let [good, speeds] = [good, speeds].map(bytemuck::cast_slice::<u8, [f32; 4]>);
            let reports: &[[u32; REPORT]] = bytemuck::cast_slice(reports);
            for own in own {
                let (span, report) = (spans[own.place], reports[own.place]);
                let all = span.first as usize..(span.first + span.len) as usize;
                for (to, from) in [(&mut own.positions, good), (&mut own.velocities, speeds)] {
                    to.iter_mut().zip(&from[all.clone()]).for_each(|(to, p)| *to = Vec3A::new(p[0], p[1], p[2]));
                }
                own.events.repaired = report[4].into();
                (own.events.speed_limited, own.events.rolled_back) = (report[0].into(), report[3].into());
            }
        });
        self.meter.iter_mut().for_each(StageTimer::take);
        self.opened.device.answers(self.ring.waiting())
    }

    /// Waits for everything that was sent, and takes in the newest step, also where the ring had no place for it. Never in the
    /// frame.
    ///
    /// # Errors
    /// [`GpuError::Lost`].
    pub fn finish(&mut self) -> Result<(), GpuError> {
        self.arrive()?;
        if self.ring.behind {
            // All places are free now.
            let encoder = self.encoder();
            self.submit(encoder);
            self.arrive()?;
        }
        Ok(())
    }

    /// Waits for what is on its way back, and takes it in.
    fn arrive(&mut self) -> Result<(), GpuError> {
        self.opened.device.done()?;
        // Another thread that polled the device may be about to say that it has come back.
        while self.ring.waiting().is_some() {
            self.opened.device.answers(self.ring.waiting())?;
            std::thread::yield_now();
        }
        self.take()
    }

    /// Puts a garment's particles somewhere, with velocities (m, m/s): how tests and scenes disturb a garment. What is finite is
    /// the last good place as well.
    pub fn disturb(&mut self, garment: usize, x: &[Vec3A], v: &[Vec3A]) {
        self.put(garment, x, v, x);
    }

    /// The same with the last good places (m): of those that are not finite the device keeps its own.
    pub fn put(&mut self, garment: usize, x: &[Vec3A], v: &[Vec3A], good: &[Vec3A]) {
        let own = &mut self.own[garment];
        let span = self.flat.spans[own.place];
        let start = &self.flat.start[span.first as usize..(span.first + span.len) as usize];
        let places: Vec<[f32; 4]> = x.iter().zip(start).map(|(p, s)| [p.x, p.y, p.z, s[3]]).collect();
        let speeds: Vec<[f32; 4]> = v.iter().zip(start).map(|(v, _)| [v.x, v.y, v.z, 0.0]).collect();
        let good: Vec<[f32; 4]> = good.iter().zip(start).map(|(p, _)| [p.x, p.y, p.z, 1.0]).collect();
        let (buffers, queue) = (&self.buffers, &self.opened.device.queue);
        for (part, numbers) in (0..).zip([&places, &places, &speeds]) {
            let at = 16 * u64::from(part * self.flat.particles + span.first);
            queue.write_buffer(&buffers.state, at, bytemuck::cast_slice(numbers));
        }
        let finite = |p: &[f32; 4]| p.iter().all(|n| n.is_finite());
        let mut first = 0;
        for some in good.chunk_by(|a, b| finite(a) == finite(b)) {
            if some.iter().all(finite) {
                let at = 16 * (u64::from(span.first) + first as u64);
                queue.write_buffer(&buffers.good, at, bytemuck::cast_slice(some));
                let to = own.positions[first..].iter_mut();
                to.zip(some).for_each(|(to, p)| *to = Vec3A::new(p[0], p[1], p[2]));
            }
            first += some.len();
        }
    }

    /// Spoils the state between two steps, as a fault of the memory or of the driver would: the numbers that [`guard::spoil`]
    /// picks by `seed`. `Cloth::inject_fault` does the same on the CPU.
    pub fn inject_fault(&mut self, garment: usize, seed: u64) {
        let span = self.flat.spans[self.own[garment].place];
        if span.len == 0 {
            return;
        }
        for (i, what) in guard::spoil(seed, span.len as usize) {
            let at = span.first + i as u32;
            let (first, numbers) = match what {
                InjectedFault::Place(x) => (at, x.extend(self.flat.start[at as usize][3])),
                InjectedFault::Velocity(v) => (2 * self.flat.particles + at, v.extend(0.0)),
            };
            let bytes = numbers.to_array();
            self.opened.device.queue.write_buffer(
                &self.buffers.state,
                16 * u64::from(first),
                bytemuck::cast_slice(&bytes),
            );
        }
    }

    /// Runs the dispatches of one kernel alone, as in one substep, or one stage of it: how a test holds it against its reference. Where a kernel has
    /// several passes in a substep, the first.
    ///
    /// # Errors
    /// As [`Offload::step`].
    pub fn only(
        &mut self,
        kernel: Kernel,
        substep: u32,
        garments: &[&Garment],
        steps: &[Step<'_>],
    ) -> Result<(), GpuError> {
        let Some(first) = steps.first() else { return Ok(()) };
        let settings = first.settings.sound();
        self.prepare(garments, &settings)?;
        self.begin(garments, steps, &settings);
        let mut encoder = self.encoder();
        {
            let pass = ComputePassDescriptor { label: Some("only"), ..Default::default() };
            let mut pass = encoder.begin_compute_pass(&pass);
            let mut done = Vec::new();
            for entry in self.program.entries().filter(|e| e.kernel == kernel) {
                if !done.contains(&entry.table) {
                    done.push(entry.table);
                    self.dispatch(&mut pass, entry, substep, self.own.len());
                }
            }
        }
        self.opened.device.queue.submit([encoder.finish()]);
        self.opened.device.sound()
    }

    /// Reads a garment's particles, and waits for them. Never in the frame.
    ///
    /// # Errors
    /// [`GpuError::Lost`].
    pub fn particles(&self, garment: usize) -> Result<Particles, GpuError> {
        let numbers = self.numbers(&self.buffers.state)?;
        let span = self.flat.spans[self.own[garment].place];
        let part = |part: u32| vectors(&numbers[(part * self.flat.particles) as usize..], span);
        Ok(Particles { x: part(0), previous: part(1), v: part(2) })
    }

    /// Reads the accelerations besides gravity of a garment's particles (m/s2) `[particles]`, and waits for them: the wind's and
    /// the root's, of the last step that had any. Never in the frame.
    ///
    /// # Errors
    /// [`GpuError::Lost`].
    pub fn accelerations(&self, garment: usize) -> Result<Vec<Vec3A>, GpuError> {
        let numbers = self.numbers(&self.buffers.acceleration)?;
        Ok(vectors(&numbers, self.flat.spans[self.own[garment].place]))
    }

    /// All that a buffer holds.
    pub(super) fn numbers(&self, from: &Buffer) -> Result<Vec<[f32; 4]>, GpuError> {
        let usage = BufferUsages::COPY_DST | BufferUsages::MAP_READ;
        let descriptor = BufferDescriptor { label: Some("read"), size: from.size(), usage, mapped_at_creation: false };
        let to = self.opened.device.device.create_buffer(&descriptor);
        let mut encoder = self.encoder();
        encoder.copy_buffer_to_buffer(from, 0, &to, 0, from.size());
        self.opened.device.queue.submit([encoder.finish()]);
        to.map_async(MapMode::Read, .., |_| {});
        self.opened.device.finish();
        self.opened.device.sound()?;
        let bytes = to.get_mapped_range(..).map_err(|e| GpuError::Lost(e.to_string()))?;
        Ok(bytemuck::cast_slice(&bytes).to_vec())
    }
}

/// A garment's part of some vectors.
pub(super) fn vectors(from: &[[f32; 4]], span: GarmentSpan) -> Vec<Vec3A> {
    let own = &from[span.first as usize..(span.first + span.len) as usize];
    own.iter().map(|p| Vec3A::new(p[0], p[1], p[2])).collect()
}
