//! Skinning on a GPU: all bodies of a scene in one dispatch.
//!
//! Buffers and pipelines are made at load. A frame makes none and waits for nothing; it takes 3 kB a body and one dispatch. It runs
//! on the thread that calls [`Skinning::step`], not on the physics thread, whose skin is `toile_engine::skin`.
//!
//! The arithmetic is that of `toile_engine::skin`, vertex by vertex; docs/gpu.md says where the bits can differ.

mod buffers;
mod device_time;
pub mod flat;
pub mod kernels;
mod read;

use std::ops::Range;

use glam::{Affine3A, Vec3};
use toile_base::skeleton::BONES;
use toile_engine::skin::{Blend, DualQuat, SkinningJob, dual_palette};
use wgpu::{CommandEncoder, CommandEncoderDescriptor, ComputePass, ComputePassDescriptor};

use crate::cloth::flat::Workgroups;
use crate::cloth::readback::{ReadbackCounts, ReadbackRing};
use crate::device::{Device, DeviceNeeds, GpuError};
use crate::vertex_source::VertexSource;
use buffers::SkinBuffers;
use flat::FlatSkins;
use kernels::{ROWS, stride};

/// Bodies that are skinned on a GPU. All storage is made once.
#[derive(Debug)]
pub struct Skinning {
    /// The vertices of each body among all.
    spans: Vec<Range<usize>>,
    groups: Workgroups,
    buffers: SkinBuffers,
    ring: ReadbackRing,
    /// What is sent of the bones `[bodies][BONES][ROWS]`; where a bone needs less, it lies closer.
    palette: Box<[[f32; 4]]>,
    positions: Box<[Vec3]>,
    normals: Box<[Vec3]>,
    /// Whether steps send back what they have made. A renderer that draws from the device's buffers needs none of it.
    pub fetch: bool,
}

/// What these skins ask of a device.
pub fn needs(jobs: &[&SkinningJob]) -> DeviceNeeds {
    of(&FlatSkins::new(jobs))
}

fn of(flat: &FlatSkins) -> DeviceNeeds {
    DeviceNeeds { largest: flat.largest() as u64, workgroups: flat.groups.groups.len() as u32 }
}

impl Skinning {
    /// Lays skins out on a device, at rest; what they give is sent back. At load.
    ///
    /// # Errors
    /// [`GpuError`]: the device was opened with limits below these skins' [`needs`], or was lost.
    pub fn new(device: &Device, jobs: &[&SkinningJob]) -> Result<Self, GpuError> {
        device.sound()?;
        let flat = FlatSkins::new(jobs);
        device.takes(of(&flat))?;
        let buffers = SkinBuffers::new(device, &flat);
        let ring = ReadbackRing::new(&device.device, buffers.positions.size() + buffers.normals.size());
        device.sound()?;
        let three = |numbers: &[[f32; 4]]| numbers.iter().map(|n| Vec3::new(n[0], n[1], n[2])).collect();
        Ok(Self {
            palette: vec![[0.0; 4]; ROWS * BONES * flat.spans.len()].into(),
            positions: three(&flat.positions),
            normals: three(&flat.normals),
            spans: flat.spans,
            groups: flat.groups,
            buffers,
            ring,
            fetch: true,
        })
    }

    /// Takes in what has come back, and poses the bodies, each by its palette, without waiting. With fewer palettes than
    /// bodies the first so many are posed, and the others stay as they are; palettes beyond the bodies are passed over.
    /// As on the CPU, a bone that is not finite spoils the vertices that share runs with its own, and nothing else.
    ///
    /// # Errors
    /// [`GpuError::Lost`]; what came back last stays readable.
    pub fn step(&mut self, device: &Device, blend: Blend, palettes: &[&[Affine3A; BONES]]) -> Result<(), GpuError> {
        self.take(device)?;
        let bodies = palettes.len().min(self.spans.len());
        let numbers = stride(blend) * BONES;
        for (to, palette) in self.palette.chunks_exact_mut(numbers).zip(palettes) {
            match blend {
                Blend::Linear => rows(palette, to),
                Blend::Dual => pairs(&dual_palette(palette), to),
            }
        }
        let sent = bytemuck::cast_slice(&self.palette[..numbers * bodies]);
        device.queue.write_buffer(&self.buffers.palette, 0, sent);
        self.submit(device, blend, bodies);
        device.sound()
    }

    /// One dispatch over the first so many bodies.
    fn submit(&mut self, device: &Device, blend: Blend, bodies: usize) {
        let mut encoder = encoder(device);
        let descriptor = ComputePassDescriptor { label: Some("skin"), ..Default::default() };
        self.dispatch(&mut encoder.begin_compute_pass(&descriptor), blend, bodies);
        self.send(device, encoder, self.fetch);
    }

    /// Sends commands, and lets what they leave behind them come back where that is wanted.
    fn send(&mut self, device: &Device, mut encoder: CommandEncoder, back: bool) {
        let parts = [self.buffers.positions.slice(..), self.buffers.normals.slice(..)];
        let place = if back { self.ring.send(&mut encoder, &parts) } else { None };
        device.queue.submit([encoder.finish()]);
        if let Some(place) = place {
            self.ring.ask(place);
        }
    }

    fn dispatch(&self, pass: &mut ComputePass<'_>, blend: Blend, bodies: usize) {
        let groups = self.groups.of(bodies);
        if groups > 0 {
            pass.set_pipeline(&self.buffers.pipelines[blend as usize]);
            pass.set_bind_group(0, &self.buffers.bound, &[]);
            pass.dispatch_workgroups(groups, 1, 1);
        }
    }

    /// Number of bodies.
    pub fn bodies(&self) -> usize {
        self.spans.len()
    }

    /// Where a body's vertices are in the device's buffers.
    ///
    /// # Panics
    /// Where there is no such body.
    pub fn span(&self, body: usize) -> Range<usize> {
        self.spans[body].clone()
    }

    /// A body's positions and normals on the device, for a renderer there; `None` where there is no such body.
    /// `device` is the one that they were laid out on. A bone that is not finite shows.
    pub fn source(&self, device: &Device, body: usize) -> Option<VertexSource> {
        let span = self.spans.get(body)?;
        let buffers = [&self.buffers.positions, &self.buffers.normals];
        VertexSource::new(device, buffers, span.start as u32, span.len() as u32)
    }

    /// What became of the steps' results.
    pub fn tally(&self) -> ReadbackCounts {
        self.ring.tally
    }

    /// Bytes on the device, but for what is on its way back.
    pub fn bytes(&self) -> u64 {
        self.buffers.bytes
    }
}

fn encoder(device: &Device) -> CommandEncoder {
    device.device.create_command_encoder(&CommandEncoderDescriptor { label: Some("skin") })
}

/// The rows of each bone's matrix.
fn rows(palette: &[Affine3A; BONES], to: &mut [[f32; 4]]) {
    for (to, matrix) in to.chunks_exact_mut(ROWS).zip(palette) {
        let m = matrix.to_cols_array();
        (0..ROWS).for_each(|i| to[i] = [m[i], m[3 + i], m[6 + i], m[9 + i]]);
    }
}

/// Each bone's dual quaternion.
fn pairs(palette: &[DualQuat; BONES], to: &mut [[f32; 4]]) {
    for (to, bone) in to.chunks_exact_mut(2).zip(palette) {
        (to[0], to[1]) = (bone.real.to_array(), bone.dual.to_array());
    }
}
