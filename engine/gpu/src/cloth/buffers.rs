//! Buffers: what the kernels read and write, made once at load; pipelines and what they are bound to.

use toile_assets::limits::MAX_CAPSULES;
use wgpu::{
    BindGroup, BindGroupDescriptor, BindGroupEntry, BindGroupLayout, BindGroupLayoutDescriptor, BindingResource,
    Buffer, BufferBinding, BufferBindingType, BufferUsages, ComputePipeline,
};

use super::constants::Constants;
use super::flat::Flat;
use super::kernels::{Kernel, SHADERS};
use super::program::Program;
use super::touch::{FlatCone, FlatEnds, PLANES};
use crate::device::{Device, Needs};
use crate::maker::{Maker, bound};
use crate::shader::pipeline;

/// Numbers of a garment's report: held at the speed limit, unsound, rolled back in a row, rolled back.
pub const REPORT: usize = 4;

/// All buffers of a scene.
#[derive(Debug)]
pub struct Buffers {
    /// A garment's constants `[garments]`.
    pub garments: Buffer,
    /// Places and inverse masses, where the substep began, velocities `[3 * particles]`.
    pub state: Buffer,
    /// Where each skinned particle is at the start and the end of the step `[2 * targets]`.
    pub targets: Buffer,
    /// Rest length, compliance, gain of the shear links.
    pub shear_measures: Buffer,
    /// The same of the weft links.
    pub weft_measures: Buffer,
    /// Shares of bending stiffness.
    pub scales: Buffer,
    /// What happened to each garment `[garments]`.
    pub reports: Buffer,
    /// Last good places `[particles]`.
    pub good: Buffer,
    /// Capsules, a set for the step and one for each substep of each garment.
    pub cones: Buffer,
    /// Their ends `[garments * MAX_CAPSULES]`.
    pub ends: Buffer,
    /// Planes `[garments * PLANES]`.
    pub planes: Buffer,
    /// Bound to every kernel.
    pub scene: BindGroup,
    /// Each kernel's pipeline and what it alone is bound to, by [`Kernel::number`].
    pub kernels: Vec<(ComputePipeline, BindGroup)>,
    bytes: u64,
}

/// What a scene asks of a device: its largest buffer and dispatch.
pub fn needs(flat: &Flat, program: &Program, sets: usize) -> Needs {
    let sizes = [
        size_of_val(&*flat.start) * 3,
        size_of_val(&*flat.shear.ends),
        size_of_val(&*flat.weft.ends),
        size_of_val(&*flat.diagonals.measures),
        16 * flat.fibers.links,
        48 * flat.lists.index.len(),
        size_of_val(&*flat.bending.terms),
        size_of_val(&*flat.bending.entries),
        16 * flat.bending.items.len(),
        16 * program.groups().len(),
        flat.spans.len() * sets * MAX_CAPSULES * size_of::<FlatCone>(),
    ];
    let workgroups = program.tables.iter().map(|(groups, _)| groups.groups.len() as u32).max().unwrap_or(0);
    Needs { largest: sizes.into_iter().max().unwrap_or(0) as u64, workgroups }
}

