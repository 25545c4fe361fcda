//! Pins: target positions of the skinned particles at the start and at the end of a step.

use glam::{Affine3A, Vec3A};
use toile_base::garment::Garment;
use toile_base::skeleton::BONES;

/// The targets of a garment's skinned particles. All storage is made once.
#[derive(Debug, Clone)]
pub struct Pins {
    /// At the start of the step, world (m) `[fixed]`.
    pub start: Box<[Vec3A]>,
    /// At the end of the step, world (m) `[fixed]`.
    pub end: Box<[Vec3A]>,
    /// Which of them follow each other in memory and have one owner.
    runs: Box<[PinRun]>,
    placed: bool,
}

/// Skinned particles that follow each other.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PinRun {
    /// Owner of all of them.
    pub owner: u8,
    /// The first particle.
    pub first: u32,
    /// Its number among the skinned ones.
    pub number: u32,
    /// How many there are.
    pub len: u32,
}

impl Pins {
    /// Where the garment starts.
    pub fn new(garment: &Garment) -> Self {
        let rest: Box<[Vec3A]> = garment.fixed.iter().map(|&i| garment.start[i as usize].into()).collect();
        let owner = |i: u32| garment.layout().owner[i as usize];
        let follows = |a: &u32, b: &u32| a + 1 == *b && owner(*a) == owner(*b);
        let mut number = 0;
        let runs = garment.fixed.chunk_by(follows).map(|run| {
            let len = run.len() as u32;
            number += len;
            PinRun { owner: owner(run[0]), first: run[0], number: number - len, len }
        });
        let runs = runs.collect();
        Self { start: rest.clone(), end: rest, runs, placed: false }
    }

    /// Those that follow each other.
    pub fn runs(&self) -> &[PinRun] {
        &self.runs
    }

    /// Moves the targets on: the end of the last step is the start of this one, the first step starts where it ends. Gives
    /// how many targets were not finite and therefore not followed.
    pub fn attach(&mut self, garment: &Garment, palette: &[Affine3A; BONES]) -> u64 {
        self.start.copy_from_slice(&self.end);
        let mut held = 0;
        for (k, (&i, w)) in garment.fixed.iter().zip(&garment.fixed_weights).enumerate() {
            let rest = garment.start[i as usize].into();
            let mut p = Vec3A::ZERO;
            // Most follow one bone or two.
            for (&bone, &weight) in w.bones.iter().zip(&w.weights).filter(|(_, weight)| **weight != 0.0) {
                p += palette[bone as usize].transform_point3a(rest) * weight;
            }
            if p.is_finite() {
                self.end[k] = p;
            } else {
                held += 1;
            }
        }
        if !self.placed {
            self.rest();
            self.placed = true;
        }
        held
    }

    /// The step starts where it ends: what is put somewhere else has not been dragged there.
    pub fn rest(&mut self) {
        self.start.copy_from_slice(&self.end);
    }

    /// Takes over the targets of the same garment, where `from` is that.
    pub fn copy(&mut self, from: &Self) {
        if self.start.len() == from.start.len() {
            self.start.copy_from_slice(&from.start);
            self.end.copy_from_slice(&from.end);
            self.placed = from.placed;
        }
    }

    /// Memory that it holds (bytes).
    pub fn bytes(&self) -> usize {
        size_of_val(&*self.start) + size_of_val(&*self.end) + size_of_val(&*self.runs)
    }
}
