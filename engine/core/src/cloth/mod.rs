//! Cloth: one garment as particles, stepped at 120 Hz.
//!
//! Reads: a baked `Garment`, the bone palette, the placed colliders. Writes: particle positions and velocities.
//! Budget: 3 ms a step for 6,000 particles on one core ([`STEP_BUDGET_US`]); no allocation after [`Cloth::new`].
//! Thread: physics.

pub mod bending;
pub mod contact;
pub mod fibers;
pub mod guard;
pub mod measure;
pub mod predict;
pub mod settle;
pub mod state;

use glam::{Affine3A, Vec3A};
use toile_assets::garment::Garment;
use toile_assets::limits::STEP_SECONDS;
use toile_assets::skeleton::BONES;

use crate::colliders::Colliders;

/// What a step of one garment may cost (us): a third of the 8,333 us that 120 Hz leaves, so that two garments and the
/// rest of the frame fit beside it.
pub const STEP_BUDGET_US: f32 = 3_000.0;

/// How the cloth is stepped; the same for every garment of a scene.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// Substeps of a step. Small substeps beat many iterations (Macklin et al. 2019, "Small steps in physics
    /// simulation"): every substep solves each constraint once.
    pub substeps: u32,
    /// Acceleration of gravity (m/s2).
    pub gravity: Vec3A,
    /// Speed limit of a particle (m/s): three times a fast arm; what is faster is an error, not cloth.
    pub max_speed: f32,
}

impl Default for Settings {
    fn default() -> Self {
        Self { substeps: 12, gravity: Vec3A::new(0.0, -9.81, 0.0), max_speed: 15.0 }
    }
}

/// What the surroundings do during one step.
#[derive(Debug, Clone, Copy)]
pub struct Step<'a> {
    /// Skin matrices at the end of the step.
    pub palette: &'a [Affine3A; BONES],
    /// The body's spheres and capsules at the start and the end of the step.
    pub colliders: &'a Colliders,
    /// Settings.
    pub settings: &'a Settings,
}

/// The state of one garment. Every array has one entry a particle and is made once.
#[derive(Debug, Clone)]
pub struct Cloth {
    /// World position (m); written by predict, bending, fibers, contact.
    pub positions: Box<[Vec3A]>,
    /// Position at the start of the substep (m); written by predict, and by contact to keep a push from becoming speed.
    pub(crate) previous: Box<[Vec3A]>,
    /// Velocity (m/s); written by settle.
    pub velocities: Box<[Vec3A]>,
    /// Where each skinned particle is at the start of the step (m) `[fixed]`.
    pub(crate) fixed_start: Box<[Vec3A]>,
    /// Where each skinned particle is at the end of the step (m) `[fixed]`.
    pub(crate) fixed_end: Box<[Vec3A]>,
    /// Bit c is set where capsule c may be touched during this step.
    pub(crate) near: Box<[u32]>,
    /// Bit c is set where capsule c can be touched at all.
    pub(crate) reach: Box<[u32]>,
    /// Positions at the end of the last step that was finite (m).
    pub(crate) good: Box<[Vec3A]>,
    /// Room for percentiles.
    pub(crate) scratch: Box<[f32]>,
    /// What happened that should not have.
    pub events: guard::Events,
    placed: bool,
}

impl Cloth {
    /// All storage of a garment, at rest where the garment starts; `colliders` says which capsules are which limb's.
    pub fn new(garment: &Garment, colliders: &Colliders) -> Self {
        let start: Box<[Vec3A]> = garment.start.iter().map(|&p| p.into()).collect();
        let fixed: Box<[Vec3A]> = garment.fixed.iter().map(|&i| start[i as usize]).collect();
        Self {
            previous: start.clone(),
            velocities: vec![Vec3A::ZERO; start.len()].into(),
            fixed_start: fixed.clone(),
            fixed_end: fixed,
            near: vec![0; start.len()].into(),
            reach: garment.parts.iter().map(|&part| contact::reach(part, colliders)).collect(),
            good: start.clone(),
            scratch: vec![0.0; garment.strain_edges.len()].into(),
            events: guard::Events::default(),
            placed: false,
            positions: start,
        }
    }

    /// One step of 1/120 s.
    pub fn step(&mut self, garment: &Garment, step: &Step<'_>) {
        let substeps = step.settings.substeps.max(1);
        let dt = STEP_SECONDS / substeps as f32;
        self.attach(garment, step.palette);
        contact::find_near(self, garment, step);
        for substep in 0..substeps {
            let from = substep as f32 / substeps as f32;
            let to = (substep + 1) as f32 / substeps as f32;
            predict::predict(self, garment, step.settings, dt);
            predict::carry_fixed(self, garment, to);
            bending::solve(self, garment, dt);
            fibers::solve(self, garment, dt);
            contact::solve(self, garment, step.colliders, [from, to]);
            settle::settle(self, garment, step.settings, dt);
        }
        guard::check(self);
    }

    /// Moves the skinned particles' targets on: the end of the last step is the start of this one.
    fn attach(&mut self, garment: &Garment, palette: &[Affine3A; BONES]) {
        self.fixed_start.copy_from_slice(&self.fixed_end);
        for (k, (&i, w)) in garment.fixed.iter().zip(&garment.fixed_weights).enumerate() {
            let rest = garment.start[i as usize].into();
            let mut p = Vec3A::ZERO;
            for (&bone, &weight) in w.bones.iter().zip(&w.weights) {
                p += palette[bone as usize].transform_point3a(rest) * weight;
            }
            self.fixed_end[k] = p;
        }
        if !self.placed {
            self.fixed_start.copy_from_slice(&self.fixed_end);
            self.placed = true;
        }
    }
}
