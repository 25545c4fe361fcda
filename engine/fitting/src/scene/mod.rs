//! Scenes of a user's own: garments, pins, colliders and settings of a scene file, stepped, timed and measured.
//!
//! Baking 10,000 particles takes under a second.
//!
//! Everything that is particular to the engine stands in [`Runner::new`] and [`Runner::step`].

pub mod contact;
pub mod events;
pub mod reference_time;
pub mod surface;

use std::time::Instant;

use glam::{Affine3A, Vec3, Vec4};
use serde::Serialize;
use thiserror::Error;
use toile_assets::scene_file::{SceneFile, SceneGarment};
use toile_bake::bake;
use toile_bake::check::MeshError;
use toile_base::garment::Garment;
use toile_base::limits::MAX_SPHERES;
use toile_base::numeric::hash;
use toile_base::skeleton::BONES;
use toile_engine::cloth::contact::garments::{GarmentContact, TuckError, tuck_in};
use toile_engine::cloth::step::program::METERED_STAGES;
use toile_engine::cloth::{Cloth, ContactRates, Quality, Settings, Step, Wind, step::measure};
use toile_engine::colliders::{ColliderError, Colliders, RestSphere, RoundCone};
use toile_engine::lanes::Width;
use toile_engine::workers::{WorkerPool, WorkerPoolError};

use crate::heap::{Heap, HeapProbe};

/// In place of a particle: this vertex belongs to no face and stands where it was.
const STANDS: u32 = u32::MAX;

/// One step of so many has its stages timed, which costs some microseconds.
pub const METERED: u64 = 16;

