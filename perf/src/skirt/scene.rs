//! The skirt on its body, ready to be stepped: baked, placed and moved by the scene's clock.

use std::collections::BTreeMap;

use glam::{Affine3A, Vec3, Vec3A, Vec4};
use toile_assets::scene::skirt;
use toile_bake::Shape;
use toile_bake::bake;
use toile_base::garment::Garment;
use toile_base::numeric::hash;
use toile_base::skeleton::BONES;
use toile_engine::cloth::contact::garments::GarmentContact;
use toile_engine::cloth::step::program::METERED_STAGES;
use toile_engine::cloth::{Cloth, Settings, Step};
use toile_engine::colliders::{Colliders, RestSphere};
use toile_engine::workers::WorkerPool;
use toile_fitting::heap::{Heap, HeapProbe};
use toile_fitting::scene::events::ClothEvents;
use toile_fitting::timing;
use toile_gpu::backend::{Backend, Backends, ClothStepper};
use toile_gpu::cloth_batch::ClothBatch;

use super::error::SkirtError;
use super::options::{MAX_GARMENTS, MESH_SEED, SkirtMesh, SkirtOptions};

/// The body's spheres: centre and radius, world (m).
pub type Spheres = [Vec4; skirt::SPHERES];

/// Mean times of a step's stages (us).
pub struct MeteredStages {
    /// Each stage, as far as the engine or the device reports them.
    pub stages_us: BTreeMap<&'static str, f64>,
    /// Of these the greater of the two owners' shares, phase by phase; empty where all is one owner's.
    pub greater_share_us: BTreeMap<&'static str, f64>,
    /// A whole step by the device's own clock, where it has one.
    pub device_us: Option<f64>,
}

/// One or several skirts on one body.
pub struct SkirtScene {
    /// What was asked for.
    pub options: SkirtOptions,
    /// Vertices a side.
    pub side: usize,
    /// The mesh that was baked.
    pub shape: Shape,
    /// The skirt, shared by all cloths.
    pub garment: Garment,
    /// The skirts' states.
    pub cloths: Vec<Cloth>,
    /// The body's spheres as asked for at the end of the coming step; a hard case may change them.
    pub spheres: Spheres,
    /// The bones at the end of the coming step; a hard case may change them.
    pub palette: [Affine3A; BONES],
    /// Steps taken so far.
    pub tick: u64,
    /// Bytes on the heap of the baked garment, and of the states of all skirts, where the program counts them.
    pub memory_bytes: Option<[u64; 2]>,
    settings: Settings,
    colliders: Colliders,
    pool: WorkerPool,
    stepper: ClothStepper,
    /// Those that keep each skirt from passing through itself, where that was asked for `[skirts]`.
    layers: Box<[GarmentContact]>,
}

impl SkirtScene {
    /// The scene at its start.
    ///
    /// # Errors
    /// Where the options cannot be met.
    pub fn new(options: &SkirtOptions, heap: &HeapProbe) -> Result<Self, SkirtError> {
        Self::with(options, heap, |_| {})
    }

    /// The same with a mesh that `change` has changed before it is baked.
    ///
    /// # Errors
    /// Where the options cannot be met.
    pub fn with(options: &SkirtOptions, heap: &HeapProbe, change: impl FnOnce(&mut Shape)) -> Result<Self, SkirtError> {
        Self::by(&Backends::open(options.backend), options, heap, change)
    }

    /// The same by means that are open already.
    ///
    /// # Errors
    /// Where the options cannot be met.
    pub fn by(
        backends: &Backends,
        options: &SkirtOptions,
        heap: &HeapProbe,
        change: impl FnOnce(&mut Shape),
    ) -> Result<Self, SkirtError> {
        let side = options.side()?;
        let settings = options.settings()?;
        let mut shape = match options.mesh {
            SkirtMesh::Grid => skirt::shape(side),
            SkirtMesh::Irregular => skirt::irregular(side, MESH_SEED),
        };
        let mut fabric = skirt::fabric(&shape, options.stretch);
        if options.hysteresis {
            fabric.hysteresis = skirt::LOOPS;
        }
        if options.curves {
            skirt::curves(&mut fabric);
        }
        fabric.buckling = options.buckling;
        change(&mut shape);
        let before = heap.read();
        let garment = bake("skirt", "one", &shape, &fabric)?;
        let baked = heap.read();
        let rest = skirt::JOINTS.map(|(p, r)| RestSphere {
            bone: 0,
            centre: Vec3::from_array(p.map(|x| x as f32)),
            radius: r as f32,
        });
        let colliders = Colliders::new(&rest, &skirt::CAPSULES, false)?;
        let new = || Cloth::new(&garment, &colliders);
        let ready = |cloth: Cloth| if options.wind { cloth.in_wind(&garment) } else { cloth };
        let count = options.garments.clamp(1, MAX_GARMENTS);
        let cloths = (0..count).map(|_| ready(new())).collect();
        let layers = GarmentContact::new(std::slice::from_ref(&garment)).filter(|_| options.folds);
        let between = |a: Option<Heap>, b: Option<Heap>| u64::try_from(b?.live_bytes - a?.live_bytes).ok();
        let memory_bytes = between(before, baked).zip(between(baked, heap.read())).map(|(a, b)| [a, b]);
        let mut scene = Self {
            options: *options,
            side,
            shape,
            garment,
            cloths,
            spheres: [Vec4::ZERO; skirt::SPHERES],
            palette: [Affine3A::IDENTITY; BONES],
            tick: 0,
            memory_bytes,
            settings,
            colliders,
            pool: WorkerPool::new(options.threads)?,
            stepper: backends.stepper(),
            layers: layers.map_or_else(Box::default, |layers| vec![layers; count].into()),
        };
        // Where the body stands at time 0; the first step then sweeps as every other.
        scene.ask();
        scene.colliders.place_spheres(&scene.spheres);
        Ok(scene)
    }

