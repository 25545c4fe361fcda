//! The cloth on a GPU: all garments of a scene in one set of buffers, a dispatch a phase.
//!
//! Buffers and pipelines are made at load. A frame makes none and waits for nothing; a substep takes some 40 dispatches. It runs on
//! the thread that calls [`Offload::step`], never on the physics thread of a garment that is on the CPU.
//!
//! The phases and their order are those of `toile_engine::cloth::step::program`; docs/gpu.md says which kernel gives the same
//! bits as its reference and which only stays within a bound.

mod buffers;
pub mod cloth_device;
pub mod constants;
mod contact_data;
pub mod flat;
pub mod kernels;
pub mod program;
mod read;
pub mod readback;
mod scene_buffers;
mod stage_timer;
mod step;
pub mod step_work;
mod vertex_sources;

use std::sync::Arc;

use glam::Vec3A;
use toile_base::garment::Garment;
use toile_base::limits::MAX_CAPSULES;
use toile_engine::cloth::forces::root::RootMotion;
use toile_engine::cloth::state::pins::Pins;
use toile_engine::cloth::step::guard::GuardEvents;
use toile_engine::cloth::step::prepared::Prepared;
use toile_engine::cloth::step::settings::MAX_SUBSTEPS;
use toile_engine::cloth::{Cloth, Quality, Settings, centre};
use toile_engine::colliders::Colliders;

use crate::device::{AdapterChoice, Device, DeviceNeeds, GpuError};
use buffers::{ClothBuffers, needs};
use cloth_device::ClothDevice;
use constants::GarmentConstants;
use contact_data::{ContactData, FlatCone, FlatEnds, PLANES};
use flat::Flat;
use program::StepProgram;
use readback::{ReadbackCounts, ReadbackRing};
use stage_timer::StageTimer;

pub use crate::device_work::StageTimes;
pub use kernels::Kernel;

/// The surroundings of one garment during one step.
pub use toile_engine::cloth::Step;

/// One garment's state on the CPU, in the caller's order.
#[derive(Debug)]
struct GarmentState {
    prepared: Prepared,
    pins: Pins,
    touch: ContactData,
    root: RootMotion,
    feels_wind: bool,
    origin: Vec3A,
    /// Its index in the flat scene.
    place: usize,
    positions: Box<[Vec3A]>,
    velocities: Box<[Vec3A]>,
    events: GuardEvents,
}

/// Garments that are stepped on a GPU. All storage is made once.
#[derive(Debug)]
pub struct Offload {
    opened: Arc<ClothDevice>,
    flat: Flat,
    program: StepProgram,
    buffers: ClothBuffers,
    ring: ReadbackRing,
    meter: Option<StageTimer>,
    own: Vec<GarmentState>,
    /// Constants of the garments, in the flat scene's order.
    constants: Vec<GarmentConstants>,
    targets: Vec<[f32; 4]>,
    /// Capsules, `sets` of them for each garment as it lies; their ends; planes.
    cones: Vec<FlatCone>,
    ends: Vec<FlatEnds>,
    planes: Vec<[f32; 4]>,
    sets: usize,
    /// Garments that make a substep, by its number, for the step under way.
    active: Vec<u32>,
    /// The most stages that any garment's bending takes, 0 where all is a force.
    stages: u32,
    quality: Quality,
    settings_seen: Option<Settings>,
}

impl Offload {
    /// Opens a device for these garments and lays them out on it, at rest where each starts; `colliders` say which capsules
    /// of each one's body are which limb's. At load: some tenths of a second, most of them for the pipelines.
    ///
    /// # Errors
    /// [`GpuError`]: no adapter, or limits too small.
    pub fn new(
        choice: &AdapterChoice,
        garments: &[&Garment],
        colliders: &[&Colliders],
        settings: &Settings,
    ) -> Result<Self, GpuError> {
        let laid = SceneLayout::new(garments, colliders, settings, false);
        let opened = ClothDevice::new(choice, laid.needs())?;
        Self::lay(Arc::new(opened), laid, garments, settings)
    }

