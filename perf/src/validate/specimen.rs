//! A specimen: one piece of cloth in the engine, stepped and read in the numbers of its shape.

use std::time::Instant;

use glam::{Affine3A, DVec3, Vec4};
use thiserror::Error;
use toile_bake::Shape;
use toile_bake::bake;
use toile_bake::check::MeshError;
use toile_base::garment::Garment;
use toile_base::garment::layout::{Bends, ENDED, Hubs};
use toile_base::numeric::statistics::median_of;
use toile_base::skeleton::BONES;
use toile_engine::cloth::{Cloth, Quality, Settings, Step};
use toile_engine::colliders::{ColliderError, Colliders, RestSphere};
use toile_engine::workers::WorkerPoolError;
use toile_gpu::backend::ClothStepper;
use toile_gpu::cloth_batch::ClothBatch;

use super::mesh;
use super::{CaseSetup, Level};
use crate::oracle::{Oracle, Problem, Solids};

/// Why a case cannot be run.
#[derive(Debug, Error)]
pub enum SpecimenError {
    /// A mesh that cannot be baked.
    #[error("a case's mesh cannot be baked: {0}")]
    Mesh(#[from] MeshError),
    /// Colliders that the engine does not take.
    #[error("a case's colliders are refused: {0}")]
    Colliders(#[from] ColliderError),
    /// Workers that cannot be started.
    #[error(transparent)]
    WorkerPool(#[from] WorkerPoolError),
    /// Sheets that lie too far apart to meet.
    #[error("a case's sheets start too far apart to ever touch; let them start over one another")]
    Apart,
}

/// What a case collides with.
#[derive(Debug, Clone, Default)]
pub struct Surroundings {
    /// Ends of one capsule and its radius (m).
    pub capsule: Option<[DVec3; 2]>,
    /// Its radius (m).
    pub radius: f64,
    /// Planes as unit normal and offset (m).
    pub planes: Vec<Vec4>,
}

impl Surroundings {
    /// As the engine has them; they stand still from the first step on.
    ///
    /// # Errors
    /// Where the engine does not take them.
    pub fn colliders(&self) -> Result<Colliders, ColliderError> {
        let ends = self.capsule.unwrap_or_default();
        let spheres = ends.map(|p| RestSphere { bone: 0, centre: p.as_vec3(), radius: self.radius as f32 });
        let (spheres, capsules): (&[RestSphere], &[[u8; 2]]) =
            if self.capsule.is_some() { (&spheres, &[[0, 1]]) } else { (&[], &[]) };
        let mut colliders = Colliders::new(spheres, capsules, false)?;
        colliders.set_planes(&self.planes)?;
        let placed: Vec<Vec4> = spheres.iter().map(|s| s.centre.extend(s.radius)).collect();
        // Twice: once is where they start, once where they end.
        (0..2).for_each(|_| colliders.place_spheres(&placed));
        Ok(colliders)
    }
}

/// Acceleration of gravity (m/s2), as the engine's settings have it.
pub const G: f64 = 9.81;

/// Time over which the motion of resting cloth is looked at (s): velocities themselves are noise where a substep moves
/// less than f32 resolves.
const REST_S: f64 = 0.25;

/// Farthest that a resting particle drifts in that time (m).
const REST_M: f64 = 2e-6;

/// One stretch link of the garment, as the engine solves it.
#[derive(Debug, Clone, Copy)]
pub struct StretchLink {
    /// Indices of its two particles.
    pub ends: [usize; 2],
    /// Length as cut (m).
    pub rest: f64,
    /// Inverse stiffness (m/N).
    pub compliance: f64,
}

/// One piece of cloth in the engine.
pub struct Specimen {
    /// The baked cloth.
    pub garment: Garment,
    /// State of the garment.
    pub cloth: Cloth,
    /// How it is stepped.
    pub settings: Settings,
    stepper: ClothStepper,
    colliders: Colliders,
    palette: [Affine3A; BONES],
    particle: Vec<usize>,
    times_ns: Vec<u64>,
}

impl Specimen {
    /// Bakes a shape and puts it where it is worn, at rest.
    ///
    /// # Errors
    /// Where the mesh or the colliders cannot be used.
    pub fn new(
        shape: &Shape,
        cloth: &mesh::CaseFabric,
        setup: CaseSetup<'_>,
        surroundings: &Surroundings,
    ) -> Result<Self, SpecimenError> {
        let garment = bake("case", "one size", shape, &cloth.fabric())?;
        let colliders = surroundings.colliders()?;
        let particle = particle_of(&garment);
        Ok(Self {
            cloth: Cloth::new(&garment, &colliders),
            settings: setup.level.settings(&garment),
            stepper: setup.backends.stepper(),
            colliders,
            palette: [Affine3A::IDENTITY; BONES],
            particle,
            times_ns: Vec::new(),
            garment,
        })
    }

    /// Steps once and adds the time that it took.
    pub fn step(&mut self) {
        let Self { garment, cloth, settings, colliders, palette, times_ns, stepper, .. } = self;
        let steps = [Step { palette, colliders, settings }];
        let mut batch = ClothBatch { cloths: std::slice::from_mut(cloth), garments: &[garment], steps: &steps };
        let begun = Instant::now();
        // Without a worker pool there is no worker that could panic.
        let _ = stepper.step(&mut batch, None);
        times_ns.push(begun.elapsed().as_nanos() as u64);
    }

    /// Steps until everything has come to rest, at most so long (s); says whether it has.
    pub fn rest(&mut self, seconds: f64) -> bool {
        for _ in 0..(seconds / REST_S) as u64 {
            let before = self.cloth.positions.clone();
            self.run(REST_S);
            let drift = before.iter().zip(&self.cloth.positions).map(|(p, q)| p.distance(*q)).fold(0.0, f32::max);
            if f64::from(drift) < REST_M {
                return true;
            }
        }
        false
    }

    /// Steps for a time (s).
    pub fn run(&mut self, seconds: f64) {
        let steps = (seconds / f64::from(self.settings.step_seconds)).round() as u64;
        (0..steps).for_each(|_| self.step());
    }

    /// Changes the rate at which motion is damped (1/s).
    pub fn damp(&mut self, per_s: f64) {
        self.garment.fabric_mut().damping_per_s = per_s as f32;
    }

    /// Positions of particles and solids now.
    pub fn seen(&self) -> ParticlePlaces<'_> {
        ParticlePlaces::of(&self.garment, &self.particle, &self.cloth)
    }

    /// Where everything would be at rest: the oracle's equilibrium of the very same garment, searched for from where the
    /// engine has brought it. Nothing where none is found.
    pub fn solved(&self) -> Option<ParticlePlaces<'_>> {
        let mut problem = Problem::of(&self.garment);
        problem.gravity = self.settings.gravity.as_dvec3();
        let start: Vec<DVec3> = self.cloth.positions.iter().map(|p| p.as_dvec3()).collect();
        let solved = Oracle::new(problem).ok()?.equilibrium(&start, &Solids::default()).ok()?;
        Some(ParticlePlaces { garment: &self.garment, particle: &self.particle, at: solved.state.x })
    }

    /// Where a vertex of the shape is (m).
    pub fn at(&self, vertex: usize) -> DVec3 {
        self.cloth.positions[self.particle[vertex]].as_dvec3()
    }

    /// Puts a vertex somewhere, with a velocity.
    pub fn put(&mut self, vertex: usize, at: DVec3, velocity: DVec3) {
        self.cloth.disturb(self.particle[vertex], at.as_vec3a(), velocity.as_vec3a());
    }

    /// Whether a vertex can move.
    pub fn moves(&self, vertex: usize) -> bool {
        self.garment.inverse_mass[self.particle[vertex]] > 0.0
    }

    /// Vertices of the shape.
    pub fn vertices(&self) -> usize {
        self.particle.len()
    }

    /// Mean place of some vertices (m).
    pub fn mean(&self, vertices: impl IntoIterator<Item = usize>) -> DVec3 {
        let (sum, count) = vertices.into_iter().fold((DVec3::ZERO, 0), |(s, n), v| (s + self.at(v), n + 1));
        sum / f64::from(count.max(1))
    }

    /// Mass of the vertices that can move (kg).
    pub fn mass(&self) -> f64 {
        moving_mass(&self.garment)
    }

    /// Energy of motion, weight, stretch and bending (J).
    pub fn energy(&self) -> f64 {
        let place = |i: usize| self.cloth.positions[i].as_dvec3();
        let inverse = self.garment.inverse_mass.iter().enumerate().filter(|(_, w)| **w > 0.0);
        let weight: f64 = inverse.map(|(i, w)| G * place(i).y / f64::from(*w)).sum();
        let stretch =
            |l: StretchLink| (place(l.ends[1]).distance(place(l.ends[0])) - l.rest).powi(2) / (2.0 * l.compliance);
        let stretch: f64 = links(&self.garment).into_iter().map(stretch).sum();
        let layout = self.garment.layout();
        self.cloth.kinetic_energy(&self.garment)
            + weight
            + stretch
            + bent(&layout.bends, place)
            + bent(&layout.skewed, place)
            + hubs_bent(&layout.hubs, place)
    }

    /// Median time of a step (us).
    pub fn step_us(&self) -> f64 {
        median_of(self.times_ns.iter().copied()).map_or(0.0, |ns| ns as f64 * 1e-3)
    }
}

/// Mass of the particles of a garment that can move (kg).
pub fn moving_mass(garment: &Garment) -> f64 {
    garment.inverse_mass.iter().filter(|w| **w > 0.0).map(|w| f64::from(*w).recip()).sum()
}

/// The particle of each vertex of the shape that a garment was baked from.
pub fn particle_of(garment: &Garment) -> Vec<usize> {
    let mut particle = vec![0; garment.particles()];
    garment.source.iter().enumerate().for_each(|(i, vertex)| particle[*vertex as usize] = i);
    particle
}

/// Where the particles of a garment are, read in the numbers of its shape.
pub struct ParticlePlaces<'a> {
    garment: &'a Garment,
    particle: &'a [usize],
    /// Positions (m) `[particles]`.
    at: Vec<DVec3>,
}

