//! The state of one garment as columns: a number a particle, padded and aligned for the widest lanes.

use glam::{Vec3, Vec3A};

use crate::lanes::{Column, Store};

/// Owns the columns.
#[derive(Debug, Clone)]
pub struct State {
    /// World position (m).
    pub position: [Store; 3],
    /// Position at the start of the substep (m).
    pub previous: [Store; 3],
    /// Velocity (m/s).
    pub velocity: [Store; 3],
    /// Inverse mass (1/kg), 0 where the body carries the particle.
    pub weight: Store,
}

/// The columns as kernels see them.
#[derive(Clone, Copy)]
pub struct Columns<'a> {
    /// World position (m).
    pub x: [Column<'a>; 3],
    /// Position at the start of the substep (m); contact moves it so that a push does not become speed.
    pub previous: [Column<'a>; 3],
    /// Velocity (m/s).
    pub v: [Column<'a>; 3],
    /// Inverse mass (1/kg).
    pub w: Column<'a>,
}

impl State {
    /// At rest at these positions.
    pub fn new(positions: &[Vec3], inverse_mass: &[f32]) -> Self {
        let column = |axis: usize| Store::collect(positions.iter().map(|p| p[axis]));
        let zeros = || Store::zeros(positions.len());
        let position = [column(0), column(1), column(2)];
        Self {
            previous: position.clone(),
            position,
            velocity: [zeros(), zeros(), zeros()],
            weight: Store::collect(inverse_mass.iter().copied()),
        }
    }

    /// The columns, all at once.
    pub fn columns(&mut self) -> Columns<'_> {
        fn three(stores: &mut [Store; 3]) -> [Column<'_>; 3] {
            stores.each_mut().map(Store::column)
        }
        Columns {
            x: three(&mut self.position),
            previous: three(&mut self.previous),
            v: three(&mut self.velocity),
            w: self.weight.column(),
        }
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        let all = self.position.iter().chain(&self.previous).chain(&self.velocity);
        all.map(Store::bytes).sum::<usize>() + self.weight.bytes()
    }
}

/// One particle's vector.
#[inline(always)]
pub fn get(from: [Column<'_>; 3], i: usize) -> Vec3A {
    Vec3A::new(from[0].get(i), from[1].get(i), from[2].get(i))
}

/// Writes one particle's vector.
#[inline(always)]
pub fn set(to: [Column<'_>; 3], i: usize, value: Vec3A) {
    to[0].set(i, value.x);
    to[1].set(i, value.y);
    to[2].set(i, value.z);
}
