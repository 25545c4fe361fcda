//! Pieces of cloth over one another in the engine, stepped together and read in the numbers of their shapes.

use std::time::Instant;

use glam::{Affine3A, DVec3};
use toile_bake::Shape;
use toile_bake::bake;
use toile_base::garment::Garment;
use toile_base::numeric::statistics::median_of;
use toile_base::skeleton::BONES;
use toile_engine::cloth::contact::garments::GarmentContact;
use toile_engine::cloth::{Cloth, Settings, Step};
use toile_engine::colliders::Colliders;
use toile_engine::workers::WorkerPool;

use super::Level;
use super::case::CaseOutcome;
use super::mesh::CaseFabric;
use super::specimen::{ParticlePlaces, SpecimenError, Surroundings, moving_mass, particle_of};

/// Pieces of cloth over one another, from the lowest upwards. Only the processor steps them: the graphics device has no layers.
pub struct LayeredSpecimen {
    /// The baked pieces, the lowest first.
    garments: Vec<Garment>,
    cloths: Vec<Cloth>,
    /// How all of them are stepped.
    pub settings: Settings,
    /// The bones at the end of the coming step; what is held follows bone 0.
    pub palette: [Affine3A; BONES],
    layers: GarmentContact,
    colliders: Colliders,
    pool: WorkerPool,
    particle: Vec<Vec<usize>>,
    times_ns: Vec<u64>,
}

impl LayeredSpecimen {
    /// Bakes pieces and puts them where they are worn, at rest.
    ///
    /// # Errors
    /// Where a mesh or the colliders cannot be used, or the pieces cannot meet.
    pub fn new(
        pieces: &[(Shape, CaseFabric)],
        level: Level,
        surroundings: &Surroundings,
    ) -> Result<Self, SpecimenError> {
        let baked = pieces.iter().map(|(shape, cloth)| bake("case", "one size", shape, &cloth.fabric()));
        let garments = baked.collect::<Result<Vec<Garment>, _>>()?;
        let colliders = surroundings.colliders()?;
        let most = garments.iter().max_by_key(|g| g.substeps).ok_or(SpecimenError::Apart)?;
        let mut settings = level.settings(most);
        (settings.contact.layers, settings.contact.folds) = (1, 0);
        let layers =
            GarmentContact::new(&garments).filter(|layers| layers.asked(&settings)).ok_or(SpecimenError::Apart)?;
        Ok(Self {
            cloths: garments.iter().map(|g| Cloth::new(g, &colliders)).collect(),
            particle: garments.iter().map(particle_of).collect(),
            palette: [Affine3A::IDENTITY; BONES],
            pool: WorkerPool::new(1)?,
            times_ns: Vec::new(),
            garments,
            settings,
            layers,
            colliders,
        })
    }

    /// Steps once and adds the time that it took.
    ///
    /// # Panics
    /// Where the engine does.
    pub fn step(&mut self) {
        let Self { garments, cloths, settings, palette, layers, colliders, pool, .. } = self;
        let begun = Instant::now();
        let done = layers.step(pool, cloths, garments, &Step { palette, colliders, settings });
        done.expect("a share of the step panicked");
        self.times_ns.push(begun.elapsed().as_nanos() as u64);
    }

    /// Length of a step (s).
    pub fn step_seconds(&self) -> f64 {
        f64::from(self.settings.step_seconds)
    }

    /// Steps for a time (s).
    pub fn run(&mut self, seconds: f64) {
        (0..(seconds / self.step_seconds()).round() as u64).for_each(|_| self.step());
    }

    /// Places of a piece's particles now.
    pub fn seen(&self, piece: usize) -> ParticlePlaces<'_> {
        ParticlePlaces::of(&self.garments[piece], &self.particle[piece], &self.cloths[piece])
    }

    /// Mean place of some vertices of a piece (m).
    pub fn mean(&self, piece: usize, vertices: impl IntoIterator<Item = usize>) -> DVec3 {
        self.seen(piece).mean(vertices)
    }

    /// Vertices of a piece's shape.
    pub fn vertices(&self, piece: usize) -> usize {
        self.particle[piece].len()
    }

    /// Mass of all vertices that can move (kg).
    pub fn mass(&self) -> f64 {
        self.garments.iter().map(moving_mass).sum()
    }

    /// A figure read off it.
    pub fn outcome(&self, got: f64) -> CaseOutcome {
        let us = median_of(self.times_ns.iter().copied()).map_or(0.0, |ns| ns as f64 * 1e-3);
        CaseOutcome {
            step_us: us,
            substeps: self.cloths.iter().map(Cloth::substeps).max().unwrap_or(0),
            bend_kept: self.cloths.iter().map(|c| c.bend_pace().least).fold(1.0, f32::min),
            rolled_back: self.cloths.iter().map(|c| c.events.rolled_back).sum(),
            ..CaseOutcome::none(got)
        }
    }
}