    /// Asks the scene where body and root are at the end of the coming step. Not timed.
    pub fn prepare(&mut self) {
        self.tick += 1;
        self.ask();
        timing::wake(&mut self.pool);
    }

    fn ask(&mut self) {
        let time = self.tick as f64 * f64::from(self.options.step_s);
        self.spheres = skirt::spheres(self.options.motion, time);
        self.palette[0] = skirt::root(self.options.motion, time);
    }

    /// One step of every skirt: what is timed.
    ///
    /// # Panics
    /// Where the engine does.
    pub fn step(&mut self) {
        self.colliders.place_spheres(&self.spheres);
        let step = Step { palette: &self.palette, colliders: &self.colliders, settings: &self.settings };
        for (layers, cloth) in self.layers.iter_mut().zip(&mut self.cloths) {
            let cloths = std::slice::from_mut(cloth);
            let done = layers.step(&mut self.pool, cloths, std::slice::from_ref(&self.garment), &step);
            done.expect("a share of the step panicked");
        }
        if !self.layers.is_empty() {
            return;
        }
        let (garments, steps) = ([&self.garment; MAX_GARMENTS], [step; MAX_GARMENTS]);
        let count = self.cloths.len();
        let mut batch = ClothBatch { cloths: &mut self.cloths, garments: &garments[..count], steps: &steps[..count] };
        let done = self.stepper.step(&mut batch, Some(&mut self.pool));
        done.expect("a share of the step panicked");
    }

    /// What steps the skirts: the device, or the processor.
    pub fn stepper(&self) -> &ClothStepper {
        &self.stepper
    }

    /// Substeps of a step, once one has been taken.
    pub fn substeps(&self) -> u32 {
        self.cloths[0].substeps()
    }

    /// The body as it stood at the start and the end of the last step.
    pub fn colliders(&self) -> &Colliders {
        &self.colliders
    }

    /// How the steps are done.
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// What happened that should not have, to all skirts since the start.
    pub fn events(&self) -> ClothEvents {
        self.cloths.iter().map(|c| ClothEvents::from(c.events)).sum()
    }

    /// Takes some steps more with the meters on, the engine's own or the device's clock; all skirts together.
    pub fn metered_stages(&mut self, steps: usize) -> MeteredStages {
        self.settings.timed = true;
        let (mut sums, mut greater, mut whole) = ([0.0; METERED_STAGES.len()], [0.0; METERED_STAGES.len()], None);
        for _ in 0..steps {
            self.prepare();
            self.step();
            if self.stepper.backend() == Backend::Gpu {
                let Some(spent) = self.stepper.spent() else { continue };
                sums.iter_mut().zip(spent.stages_ns).for_each(|(sum, ns)| *sum += ns);
                whole = Some(whole.unwrap_or(0.0) + spent.whole_ns);
            } else {
                for cloth in &self.cloths {
                    sums.iter_mut().zip(cloth.stage_ns).for_each(|(sum, ns)| *sum += ns as f64);
                    greater.iter_mut().zip(cloth.greater_share_ns).for_each(|(sum, ns)| *sum += ns as f64);
                }
            }
        }
        self.settings.timed = false;
        let mean = 1e-3 / steps as f64;
        let named =
            |sums: [f64; METERED_STAGES.len()]| METERED_STAGES.into_iter().zip(sums.map(|ns| ns * mean)).collect();
        let device_us = whole.map(|ns: f64| ns * mean);
        let shared = !self.garment.layout().spans[1].is_empty();
        let greater_share_us = if shared { named(greater) } else { BTreeMap::new() };
        MeteredStages { stages_us: named(sums), greater_share_us, device_us }
    }

    /// Mass of each particle that moves, 0 of one that is pinned (kg).
    pub fn masses(&self) -> Vec<f64> {
        let mass = |w: &f32| if *w > 0.0 { f64::from(*w).recip() } else { 0.0 };
        self.garment.inverse_mass.iter().map(mass).collect()
    }

    /// Energy of motion of the particles that move, of all skirts (J).
    pub fn kinetic_energy(&self) -> f64 {
        self.cloths.iter().map(|c| c.kinetic_energy(&self.garment)).sum()
    }

    /// The particle that each vertex of the shape became.
    pub fn particle_of(&self) -> Vec<u32> {
        let mut particle = vec![0; self.garment.source.len()];
        self.garment.source.iter().enumerate().for_each(|(p, &v)| particle[v as usize] = p as u32);
        particle
    }

    /// FNV-1a over the bits of all positions and velocities, vertex by vertex of the shape: the same motion has the same
    /// hash in whatever order particles are kept.
    pub fn state_hash(&self) -> u64 {
        let particles = self.particle_of();
        let of = |c: &Cloth, p: u32| [c.positions[p as usize], c.velocity(p as usize)];
        let numbers = self.cloths.iter().flat_map(|c| particles.iter().flat_map(move |&p| of(c, p)));
        hash::of_numbers(numbers.flat_map(|v| v.to_array()))
    }

    /// Puts one particle of the first skirt where it cannot be, as a fault of memory would.
    pub fn spoil(&mut self, particle: usize, position: Vec3A) {
        let velocity = self.cloths[0].velocity(particle);
        self.cloths[0].disturb(particle, position, velocity);
    }
}
