//! The skinning kernels' buffers, made once at load; pipelines and bind groups.

use toile_base::skeleton::BONES;
use toile_engine::skin::Blend;
use wgpu::{BindGroup, BindGroupDescriptor, BindGroupEntry, Buffer, BufferUsages, ComputePipeline};

use super::flat::FlatSkins;
use super::kernels::{ROWS, SHADER, entry};
use crate::buffer_builder::BufferBuilder;
use crate::device::Device;
use crate::shader::pipeline;

/// What stays on the device.
#[derive(Debug)]
pub struct SkinBuffers {
    /// Every body's bones: rows of matrices, or dual quaternions, one bone behind the other.
    pub palette: Buffer,
    /// Places (m) in the order of the meshes, 1 behind each `[vertices]`.
    pub positions: Buffer,
    /// Unit normals likewise, 0 behind each `[vertices]`.
    pub normals: Buffer,
    /// Bound to both kernels.
    pub bound: BindGroup,
    /// Of each blend, in the order of [`Blend::ALL`].
    pub pipelines: [ComputePipeline; 2],
    /// Bytes of all buffers.
    pub bytes: u64,
}

impl SkinBuffers {
    /// Of skins that are laid flat.
    pub fn new(opened: &Device, flat: &FlatSkins) -> Self {
        let device = &opened.device;
        let mut make = BufferBuilder::new(opened);
        let (none, drawn) = (BufferUsages::empty(), BufferUsages::VERTEX | BufferUsages::COPY_SRC);
        let groups = make.with("groups of the skin", &flat.groups.groups, none);
        let runs = make.with("runs", &flat.runs, none);
        let vertices = make.with("vertices", &flat.vertices, none);
        let weights = make.with("weights", &flat.weights, none);
        let palette = make.zeros("palette", ROWS * BONES * flat.spans.len(), 16);
        let positions = make.with("skin's positions", &flat.positions, drawn);
        let normals = make.with("skin's normals", &flat.normals, drawn);
        let (module, layout) = SHADER.module(device);
        let all = [&groups, &runs, &vertices, &weights, &palette, &positions, &normals];
        let entries: Vec<_> = (0u32..)
            .zip(all)
            .map(|(binding, buffer)| BindGroupEntry { binding, resource: buffer.as_entire_binding() })
            .collect();
        let bound = BindGroupDescriptor { label: Some("skin"), layout: &layout, entries: &entries };
        let bound = device.create_bind_group(&bound);
        let pipelines = Blend::ALL.map(|blend| pipeline(device, &[Some(&layout)], &module, entry(blend)));
        Self { bytes: make.bytes(), palette, positions, normals, bound, pipelines }
    }
}