impl Buffers {
    /// All of a scene, and the pipelines. `sets` of capsules there are for each garment, one more than substeps.
    pub fn new(device: &Device, flat: &Flat, program: &Program, constants: &[Constants], sets: usize) -> Self {
        let mut make = Maker::new(&device.device);
        let none = BufferUsages::empty();
        let (to, from) = (BufferUsages::COPY_DST, BufferUsages::COPY_DST | BufferUsages::COPY_SRC);
        let still = vec![[0.0f32; 4]; flat.start.len()];
        let state: Vec<[f32; 4]> = flat.start.iter().chain(&flat.start).chain(&still).copied().collect();
        let entry = |e: &super::program::Entry| [program.tables[e.table].1, u32::from(e.fresh), flat.particles, 0];
        let ops = make.uniforms("ops", program.entries().map(entry));
        let moments = make.uniforms("moments", (0..sets as u32).map(|substep| [substep, 0, 0, 0]));
        let groups = make.with("groups", &program.groups(), none);
        let garments = make.with("garments", constants, to);
        let state = make.with("state", &state, from);
        let targets = make.zeros("targets", 2 * flat.targets as usize, 16);
        let shear_measures = make.with("shear measures", &flat.shear.measures, to);
        let weft_measures = make.with("weft measures", &flat.weft.measures, to);
        let scales = make.with("scales", &flat.bending.scales, to);
        let reports = make.zeros("reports", constants.len(), 4 * REPORT);
        let good = make.with("good", &flat.start, from);
        let start = make.with("start", &flat.start, none);
        let pins = make.with("pins", &flat.pins, none);
        let tethers = make.with("tethers", &flat.tethers, none);
        let links = |make: &mut Maker<'_>, ends: &[[u32; 4]]| {
            [make.with("ends", ends, none), make.zeros("tensions", ends.len(), 4)]
        };
        let [shear_ends, shear_tensions] = links(&mut make, &flat.shear.ends);
        let [weft_ends, weft_tensions] = links(&mut make, &flat.weft.ends);
        let heads = make.with("heads", &flat.diagonals.heads, none);
        let leads = make.with("leads", &flat.diagonals.leads, none);
        let leaning = make.with("leaning", &flat.diagonals.measures, none);
        let kept = make.zeros("kept", flat.diagonals.leads.len(), 16);
        let lengths = make.zeros("lengths", flat.diagonals.leads.len(), 4);
        let bundles = make.with("bundles", &flat.fibers.bundles, none);
        let rows = make.with("rows", &flat.fibers.rows, none);
        let measures = make.with("measures", &flat.fibers.measures, none);
        let factors = make.zeros("factors", flat.fibers.links, 16);
        let sides = make.zeros("sides", flat.fibers.links, 8);
        let lists = make.with("lists", &flat.lists.heads, none);
        let index = make.with("index", &flat.lists.index, none);
        let hoops = make.with("hoops", &flat.lists.measures, none);
        let hooped = make.zeros("hooped", 3 * flat.lists.index.len(), 16);
        let count = constants.len();
        let cones = make.zeros("cones", count * sets * MAX_CAPSULES, size_of::<FlatCone>());
        let ends = make.zeros("ends of capsules", count * MAX_CAPSULES, size_of::<FlatEnds>());
        let planes = make.zeros("planes", count * PLANES, 16);
        let reach = make.with("reach", &flat.reach, none);
        let near = make.zeros("near", flat.reach.len(), 8);
        let touch: &[&Buffer] = &[&cones, &ends, &planes, &reach, &near];
        let items = make.with("items", &flat.bending.items, none);
        let terms = make.with("terms", &flat.bending.terms, none);
        let curvatures = make.zeros("curvatures", flat.bending.items.len(), 16);
        let starts = make.with("starts", &flat.bending.starts, none);
        let entries = make.with("entries", &flat.bending.entries, none);
        let own: [&[&Buffer]; Kernel::ALL.len()] = [
            &[&good, &start],
            touch,
            &[&items, &terms, &scales, &curvatures],
            &[&starts, &entries, &items, &terms, &curvatures],
            &[&pins, &targets],
            &[&heads, &leads, &leaning, &kept, &lengths],
            &[&shear_ends, &shear_measures, &shear_tensions],
            &[&weft_ends, &weft_measures, &weft_tensions],
            &[&lists, &index, &hoops, &hooped],
            &[&bundles, &rows, &measures, &factors, &sides],
            &[&tethers],
            touch,
            &[&reports],
            &[&reports],
            &[&reports, &good, &start],
            &[&reports, &good, &start],
        ];
        let bytes = make.bytes();
        let layout = scene_layout(&device.device);
        let kernels = kernels(&device.device, &layout, &own);
        let scene = scene(&device.device, &layout, [&ops, &garments, &groups, &state, &moments]);
        Self {
            garments,
            state,
            targets,
            shear_measures,
            weft_measures,
            scales,
            reports,
            good,
            cones,
            ends,
            planes,
            scene,
            kernels,
            bytes,
        }
    }

    /// Bytes on the device.
    pub fn bytes(&self) -> u64 {
        self.bytes
    }
}

fn scene_layout(device: &wgpu::Device) -> BindGroupLayout {
    let storage = |binding, read_only| bound(binding, BufferBindingType::Storage { read_only }, false);
    let uniform = |binding| bound(binding, BufferBindingType::Uniform, true);
    device.create_bind_group_layout(&BindGroupLayoutDescriptor {
        label: Some("scene"),
        entries: &[uniform(0), storage(1, true), storage(2, true), storage(3, false), uniform(4)],
    })
}

fn scene(device: &wgpu::Device, layout: &BindGroupLayout, buffers: [&Buffer; 5]) -> BindGroup {
    let entries: Vec<_> = (0u32..)
        .zip(buffers)
        .map(|(binding, buffer)| {
            // Of the uniforms one of many.
            let size = if buffer.usage().contains(BufferUsages::UNIFORM) { Some(16) } else { None };
            let size = size.and_then(std::num::NonZeroU64::new);
            BindGroupEntry { binding, resource: BindingResource::Buffer(BufferBinding { buffer, offset: 0, size }) }
        })
        .collect();
    device.create_bind_group(&BindGroupDescriptor { label: Some("scene"), layout, entries: &entries })
}

fn kernels(
    device: &wgpu::Device,
    scene: &BindGroupLayout,
    own: &[&[&Buffer]; Kernel::ALL.len()],
) -> Vec<(ComputePipeline, BindGroup)> {
    let shaders: Vec<_> = SHADERS.iter().map(|s| s.module(device)).collect();
    let pipeline = |kernel: Kernel| {
        let (shader, entry) = kernel.entry();
        let (module, layout) = &shaders[shader];
        let pipeline = pipeline(device, &[Some(scene), Some(layout)], module, entry);
        let entries: Vec<_> = (0u32..)
            .zip(own[kernel.number()])
            .map(|(binding, buffer)| BindGroupEntry { binding, resource: buffer.as_entire_binding() })
            .collect();
        (pipeline, device.create_bind_group(&BindGroupDescriptor { label: Some(entry), layout, entries: &entries }))
    };
    Kernel::ALL.map(pipeline).into()
}