impl<'a> ParticlePlaces<'a> {
    /// Of a garment whose vertices are these particles, as its state has them.
    pub fn of(garment: &'a Garment, particle: &'a [usize], cloth: &Cloth) -> Self {
        Self { garment, particle, at: cloth.positions.iter().map(|p| p.as_dvec3()).collect() }
    }

    /// Where a vertex of the shape is (m).
    pub fn at(&self, vertex: usize) -> DVec3 {
        self.at[self.particle[vertex]]
    }

    /// Mean place of some vertices (m).
    pub fn mean(&self, vertices: impl IntoIterator<Item = usize>) -> DVec3 {
        let (sum, count) = vertices.into_iter().fold((DVec3::ZERO, 0), |(s, n), v| (s + self.at(v), n + 1));
        sum / f64::from(count.max(1))
    }

    /// The lowest place (m).
    pub fn lowest(&self) -> f64 {
        self.at.iter().map(|p| p.y).fold(f64::MAX, f64::min)
    }

    /// The force of the links on the fixed vertices for which `chosen` holds, by where they are (N).
    pub fn force_on_fixed(&self, chosen: impl Fn(DVec3) -> bool) -> DVec3 {
        let place = |i: usize| self.at[i];
        let free = |i: usize| self.garment.inverse_mass[i] > 0.0;
        let mut sum = DVec3::ZERO;
        for StretchLink { ends: [a, b], rest, compliance } in links(self.garment) {
            let (fixed, other) = if free(b) { (a, b) } else { (b, a) };
            if free(other) && !free(fixed) && chosen(place(fixed)) {
                let d = place(other) - place(fixed);
                sum += d / d.length() * ((d.length() - rest) / compliance);
            }
        }
        sum
    }
}