    /// The same on a device that is open already. At load: some milliseconds a garment.
    ///
    /// # Errors
    /// [`GpuError`]: limits too small.
    pub fn on(
        opened: &Arc<ClothDevice>,
        garments: &[&Garment],
        colliders: &[&Colliders],
        settings: &Settings,
    ) -> Result<Self, GpuError> {
        Self::on_either(opened, garments, colliders, settings, false)
    }

    /// The same on a device that draws the garments too: then normals are kept beside the places, and [`Offload::source`]
    /// tells where both lie.
    ///
    /// # Errors
    /// As [`Offload::on`]; limits too small where the device was opened for less than [`Offload::needs`].
    pub fn drawn(
        opened: &Arc<ClothDevice>,
        garments: &[&Garment],
        colliders: &[&Colliders],
        settings: &Settings,
    ) -> Result<Self, GpuError> {
        Self::on_either(opened, garments, colliders, settings, true)
    }

    /// What a device has to be opened with to step these garments and to draw them. At load: some milliseconds a garment.
    pub fn needs(garments: &[&Garment], colliders: &[&Colliders], settings: &Settings) -> DeviceNeeds {
        SceneLayout::new(garments, colliders, settings, true).needs()
    }

    fn on_either(
        opened: &Arc<ClothDevice>,
        garments: &[&Garment],
        colliders: &[&Colliders],
        settings: &Settings,
        drawn: bool,
    ) -> Result<Self, GpuError> {
        // On a device that is lost no buffer can be made.
        opened.device.sound()?;
        let laid = SceneLayout::new(garments, colliders, settings, drawn);
        opened.device.takes(laid.needs())?;
        Self::lay(Arc::clone(opened), laid, garments, settings)
    }

    fn lay(
        opened: Arc<ClothDevice>,
        laid: SceneLayout,
        garments: &[&Garment],
        settings: &Settings,
    ) -> Result<Self, GpuError> {
        let SceneLayout { flat, program, prepared, sets } = laid;
        let settings = &settings.sound();
        let constants: Vec<GarmentConstants> =
            flat.order.iter().map(|&k| GarmentConstants::new(garments[k], &prepared[k], settings)).collect();
        let buffers = ClothBuffers::new(&opened, &flat, &program, &constants, sets);
        let back = 2 * buffers.good.size() + buffers.reports.size();
        let ring = ReadbackRing::new(&opened.device.device, back);
        let meter = StageTimer::new(&opened.device);
        opened.device.sound()?;
        let own = (0..).zip(garments.iter().zip(prepared)).map(|(k, (garment, prepared))| GarmentState {
            prepared,
            pins: Pins::new(garment),
            touch: ContactData::new(),
            root: RootMotion::new(settings.root),
            feels_wind: true,
            origin: centre(garment),
            place: flat.order.iter().position(|o| *o == k).unwrap_or(k),
            positions: garment.start.iter().map(|p| Vec3A::from(*p)).collect(),
            velocities: vec![Vec3A::ZERO; garment.particles()].into(),
            events: GuardEvents::default(),
        });
        let own = own.collect();
        let targets = vec![[0.0; 4]; 2 * flat.targets as usize];
        let count = garments.len();
        let cones = vec![[[0.0; 4]; 6]; count * sets * MAX_CAPSULES];
        let ends = vec![[[0.0; 4]; 4]; count * MAX_CAPSULES];
        let planes = vec![[0.0; 4]; count * PLANES];
        let active = vec![0; sets - 1];
        Ok(Self {
            opened,
            flat,
            program,
            buffers,
            ring,
            meter,
            own,
            constants,
            targets,
            cones,
            ends,
            planes,
            sets,
            active,
            stages: 0,
            quality: settings.quality,
            settings_seen: None,
        })
    }

    /// The device that steps them.
    pub fn device(&self) -> &Device {
        &self.opened.device
    }

    /// World positions (m) of a garment at the end of the newest step that has come back `[particles]`: always finite.
    pub fn positions(&self, garment: usize) -> &[Vec3A] {
        &self.own[garment].positions
    }

    /// Velocities (m/s) of a garment's particles at the end of the same step `[particles]`.
    pub fn velocities(&self, garment: usize) -> &[Vec3A] {
        &self.own[garment].velocities
    }

