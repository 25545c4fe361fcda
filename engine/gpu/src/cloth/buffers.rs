//! The buffers of a scene that the CPU writes, reads back or binds, made once at load.

use toile_base::limits::MAX_CAPSULES;
use wgpu::{BindGroup, Buffer, BufferUsages};

use super::cloth_device::ClothDevice;
use super::constants::GarmentConstants;
use super::contact_data::FlatCone;
use super::flat::Flat;
use super::kernels::Kernel;
use super::program::StepProgram;
pub use super::scene_buffers::{REPORT, STAGES};
use super::scene_buffers::{SceneBuffers, state_parts};
use crate::buffer_builder::BufferBuilder;
use crate::device::DeviceNeeds;

/// All buffers of a scene.
#[derive(Debug)]
pub struct ClothBuffers {
    /// A garment's constants `[garments]`.
    pub garments: Buffer,
    /// Places and inverse masses, where the substep began, velocities, and where bending may be stiffer than a substep
    /// three more: see `stage_combine.wgsl` `[3 or 6 * particles]`.
    pub state: Buffer,
    /// Where each skinned particle is at the start and the end of the step `[2 * targets]`.
    pub targets: Buffer,
    /// Rest length, compliance, gain of the shear links.
    pub shear_measures: Buffer,
    /// The same of the weft links.
    pub weft_measures: Buffer,
    /// Neighbours and values of the bending matrices' rows.
    pub bending: Buffer,
    /// Stages of bending: ahead, behind, forced, what the forces are multiplied by `[garments * STAGES]`; next to nothing
    /// where there are none.
    pub stages: Buffer,
    /// Accelerations besides gravity (m/s2) `[particles]`.
    pub acceleration: Buffer,
    /// What happened to each garment `[garments]`.
    pub reports: Buffer,
    /// Last good places `[particles]`.
    pub good: Buffer,
    /// Unit normals `[particles]`, for garments that are drawn.
    pub normals: Buffer,
    /// Capsules, a set for the step and one for each substep of each garment.
    pub cones: Buffer,
    /// Their ends `[garments * MAX_CAPSULES]`.
    pub ends: Buffer,
    /// Planes `[garments * PLANES]`.
    pub planes: Buffer,
    /// Bound to every kernel.
    pub scene: BindGroup,
    /// What each kernel alone is bound to, by [`Kernel::number`].
    pub own: Vec<BindGroup>,
    bytes: u64,
}

/// What a scene asks of a device: its largest buffer and dispatch.
pub fn needs(flat: &Flat, program: &StepProgram, sets: usize) -> DeviceNeeds {
    let sizes = [
        size_of_val(&*flat.start) * state_parts(program),
        size_of_val(&*flat.shear.ends),
        size_of_val(&*flat.weft.ends),
        size_of_val(&*flat.diagonals.measures),
        16 * flat.fibers.links,
        48 * flat.lists.index.len(),
        size_of_val(&*flat.bending.entries),
        size_of_val(&*flat.wind.faces),
        16 * program.groups().len(),
        size_of_val(&*flat.faces.incident),
        16 * flat.faces.corners.len(),
        flat.spans.len() * sets * MAX_CAPSULES * size_of::<FlatCone>(),
    ];
    let workgroups = program.tables.iter().map(|(groups, _)| groups.groups.len() as u32).max().unwrap_or(0);
    DeviceNeeds { largest: sizes.into_iter().max().unwrap_or(0) as u64, workgroups }
}

impl ClothBuffers {
    /// All of a scene, on an open device. `sets` of capsules there are for each garment, one more than substeps.
    pub fn new(
        opened: &ClothDevice,
        flat: &Flat,
        program: &StepProgram,
        constants: &[GarmentConstants],
        sets: usize,
    ) -> Self {
        let (device, pipelines) = (&opened.device.device, &opened.pipelines);
        let mut make = BufferBuilder::new(&opened.device);
        let op = |e: &super::program::Dispatch| [program.tables[e.table].1, u32::from(e.fresh), flat.particles, 0];
        let ops = make.uniforms("ops", program.entries().map(op));
        let moments = make.uniforms("moments", moments(program, sets));
        let groups = make.with("groups", &program.groups(), BufferUsages::empty());
        let all = SceneBuffers::new(&mut make, flat, program, constants, sets);
        let bytes = make.bytes();
        let scene = pipelines.scene(device, [&ops, &all.garments, &groups, &all.state, &moments]);
        let own = Kernel::ALL.map(|kernel| pipelines.own(device, kernel, &all.bound_to(kernel))).into();
        Self {
            garments: all.garments,
            state: all.state,
            targets: all.targets,
            shear_measures: all.shear.measures,
            weft_measures: all.weft.measures,
            bending: all.bending.entries,
            stages: all.bending.stages,
            acceleration: all.acceleration,
            reports: all.reports,
            good: all.good,
            normals: all.faces.normals,
            cones: all.contact.cones,
            ends: all.contact.ends,
            planes: all.contact.planes,
            scene,
            own,
            bytes,
        }
    }

    /// Bytes on the device.
    pub fn bytes(&self) -> u64 {
        self.bytes
    }
}

/// The uniform of each substep (its number), then of each stage of bending (its number in the second place).
fn moments(program: &StepProgram, sets: usize) -> impl Iterator<Item = [u32; 4]> {
    let stages = if program.stages.is_empty() { 0 } else { 1 + STAGES as u32 };
    (0..sets as u32).map(|substep| [substep, 0, 0, 0]).chain((0..stages).map(|stage| [0, stage, 0, 0]))
}
