//! Every storage buffer of a scene by name, and which of them each kernel is bound to.

use toile_base::limits::MAX_CAPSULES;
use wgpu::{Buffer, BufferUsages};

use super::constants::GarmentConstants;
use super::contact_data::{FlatCone, FlatEnds, PLANES};
use super::flat::{Flat, FlatBending, FlatDiagonals, FlatFaces, FlatFibers, FlatLinks, FlatLists, FlatWind};
use super::kernels::Kernel;
use super::program::StepProgram;
use crate::buffer_builder::BufferBuilder;

/// Words of a garment's report, as `shaders/report.wgsl` declares it.
pub const REPORT: usize = 5;

/// Places in the buffer of stages for each garment.
pub const STAGES: usize = toile_engine::cloth::forces::stiff_bending::MAX_BENDING_STAGES as usize;

/// Bytes of a vector of four.
const VEC4: usize = 16;

/// Buffers that only kernels use.
const KERNELS_ONLY: BufferUsages = BufferUsages::empty();

/// Buffers that are drawn from and read back.
const DRAWN: BufferUsages = BufferUsages::COPY_DST.union(BufferUsages::COPY_SRC).union(BufferUsages::VERTEX);

/// All storage buffers of a scene; those that [`super::buffers::ClothBuffers`] keeps are described there.
pub struct SceneBuffers {
    pub garments: Buffer,
    pub state: Buffer,
    pub targets: Buffer,
    pub acceleration: Buffer,
    pub reports: Buffer,
    pub good: Buffer,
    /// Position in the rest pose, inverse mass `[particles]`.
    pub start: Buffer,
    /// Index of the target that each particle follows `[particles]`.
    pub pins: Buffer,
    /// Tethers of each particle.
    pub tethers: Buffer,
    pub wind: WindBuffers,
    pub bending: BendingBuffers,
    pub shear: LinkBuffers,
    pub weft: LinkBuffers,
    pub diagonals: DiagonalBuffers,
    pub lists: ListBuffers,
    pub fibers: FiberBuffers,
    pub contact: ContactBuffers,
    pub faces: FaceBuffers,
}

impl SceneBuffers {
    /// Creates all of them. `sets` of capsules there are for each garment, one more than substeps.
    pub fn new(
        make: &mut BufferBuilder<'_>,
        flat: &Flat,
        program: &StepProgram,
        constants: &[GarmentConstants],
        sets: usize,
    ) -> Self {
        let (particles, garments) = (flat.start.len(), constants.len());
        // Positions, previous positions, and zeros for the rest.
        let zeros = vec![[0.0f32; 4]; (state_parts(program) - 2) * particles];
        let state: Vec<[f32; 4]> = flat.start.iter().chain(&flat.start).chain(&zeros).copied().collect();
        let stages = if program.stages.is_empty() { 0 } else { garments * STAGES };
        Self {
            garments: make.with("garments", constants, BufferUsages::COPY_DST),
            state: make.with("state", &state, BufferUsages::COPY_DST | BufferUsages::COPY_SRC),
            targets: make.zeros("targets", 2 * flat.targets as usize, VEC4),
            acceleration: make.zeros("acceleration", particles, VEC4),
            reports: make.zeros("reports", garments, size_of::<u32>() * REPORT),
            good: make.with("good", &flat.start, DRAWN),
            start: make.with("start", &flat.start, KERNELS_ONLY),
            pins: make.with("pins", &flat.pins, KERNELS_ONLY),
            tethers: make.with("tethers", &flat.tethers, KERNELS_ONLY),
            wind: WindBuffers::new(make, &flat.wind),
            bending: BendingBuffers::new(make, &flat.bending, stages),
            shear: LinkBuffers::new(make, &flat.shear),
            weft: LinkBuffers::new(make, &flat.weft),
            diagonals: DiagonalBuffers::new(make, &flat.diagonals),
            lists: ListBuffers::new(make, &flat.lists),
            fibers: FiberBuffers::new(make, &flat.fibers),
            contact: ContactBuffers::new(make, flat, garments, sets),
            faces: FaceBuffers::new(make, &flat.faces),
        }
    }