/// Every stretch link once.
pub fn links(garment: &Garment) -> Vec<StretchLink> {
    let layout = garment.layout();
    let mut found = Vec::new();
    let mut add = |a: u32, b: u32, rest: f32, compliance: f32| {
        if compliance < ENDED {
            let (rest, compliance) = (f64::from(rest), f64::from(compliance));
            found.push(StretchLink { ends: [a as usize, b as usize], rest, compliance });
        }
    };
    for links in [&layout.shear, &layout.weft] {
        links.tuples.for_each(|at, [a, b]| add(a, b, links.rest[at], links.compliance[at]));
    }
    let bias = &layout.diagonals;
    bias.for_each(|at, [a, b]| add(a, b, bias.rest[at], bias.compliance[at]));
    let fibers = &layout.fibers;
    for bundle in &fibers.bundles {
        let rows = &fibers.rows[bundle.rows.start as usize..bundle.rows.end as usize];
        let places = if bundle.alike { 1 } else { bundle.lanes };
        for (link, pair) in (0..).zip(rows.windows(2)) {
            for lane in 0..pair[1].lanes {
                let at = (bundle.at + link * places + if bundle.alike { 0 } else { lane }) as usize;
                add(pair[0].first + lane, pair[1].first + lane, fibers.rest[at], fibers.compliance[at]);
            }
        }
    }
    let lists = &layout.crossing;
    for list in &lists.lists {
        for link in 0..list.links() {
            for lane in 0..list.lanes {
                let particle = |row: u32| lists.index[(list.first + row % list.rows * list.lanes + lane) as usize];
                let at = (list.at + link * list.lanes + lane) as usize;
                add(particle(link), particle(link + 1), lists.rest[at], lists.compliance[at]);
            }
        }
    }
    found
}