/// Why a scene cannot be run.
#[derive(Debug, Error)]
pub enum RunError {
    /// A mesh that cannot be baked.
    #[error("garment {name}: {source}")]
    Mesh {
        /// Name of the garment.
        name: String,
        /// What is wrong with the mesh.
        source: MeshError,
    },
    /// A garment that cannot be tucked in.
    #[error(transparent)]
    Tuck(#[from] TuckError),
    /// Colliders that the engine does not take.
    #[error(transparent)]
    Colliders(#[from] ColliderError),
    /// The worker pool cannot be started.
    #[error(transparent)]
    WorkerPool(#[from] WorkerPoolError),
}

/// The distribution of a step's time (us).
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct StepTimes {
    /// Median time of a step or stage (us).
    pub p50: f64,
    /// 99th percentile (us).
    pub p99: f64,
    /// 99.9th percentile (us).
    pub p999: f64,
    /// Longest step (us).
    pub max: f64,
}

/// What the measured steps came to. Where a scene has several garments, the worst of them counts in each step.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Figures {
    /// Steps that were measured.
    pub steps: u64,
    /// Time of a step, all garments.
    pub step_us: StepTimes,
    /// Mean over steps of the mean strain (1).
    pub strain_mean: f64,
    /// Mean over steps of the 99th percentile of strain (1).
    pub strain_p99: f64,
    /// Worst strain of any edge in any step (1).
    pub strain_max: f64,
    /// Deepest that any free particle was inside a collider (mm).
    pub penetration_mm: f64,
    /// Share of free particles inside a collider, mean over steps (1).
    pub penetration_fraction: f64,
    /// Kinetic energy of the free particles at the end (J).
    pub kinetic_j: f64,
    /// Most kinetic energy at the end of any step (J).
    pub kinetic_max_j: f64,
    /// Mean time of each stage of a step, all garments (us), in the order of [`METERED_STAGES`]: taken in one step of
    /// [`METERED`], which do not count for `step_us`.
    pub stages_us: [f64; METERED_STAGES.len()],
    /// Allocations a step; none where the program does not count them.
    pub allocations_per_step: Option<f64>,
    /// Bytes of the baked garments and of their states; none where the program does not count them.
    pub memory_bytes: Option<[u64; 2]>,
    /// Vertices that were not finite, counted in each step: none is ever published.
    pub nonfinite: u64,
}

/// A scene in motion.
#[derive(Debug)]
pub struct Runner {
    scene: SceneFile,
    garments: Vec<Garment>,
    cloths: Vec<Cloth>,
    /// The particle of each of the user's vertices, or [`STANDS`] `[garments][user's vertices]`.
    particles: Vec<Box<[u32]>>,
    colliders: Colliders,
    /// Of each garment: where the scene says nothing, substeps differ.
    settings: Vec<Settings>,
    palette: [Affine3A; BONES],
    /// What keeps garments from passing through each other and themselves, where the scene asks for it.
    layers: Option<GarmentContact>,
    /// One worker: the caller.
    pool: WorkerPool,
    steps: u64,
    times_ns: Vec<u64>,
    metered: u64,
    heap: HeapProbe,
    allocations: u64,
    sums: Figures,
}

impl Runner {
    /// Bakes the garments of a scene and puts everything where it starts.
    ///
    /// # Errors
    /// Where a mesh or the colliders cannot be used.
    pub fn new(scene: SceneFile) -> Result<Self, RunError> {
        Self::counting(scene, HeapProbe::none())
    }

    /// The same, counting allocations and memory.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn counting(scene: SceneFile, heap: HeapProbe) -> Result<Self, RunError> {
        let colliders = placed(&scene)?;
        let before = heap.read();
        let garments = bake_all(&scene)?;
        let between = heap.read();
        let ready = |g: &Garment, cloth: Cloth| if scene.wind.is_some() { cloth.in_wind(g) } else { cloth };
        let mut cloths: Vec<Cloth> = garments.iter().map(|g| ready(g, Cloth::new(g, &colliders))).collect();
        for ((cloth, garment), given) in cloths.iter_mut().zip(&garments).zip(&scene.garments) {
            let free = (0..garment.particles()).filter(|i| garment.inverse_mass[*i] > 0.0);
            free.for_each(|i| cloth.disturb(i, garment.start[i].into(), given.velocity.into()));
        }
        let grown = |from: Option<Heap>, to: Option<Heap>| u64::try_from(to?.live_bytes - from?.live_bytes).ok();
        let memory_bytes = grown(before, between).zip(grown(between, heap.read())).map(|(baked, state)| [baked, state]);
        let particles = scene.garments.iter().zip(&garments).map(|(given, baked)| user_order(given, baked)).collect();
        let measured = scene.steps() - (scene.measure_from * scene.step_hz) as u64;
        Ok(Self {
            layers: GarmentContact::new(&garments).filter(|layers| layers.asked(&settings(&scene))),
            pool: WorkerPool::new(1)?,
            settings: garments.iter().map(|_| settings(&scene)).collect(),
            palette: palette(&scene, 0.0),
            times_ns: Vec::with_capacity(measured as usize),
            sums: Figures { memory_bytes, ..Figures::default() },
            metered: 0,
            allocations: 0,
            heap,
            steps: 0,
            particles,
            colliders,
            cloths,
            garments,
            scene,
        })
    }

    /// One step, timed, then measured if the scene's `measure_from` is reached.
    pub fn step(&mut self) {
        let end = (self.steps + 1) as f64 / self.scene.step_hz;
        place(&mut self.colliders, &self.scene, end);
        self.palette = palette(&self.scene, end);
        let metered = self.steps % METERED == METERED / 2;
        self.settings.iter_mut().for_each(|settings| settings.timed = metered);
        let before = self.heap.read();
        let begun = Instant::now();
        let (palette, colliders) = (&self.palette, &self.colliders);
        if let (Some(layers), Some(settings)) = (&mut self.layers, self.settings.first()) {
            let step = Step { palette, colliders, settings };
            // What panicked has said so, and the guard of the next step repairs what it left.
            _ = layers.step(&mut self.pool, &mut self.cloths, &self.garments, &step);
        } else {
            for ((cloth, garment), settings) in self.cloths.iter_mut().zip(&self.garments).zip(&self.settings) {
                cloth.step(garment, &Step { palette, colliders, settings });
            }
        }
        let ns = begun.elapsed().as_nanos() as u64;
        let after = self.heap.read();
        self.steps += 1;
        if end <= self.scene.measure_from {
            return;
        }
        self.allocations += before.zip(after).map_or(0, |(a, b)| b.allocations - a.allocations);
        if metered {
            self.metered += 1;
            let stage_times = self.cloths.iter().map(|cloth| cloth.stage_ns);
            stage_times
                .for_each(|ns| self.sums.stages_us.iter_mut().zip(ns).for_each(|(sum, ns)| *sum += ns as f64 * 1e-3));
        } else {
            self.times_ns.push(ns);
        }
        self.measure();
    }

    fn measure(&mut self) {
        let (mut mean, mut p99, mut kinetic) = (0.0f64, 0.0f64, 0.0);
        let (mut inside, mut free) = (0usize, 0usize);
        for garment in 0..self.garments.len() {
            let (deepest, count) = self.penetration(garment);
            self.sums.penetration_mm = self.sums.penetration_mm.max(f64::from(deepest) * 1e3);
            inside += count;
        }
        for (cloth, garment) in self.cloths.iter_mut().zip(&self.garments) {
            let strain = measure::strain(cloth, garment);
            mean = mean.max(f64::from(strain.mean));
            p99 = p99.max(f64::from(strain.p99));
            self.sums.strain_max = self.sums.strain_max.max(f64::from(strain.max));
            kinetic += cloth.kinetic_energy(garment);
            self.sums.nonfinite += cloth.positions.iter().filter(|p| !p.is_finite()).count() as u64;
            free += garment.inverse_mass.iter().filter(|w| **w > 0.0).count();
        }
        let sums = &mut self.sums;
        sums.steps += 1;
        sums.strain_mean += mean;
        sums.strain_p99 += p99;
        sums.penetration_fraction += inside as f64 / free.max(1) as f64;
        sums.kinetic_j = kinetic;
        sums.kinetic_max_j = sums.kinetic_max_j.max(kinetic);
    }

    /// What the measured steps so far came to.
    pub fn figures(&self) -> Figures {
        let steps = self.sums.steps.max(1) as f64;
        let mut sorted = self.times_ns.clone();
        sorted.sort_unstable();
        let us = |share: f64| {
            let rank = (share * sorted.len() as f64).ceil() as usize;
            sorted.get(rank.saturating_sub(1)).map_or(0.0, |ns| *ns as f64 * 1e-3)
        };
        Figures {
            step_us: StepTimes { p50: us(0.5), p99: us(0.99), p999: us(0.999), max: us(1.0) },
            strain_mean: self.sums.strain_mean / steps,
            strain_p99: self.sums.strain_p99 / steps,
            penetration_fraction: self.sums.penetration_fraction / steps,
            stages_us: self.sums.stages_us.map(|sum| sum / self.metered.max(1) as f64),
            allocations_per_step: self.heap.read().map(|_| self.allocations as f64 / steps),
            ..self.sums
        }
    }

    /// Where the vertices of a garment are now, in the order of the user's mesh (m).
    pub fn positions(&self, garment: usize) -> impl Iterator<Item = Vec3> + '_ {
        let stands = &self.scene.garments[garment].mesh.start;
        let at = &self.cloths[garment].positions;
        let particles = self.particles[garment].iter().zip(stands);
        particles.map(move |(p, stands)| if *p == STANDS { *stands } else { at[*p as usize].into() })
    }