    /// What a kernel alone is bound to, in the order of its shader's bindings.
    pub fn bound_to(&self, kernel: Kernel) -> Vec<&Buffer> {
        let Self {
            reports, good, start, acceleration, wind, bending, diagonals, lists, fibers, contact, faces, ..
        } = self;
        match kernel {
            Kernel::Repair => vec![reports, good],
            Kernel::Teleport => vec![good, start],
            Kernel::ContactCandidates | Kernel::Contact => {
                vec![&contact.cones, &contact.ends, &contact.planes, &contact.reach, &contact.near]
            }
            Kernel::Wind | Kernel::WindForces => {
                vec![&wind.faces, &wind.forces, &wind.starts, &wind.around, acceleration]
            }
            Kernel::RootCompensation => vec![acceleration],
            Kernel::StageCombine => vec![acceleration, &bending.stages],
            Kernel::StageBending | Kernel::Bending => vec![&bending.starts, &bending.entries, &bending.stages],
            Kernel::Predict => vec![&self.pins, &self.targets, acceleration],
            Kernel::Diagonals => {
                vec![&diagonals.heads, &diagonals.leads, &diagonals.measures, &diagonals.kept, &diagonals.lengths]
            }
            Kernel::Shear => self.shear.bound(),
            Kernel::Weft => self.weft.bound(),
            Kernel::Lists => vec![&lists.heads, &lists.index, &lists.measures, &lists.scratch],
            Kernel::Fibers | Kernel::Cyclic => {
                vec![&fibers.bundles, &fibers.rows, &fibers.measures, &fibers.factors, &fibers.sides]
            }
            Kernel::Tethers => vec![&self.tethers],
            Kernel::Settle | Kernel::Guard => vec![reports],
            Kernel::Publish | Kernel::UpdateReports => vec![reports, good, start],
            Kernel::Faces => vec![&faces.corners, good, &faces.areas],
            Kernel::Normals => vec![&faces.starts, &faces.incident, &faces.areas, &faces.normals],
        }
    }
}

/// Wind: triangles, the force on each, and the triangles around each particle.
pub struct WindBuffers {
    faces: Buffer,
    forces: Buffer,
    starts: Buffer,
    around: Buffer,
}

impl WindBuffers {
    fn new(make: &mut BufferBuilder<'_>, flat: &FlatWind) -> Self {
        Self {
            faces: make.with("wind faces", &flat.faces, KERNELS_ONLY),
            forces: make.zeros("wind forces", flat.faces.len(), VEC4),
            starts: make.with("wind faces of particles, starts", &flat.starts, KERNELS_ONLY),
            around: make.with("wind faces of particles", &flat.around, KERNELS_ONLY),
        }
    }
}

/// Bending: the entries that each particle's force is summed from.
pub struct BendingBuffers {
    starts: Buffer,
    pub entries: Buffer,
    pub stages: Buffer,
}

impl BendingBuffers {
    fn new(make: &mut BufferBuilder<'_>, flat: &FlatBending, stages: usize) -> Self {
        Self {
            starts: make.with("bending entries, starts", &flat.starts, KERNELS_ONLY),
            entries: make.with("bending entries", &flat.entries, BufferUsages::COPY_DST),
            stages: make.zeros("bending stages", stages, VEC4),
        }
    }
}

/// Links of two particles: ends, measures, and the tension of each.
pub struct LinkBuffers {
    ends: Buffer,
    pub measures: Buffer,
    tensions: Buffer,
}

impl LinkBuffers {
    fn new(make: &mut BufferBuilder<'_>, flat: &FlatLinks) -> Self {
        Self {
            ends: make.with("link ends", &flat.ends, KERNELS_ONLY),
            measures: make.with("link measures", &flat.measures, BufferUsages::COPY_DST),
            tensions: make.zeros("link tensions", flat.ends.len(), size_of::<f32>()),
        }
    }

    fn bound(&self) -> Vec<&Buffer> {
        vec![&self.ends, &self.measures, &self.tensions]
    }
}