/// Energy of some bending stencils (J).
fn bent<const K: usize>(bends: &Bends<K>, place: impl Fn(usize) -> DVec3) -> f64 {
    let mut sum = 0.0;
    bends.tuples.for_each(|at, v| {
        let terms = (0..K).map(|k| place(v[k] as usize) * f64::from(bends.coefficients[k][at]));
        sum += 0.5 * terms.sum::<DVec3>().length_squared();
    });
    sum
}

/// Energy of bending over whole rings (J).
fn hubs_bent(hubs: &Hubs, place: impl Fn(usize) -> DVec3) -> f64 {
    let mut energy = 0.0;
    hubs.for_each(|_, particles, coefficients| {
        let sums = coefficients.len() / particles.len();
        for sum in 0..sums {
            let terms = particles.iter().zip(coefficients[sum..].iter().step_by(sums));
            energy += 0.5 * terms.map(|(&i, c)| place(i as usize) * f64::from(*c)).sum::<DVec3>().length_squared();
        }
    });
    energy
}

impl Level {
    /// How a garment is stepped at this level.
    pub fn settings(self, garment: &Garment) -> Settings {
        let quality = match self {
            Self::Production(quality) => quality,
            Self::Converged => Quality::Fine,
        };
        let mut settings = Settings { quality, workers: 1, ..Settings::default() };
        if self == Self::Converged {
            settings.substeps = Some(CONVERGED.max(quality.substeps(garment.substeps)));
        }
        settings
    }
}

/// Substeps of the converged setting: six times those of the coarsest garment at `shop`, and as many as f32 allows. A
/// substep moves resting cloth by g dt^2; beyond some 40 a step that is no more than some units in the last place of a
/// position a metre from the origin, and forces come out the worse the more there are.
const CONVERGED: u32 = 32;