    /// How deep the free particles of a garment are inside of capsules and planes: the deepest (m), 0 if none is, and how many are.
    pub fn penetration(&self, garment: usize) -> (f32, usize) {
        let cones: Vec<RoundCone> = (0..self.colliders.capsules().len()).map(|c| self.colliders.cone(c, 1.0)).collect();
        let particles = self.cloths[garment].positions.iter().zip(&self.garments[garment].inverse_mass);
        let free = particles.filter(|(_, w)| **w > 0.0);
        let depths = free.map(|(p, _)| depth(Vec3::from(*p), &cones, self.colliders.planes(), self.colliders.floor));
        depths.filter(|d| *d > 0.0).fold((0.0, 0), |(deepest, count), d| (f32::max(deepest, d), count + 1))
    }

    /// Steps taken so far.
    pub fn steps(&self) -> u64 {
        self.steps
    }

    /// Time reached (s).
    pub fn time(&self) -> f64 {
        self.steps as f64 / self.scene.step_hz
    }

    /// The scene file that is run.
    pub fn scene(&self) -> &SceneFile {
        &self.scene
    }

    /// The baked garments, in the scene's order.
    pub fn garments(&self) -> &[Garment] {
        &self.garments
    }

    /// State of each garment, in the scene's order.
    pub fn cloths(&self) -> &[Cloth] {
        &self.cloths
    }

    /// What keeps cloth from passing through cloth, where the scene asks for it.
    pub fn layers(&self) -> Option<&GarmentContact> {
        self.layers.as_ref()
    }

    /// What of contact was full, one sentence each.
    pub fn warnings(&self) -> Vec<String> {
        let asked = self.settings.first().is_some_and(|s| s.contact.layers > 0 || s.contact.folds > 0);
        let mut all: Vec<String> =
            contact::too_many(self.garments.len(), self.layers()).filter(|_| asked).into_iter().collect();
        all.extend(self.layers().into_iter().flat_map(|l| contact::ContactReport::from(l.counts()).warnings()));
        all
    }

    /// The colliders as last placed.
    pub fn colliders(&self) -> &Colliders {
        &self.colliders
    }

    /// How each garment is stepped.
    pub fn settings(&self) -> &[Settings] {
        &self.settings
    }

    /// FNV-1a over the bits of positions and velocities, in the order of the shapes' vertices: equal states give equal
    /// hashes in whatever order particles are kept.
    pub fn state_hash(&self) -> u64 {
        let state = |cloth: &Cloth, i: u32| [cloth.positions[i as usize], cloth.velocity(i as usize)];
        let garments = self.cloths.iter().zip(&self.garments);
        let particles = garments.flat_map(|(c, g)| particle_of(g).into_iter().map(move |i| state(c, i)));
        let numbers = particles.flatten().flat_map(|v| v.to_array());
        hash::of_numbers(numbers)
    }
}