/// Fibers along the bias.
pub struct DiagonalBuffers {
    heads: Buffer,
    leads: Buffer,
    measures: Buffer,
    kept: Buffer,
    lengths: Buffer,
}

impl DiagonalBuffers {
    fn new(make: &mut BufferBuilder<'_>, flat: &FlatDiagonals) -> Self {
        Self {
            heads: make.with("diagonal heads", &flat.heads, KERNELS_ONLY),
            leads: make.with("diagonal leads", &flat.leads, KERNELS_ONLY),
            measures: make.with("diagonal measures", &flat.measures, KERNELS_ONLY),
            kept: make.zeros("diagonals kept", flat.leads.len(), VEC4),
            lengths: make.zeros("diagonal lengths", flat.leads.len(), size_of::<f32>()),
        }
    }
}

/// Fibers by index list: hoops and crossing fibers.
pub struct ListBuffers {
    heads: Buffer,
    index: Buffer,
    measures: Buffer,
    scratch: Buffer,
}

impl ListBuffers {
    fn new(make: &mut BufferBuilder<'_>, flat: &FlatLists) -> Self {
        Self {
            heads: make.with("list heads", &flat.heads, KERNELS_ONLY),
            index: make.with("list index", &flat.index, KERNELS_ONLY),
            measures: make.with("list measures", &flat.measures, KERNELS_ONLY),
            scratch: make.zeros("list scratch", 3 * flat.index.len(), VEC4),
        }
    }
}

/// Fibers along the warp, in memory of the device.
pub struct FiberBuffers {
    bundles: Buffer,
    rows: Buffer,
    measures: Buffer,
    factors: Buffer,
    sides: Buffer,
}

impl FiberBuffers {
    fn new(make: &mut BufferBuilder<'_>, flat: &FlatFibers) -> Self {
        Self {
            bundles: make.with("fiber bundles", &flat.bundles, KERNELS_ONLY),
            rows: make.with("fiber rows", &flat.rows, KERNELS_ONLY),
            measures: make.with("fiber measures", &flat.measures, KERNELS_ONLY),
            factors: make.zeros("fiber factors", flat.links, VEC4),
            sides: make.zeros("fiber right sides", flat.links, 2 * size_of::<f32>()),
        }
    }
}

/// Contact: capsules, planes, and what each particle may touch in a step.
pub struct ContactBuffers {
    pub cones: Buffer,
    pub ends: Buffer,
    pub planes: Buffer,
    reach: Buffer,
    near: Buffer,
}

impl ContactBuffers {
    fn new(make: &mut BufferBuilder<'_>, flat: &Flat, garments: usize, sets: usize) -> Self {
        Self {
            cones: make.zeros("capsules", garments * sets * MAX_CAPSULES, size_of::<FlatCone>()),
            ends: make.zeros("ends of capsules", garments * MAX_CAPSULES, size_of::<FlatEnds>()),
            planes: make.zeros("planes", garments * PLANES, VEC4),
            reach: make.with("reach", &flat.reach, KERNELS_ONLY),
            near: make.zeros("contact candidates", flat.reach.len(), 2 * size_of::<u32>()),
        }
    }
}

/// Normals for drawing: triangles, their areas, and the triangles that meet at each particle.
pub struct FaceBuffers {
    corners: Buffer,
    areas: Buffer,
    starts: Buffer,
    incident: Buffer,
    pub normals: Buffer,
}

impl FaceBuffers {
    fn new(make: &mut BufferBuilder<'_>, flat: &FlatFaces) -> Self {
        Self {
            corners: make.with("triangles", &flat.corners, KERNELS_ONLY),
            areas: make.zeros("triangle areas", flat.corners.len(), VEC4),
            starts: make.with("triangles of particles, starts", &flat.starts, KERNELS_ONLY),
            incident: make.with("triangles of particles", &flat.incident, KERNELS_ONLY),
            normals: make.with("normals", &flat.normals, DRAWN),
        }
    }
}

/// Parts of the state: positions, previous positions, velocities, and three more where bending goes in stages.
pub(super) fn state_parts(program: &StepProgram) -> usize {
    if program.stages.is_empty() { 3 } else { 6 }
}