    /// What happened to a garment that should not have, counted since it was made: what the device counts as of the same step.
    pub fn events(&self, garment: usize) -> GuardEvents {
        self.own[garment].events
    }

    /// What the device spent on each stage of the last step that was metered and has come back; none where the adapter has no
    /// clock for it, and before such a step (`Settings::timed`).
    pub fn spent(&self) -> Option<StageTimes> {
        self.meter.as_ref().and_then(StageTimer::spent)
    }

    /// What became of the steps' results.
    pub fn tally(&self) -> ReadbackCounts {
        self.ring.tally
    }

    /// Substeps of a step of a garment, as last prepared.
    pub fn substeps(&self, garment: usize) -> u32 {
        self.own[garment].prepared.substeps
    }

    /// Whether these are the garments that it was made for, as far as can be checked, and the settings ask for no more substeps than
    /// it was laid out for.
    pub fn holds(&self, garments: &[&Garment], settings: &Settings) -> bool {
        let settings = settings.sound();
        let fits = |(own, garment): (&GarmentState, &&Garment)| {
            own.positions.len() == garment.particles() && (settings.substeps_of(garment.substeps) as usize) < self.sets
        };
        garments.len() == self.own.len() && self.own.iter().zip(garments).all(fits)
    }

    /// Goes on from where a cloth of the garment is: its last good places, at rest, its skinned particles and its root; in wind
    /// if the cloth was made ready for it.
    pub fn go_on(&mut self, garment: usize, cloth: &Cloth) {
        let rest = vec![Vec3A::ZERO; cloth.positions.len()];
        self.disturb(garment, &cloth.positions, &rest);
        let own = &mut self.own[garment];
        let (pins, root) = cloth.course();
        own.pins.copy(pins);
        own.root = *root;
        own.feels_wind = cloth.feels_wind();
    }

    /// Where a garment's skinned particles and its root were in the last step that was sent: for [`Cloth::follow`].
    pub fn course(&self, garment: usize) -> (&Pins, &RootMotion) {
        let own = &self.own[garment];
        (&own.pins, &own.root)
    }

    /// Bytes on the device, but for what is on its way back.
    pub fn bytes(&self) -> u64 {
        self.buffers.bytes()
    }
}

/// A scene before it is on a device.
struct SceneLayout {
    flat: Flat,
    program: StepProgram,
    prepared: Vec<Prepared>,
    /// Sets of capsules a garment: one more than substeps.
    sets: usize,
}

impl SceneLayout {
    /// Lays garments out; where they are `drawn`, what normals are made of as well.
    fn new(garments: &[&Garment], colliders: &[&Colliders], settings: &Settings, drawn: bool) -> Self {
        let settings = &settings.sound();
        let mut prepared: Vec<Prepared> = garments.iter().map(|g| Prepared::new(g)).collect();
        for (garment, prepared) in garments.iter().zip(&mut prepared) {
            prepared.make(garment, settings);
        }
        let mut flat = Flat::new(garments, colliders);
        if drawn {
            flat.draw(garments);
        }
        let program = StepProgram::new(&flat, prepared.iter().any(Prepared::stiff));
        let sets = 1 + most_substeps(garments, &prepared);
        Self { flat, program, prepared, sets }
    }

    fn needs(&self) -> DeviceNeeds {
        needs(&self.flat, &self.program, self.sets)
    }
}

/// The most substeps that a scene is laid out for: those of the best quality, or what the settings ask for now.
fn most_substeps(garments: &[&Garment], prepared: &[Prepared]) -> usize {
    let best = garments.iter().map(|g| Quality::Fine.substeps(g.substeps));
    let now = prepared.iter().map(|p| p.substeps);
    best.chain(now).max().unwrap_or(1).min(MAX_SUBSTEPS) as usize
}

/// Whether a garment can be stepped here with these settings: whether so many sets of capsules are one for the step and one
/// for each substep.
fn takes(garment: &Garment, prepared: &Prepared, sets: usize) -> Result<(), GpuError> {
    if (prepared.substeps as usize) < sets {
        return Ok(());
    }
    let what = "the settings ask for more substeps than it was laid out for";
    Err(GpuError::Unsupported { garment: garment.name.clone(), what })
}
