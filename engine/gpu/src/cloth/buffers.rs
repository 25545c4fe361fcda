//! Buffers: what the kernels read and write, made once at load, and what each kernel is bound to.

use toile_assets::limits::MAX_CAPSULES;
use toile_engine::cloth::stages;
use wgpu::{BindGroup, Buffer, BufferUsages};

use super::constants::Constants;
use super::flat::Flat;
use super::kernels::Kernel;
use super::opened::Opened;
use super::program::Program;
use super::touch::{FlatCone, FlatEnds, PLANES};
use crate::device::Needs;
use crate::maker::Maker;

/// Numbers of a garment's report: held at the speed limit, unsound, rolled back in a row, rolled back, repaired.
pub const REPORT: usize = 5;

/// Places in the buffer of stages for each garment.
pub const STAGES: usize = stages::MOST as usize;

/// All buffers of a scene.
#[derive(Debug)]
pub struct Buffers {
    /// A garment's constants `[garments]`.
    pub garments: Buffer,
    /// Places and inverse masses, where the substep began, velocities, and where bending may be stiffer than a substep
    /// three more: see `turn.wgsl` `[3 or 6 * particles]`.
    pub state: Buffer,
    /// Where each skinned particle is at the start and the end of the step `[2 * targets]`.
    pub targets: Buffer,
    /// Rest length, compliance, gain of the shear links.
    pub shear_measures: Buffer,
    /// The same of the weft links.
    pub weft_measures: Buffer,
    /// Shares of bending stiffness.
    pub scales: Buffer,
    /// Stages of bending: ahead, behind, forced, what the forces are multiplied by `[garments * STAGES]`; next to nothing
    /// where there are none.
    pub stages: Buffer,
    /// Accelerations besides gravity (m/s2) `[particles]`.
    pub pushed: Buffer,
    /// What happened to each garment `[garments]`.
    pub reports: Buffer,
    /// Last good places `[particles]`.
    pub good: Buffer,
    /// Unit normals `[particles]`, where somebody draws.
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
pub fn needs(flat: &Flat, program: &Program, sets: usize) -> Needs {
    let sizes = [
        size_of_val(&*flat.start) * parts(program),
        size_of_val(&*flat.shear.ends),
        size_of_val(&*flat.weft.ends),
        size_of_val(&*flat.diagonals.measures),
        16 * flat.fibers.links,
        48 * flat.lists.index.len(),
        size_of_val(&*flat.bending.terms),
        size_of_val(&*flat.bending.entries),
        16 * flat.bending.items.len(),
        size_of_val(&*flat.wind.faces),
        16 * program.groups().len(),
        size_of_val(&*flat.faces.meeting),
        16 * flat.faces.corners.len(),
        flat.spans.len() * sets * MAX_CAPSULES * size_of::<FlatCone>(),
    ];
    let workgroups = program.tables.iter().map(|(groups, _)| groups.groups.len() as u32).max().unwrap_or(0);
    Needs { largest: sizes.into_iter().max().unwrap_or(0) as u64, workgroups }
}

/// Parts of the state.
fn parts(program: &Program) -> usize {
    if program.stages.is_empty() { 3 } else { 6 }
}

impl Buffers {
    /// All of a scene, on an open device. `sets` of capsules there are for each garment, one more than substeps.
    pub fn new(opened: &Opened, flat: &Flat, program: &Program, constants: &[Constants], sets: usize) -> Self {
        let (device, pipelines) = (&opened.device.device, &opened.pipelines);
        let mut make = Maker::new(&opened.device);
        let none = BufferUsages::empty();
        let (to, from) = (BufferUsages::COPY_DST, BufferUsages::COPY_DST | BufferUsages::COPY_SRC);
        let still = vec![[0.0f32; 4]; flat.start.len()];
        let stills = (2..parts(program)).flat_map(|_| &still);
        let state: Vec<[f32; 4]> = flat.start.iter().chain(&flat.start).chain(stills).copied().collect();
        let entry = |e: &super::program::Entry| [program.tables[e.table].1, u32::from(e.fresh), flat.particles, 0];
        let ops = make.uniforms("ops", program.entries().map(entry));
        // Substeps, then stages.
        let staged = if program.stages.is_empty() { 0 } else { 1 + STAGES as u32 };
        let substeps = (0..sets as u32).map(|substep| [substep, 0, 0, 0]);
        let moments = make.uniforms("moments", substeps.chain((0..staged).map(|stage| [0, stage, 0, 0])));
        let groups = make.with("groups", &program.groups(), none);
        let garments = make.with("garments", constants, to);
        let state = make.with("state", &state, from);
        let targets = make.zeros("targets", 2 * flat.targets as usize, 16);
        let shear_measures = make.with("shear measures", &flat.shear.measures, to);
        let weft_measures = make.with("weft measures", &flat.weft.measures, to);
        let scales = make.with("scales", &flat.bending.scales, to);
        let stages = make.zeros("stages", if staged == 0 { 0 } else { constants.len() * STAGES }, 16);
        let pushed = make.zeros("pushed", flat.start.len(), 16);
        let faces = make.with("faces", &flat.wind.faces, none);
        let forces = make.zeros("forces", flat.wind.faces.len(), 16);
        let corners = make.with("where faces begin", &flat.wind.starts, none);
        let around = make.with("faces around", &flat.wind.around, none);
        let reports = make.zeros("reports", constants.len(), 4 * REPORT);
        // What is drawn, too.
        let shown = from | BufferUsages::VERTEX;
        let good = make.with("good", &flat.start, shown);
        let normals = make.with("normals", &flat.faces.normals, shown);
        let triangles = make.with("triangles", &flat.faces.corners, none);
        let areas = make.zeros("areas", flat.faces.corners.len(), 16);
        let meet = make.with("where triangles meet", &flat.faces.starts, none);
        let meeting = make.with("meeting", &flat.faces.meeting, none);
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
        let wind: &[&Buffer] = &[&faces, &forces, &corners, &around, &pushed];
        let bending: &[&Buffer] = &[&items, &terms, &scales, &curvatures, &stages];
        let bent: &[&Buffer] = &[&starts, &entries, &items, &terms, &curvatures];
        let own: [&[&Buffer]; Kernel::ALL.len()] = [
            &[&reports, &good],
            &[&good, &start],
            touch,
            wind,
            &[&pushed],
            wind,
            &[&pushed, &stages],
            bending,
            bent,
            bending,
            bent,
            &[&pins, &targets, &pushed],
            &[&heads, &leads, &leaning, &kept, &lengths],
            &[&shear_ends, &shear_measures, &shear_tensions],
            &[&weft_ends, &weft_measures, &weft_tensions],
            &[&lists, &index, &hoops, &hooped],
            &[&bundles, &rows, &measures, &factors, &sides],
            &[&bundles, &rows, &measures, &factors, &sides],
            &[&tethers],
            touch,
            &[&reports],
            &[&reports],
            &[&reports, &good, &start],
            &[&reports, &good, &start],
            &[&triangles, &good, &areas],
            &[&meet, &meeting, &areas, &normals],
        ];
        let bytes = make.bytes();
        let scene = pipelines.scene(device, [&ops, &garments, &groups, &state, &moments]);
        let own = Kernel::ALL.map(|kernel| pipelines.own(device, kernel, own[kernel.number()])).into();
        Self {
            garments,
            state,
            targets,
            shear_measures,
            weft_measures,
            scales,
            stages,
            pushed,
            reports,
            good,
            normals,
            cones,
            ends,
            planes,
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