/// All garments of a scene.
pub(crate) fn bake_all(scene: &SceneFile) -> Result<Vec<Garment>, RunError> {
    let mut garments: Vec<Garment> = scene.garments.iter().map(baked).collect::<Result<_, _>>()?;
    let mut tucked = (0..garments.len()).filter(|&g| scene.garments[g].tuck);
    tucked.try_for_each(|g| tuck_in(&mut garments, g))?;
    Ok(garments)
}

/// The colliders of a scene where they stand at its start.
pub(crate) fn placed(scene: &SceneFile) -> Result<Colliders, RunError> {
    let mut colliders = colliders(scene)?;
    colliders.step_seconds = scene.step_hz.recip() as f32;
    place(&mut colliders, scene, 0.0);
    Ok(colliders)
}

fn baked(given: &SceneGarment) -> Result<Garment, RunError> {
    let mesh = |source| RunError::Mesh { name: given.name.clone(), source };
    bake(&given.name, "one size", &given.shape, &given.fabric).map_err(mesh)
}

/// The particle of each vertex of a garment's shape.
fn particle_of(garment: &Garment) -> Vec<u32> {
    let mut particle = vec![STANDS; garment.particles()];
    garment.source.iter().zip(0..).for_each(|(vertex, i)| particle[*vertex as usize] = i);
    particle
}

/// The particle of each of the user's vertices.
fn user_order(given: &SceneGarment, baked: &Garment) -> Box<[u32]> {
    let particle = particle_of(baked);
    given.mesh.to_shape.iter().map(|v| particle.get(*v as usize).copied().unwrap_or(STANDS)).collect()
}

/// The engine's settings; what the scene leaves out is as the engine has it. A garment asks for substeps of a step of
/// 1/120 s: a longer step has more of them.
pub(crate) fn settings(scene: &SceneFile) -> Settings {
    let (default, given) = (Settings::default(), &scene.settings);
    let quality = |name: &str| Quality::ALL.into_iter().find(|q| q.name() == name);
    let width = given.lanes.and_then(|n| Width::of(n as usize)).filter(|w| w.available());
    let quality = given.quality.and_then(quality).unwrap_or_default();
    Settings {
        quality,
        substeps: given.substeps,
        step_seconds: scene.step_hz.recip() as f32,
        gravity: scene.gravity.into(),
        max_speed: given.max_speed.unwrap_or(default.max_speed),
        stretch_damping_s: given.stretch_damping.unwrap_or(default.stretch_damping_s),
        wind: scene.wind.map(|w| Wind { velocity: w.velocity.into(), drag: w.drag, lift: w.lift }),
        width: width.unwrap_or(default.width),
        contact: ContactRates::on(given.folds.unwrap_or(false), given.layers.unwrap_or(true), true),
        ..default
    }
}

/// The motion of the pin groups as bones: bone 0 stands.
pub(crate) fn palette(scene: &SceneFile, time: f64) -> [Affine3A; BONES] {
    let mut palette = [Affine3A::IDENTITY; BONES];
    palette[1..].iter_mut().zip(&scene.pins).for_each(|(bone, motion)| *bone = motion.at(time));
    palette
}

fn colliders(scene: &SceneFile) -> Result<Colliders, ColliderError> {
    let still = RestSphere { bone: 0, centre: Vec3::ZERO, radius: 0.0 };
    let spheres = vec![still; scene.colliders.spheres()];
    let plane = |p: &toile_assets::scene_file::ScenePlane| p.normal.extend(p.normal.dot(p.point));
    let planes: Vec<Vec4> = scene.colliders.planes.iter().map(plane).collect();
    // The floor is built into the engine.
    let floor = planes.contains(&Vec4::Y);
    let mut colliders = Colliders::new(&spheres, &scene.colliders.capsules, floor)?;
    colliders.set_planes(&planes.into_iter().filter(|p| *p != Vec4::Y).collect::<Vec<_>>())?;
    Ok(colliders)
}

/// Puts the spheres where their tracks have them.
pub(crate) fn place(colliders: &mut Colliders, scene: &SceneFile, time: f64) {
    let mut spheres = [Vec4::ZERO; MAX_SPHERES];
    let count = scene.colliders.spheres();
    spheres[..count].iter_mut().enumerate().for_each(|(k, s)| *s = scene.colliders.sphere(k, time));
    colliders.place_spheres(&spheres[..count]);
}

/// How deep a point is inside of any collider (m); 0 or less outside of all.
fn depth(p: Vec3, cones: &[RoundCone], planes: &[Vec4], floor: bool) -> f32 {
    let cone = cones.iter().map(|c| -c.distance(p).0).fold(f32::NEG_INFINITY, f32::max);
    let plane = planes.iter().map(|plane| plane.w - plane.truncate().dot(p)).fold(f32::NEG_INFINITY, f32::max);
    cone.max(plane).max(if floor { -p.y } else { f32::NEG_INFINITY })
}

#[cfg(test)]
mod tests;
