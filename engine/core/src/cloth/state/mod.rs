//! The state of one garment as columns: a number a particle, padded and aligned for the widest lanes.

pub mod pins;

use glam::{Vec3, Vec3A};

use crate::lanes::{MOST, Store, WriteColumn};

/// Columns: position, previous, velocity (three each), inverse mass, what the body gives way, normal of the skin (three).
const COLUMNS: usize = 14;
const PREVIOUS: usize = 3;
const VELOCITY: usize = 6;
const WEIGHT: usize = 9;
const GIVEN: usize = 10;
const SKIN: usize = 11;

/// Numbers between two places that a processor takes for the same when it looks whether a load follows a store (4 KiB).
const ALIAS: usize = 1_024;

/// How far each column starts behind the one before, of [`ALIAS`]: about a third, so that what a kernel stores in x is
/// never taken for what it loads from y or z a few vectors later.
const STAGGER: usize = 336;

/// Owns the columns.
#[derive(Debug, Clone)]
pub struct State {
    numbers: Store,
    starts: [usize; COLUMNS],
    len: usize,
}

/// The columns as kernels see them.
#[derive(Clone, Copy)]
pub struct ParticleColumns<'a> {
    /// World position (m).
    pub x: [WriteColumn<'a>; 3],
    /// Position at the start of the substep (m); contact moves it so that a push does not become speed.
    pub previous: [WriteColumn<'a>; 3],
    /// Velocity (m/s).
    pub v: [WriteColumn<'a>; 3],
    /// Inverse mass (1/kg).
    pub w: WriteColumn<'a>,
    /// How far the body gives way under the particle (m): what two limbs press between them lies in both. Written between steps
    /// by contact of cloth with cloth, read by contact with the skin.
    pub given: WriteColumn<'a>,
    /// Unit normal of the skin by which the particle lies; 0 where it lies by none. Written by contact with the skin, read by contact
    /// of cloth with cloth in the next step.
    pub skin: [WriteColumn<'a>; 3],
}

impl ParticleColumns<'_> {
    /// The same with one length, known to be one: a check of one place is then a check of all columns. For kernels to
    /// begin with.
    #[inline(always)]
    pub fn level(self) -> Self {
        let len = self.w.len();
        let [x, y, z] = self.x;
        let [px, py, pz] = self.previous;
        let [vx, vy, vz] = self.v;
        let [sx, sy, sz] = self.skin;
        Self {
            x: [x.cut(len), y.cut(len), z.cut(len)],
            previous: [px.cut(len), py.cut(len), pz.cut(len)],
            v: [vx.cut(len), vy.cut(len), vz.cut(len)],
            w: self.w,
            given: self.given.cut(len),
            skin: [sx.cut(len), sy.cut(len), sz.cut(len)],
        }
    }
}

impl State {
    /// At rest at these positions.
    pub fn new(positions: &[Vec3], inverse_mass: &[f32]) -> Self {
        let len = positions.len();
        let mut end = 0usize;
        let starts = std::array::from_fn(|c| {
            let phase = c * STAGGER % ALIAS;
            let start = end + (phase + ALIAS - end % ALIAS) % ALIAS;
            end = (start + len).next_multiple_of(MOST);
            start
        });
        let mut this = Self { numbers: Store::zeros(end), starts, len };
        for axis in 0..3 {
            for c in [axis, PREVIOUS + axis] {
                this.column_mut(c).iter_mut().zip(positions).for_each(|(to, p)| *to = p[axis]);
            }
        }
        this.column_mut(WEIGHT).copy_from_slice(inverse_mass);
        this
    }

    fn column_mut(&mut self, c: usize) -> &mut [f32] {
        &mut self.numbers.as_mut()[self.starts[c]..self.starts[c] + self.len]
    }

    fn column_of(&self, c: usize) -> &[f32] {
        &self.numbers.as_slice()[self.starts[c]..self.starts[c] + self.len]
    }

    /// World positions (m), one axis after the other.
    pub fn positions(&self) -> [&[f32]; 3] {
        [0, 1, 2].map(|axis| self.column_of(axis))
    }

    /// Velocities (m/s), one axis after the other.
    pub fn velocities(&self) -> [&[f32]; 3] {
        [0, 1, 2].map(|axis| self.column_of(VELOCITY + axis))
    }

    /// Inverse masses (1/kg).
    pub fn weights(&self) -> &[f32] {
        self.column_of(WEIGHT)
    }

    /// Changes the velocities (m/s), one axis after the other.
    pub fn velocities_mut(&mut self, mut change: impl FnMut(&mut [f32])) {
        (0..3).for_each(|axis| change(self.column_mut(VELOCITY + axis)));
    }

    /// The body gives way nowhere, and nothing lies by it.
    pub fn forget_the_body(&mut self) {
        (GIVEN..COLUMNS).for_each(|c| self.column_mut(c).fill(0.0));
    }

    /// The columns, all at once.
    pub fn columns(&mut self) -> ParticleColumns<'_> {
        let (starts, len) = (self.starts, self.len);
        let all = self.numbers.column();
        let three = |first: usize| [0, 1, 2].map(|axis| all.part(starts[first + axis], len));
        let one = |c: usize| all.part(starts[c], len);
        ParticleColumns {
            x: three(0),
            previous: three(PREVIOUS),
            v: three(VELOCITY),
            w: one(WEIGHT),
            given: one(GIVEN),
            skin: three(SKIN),
        }
    }

    /// Memory that it holds (bytes).
    pub fn bytes(&self) -> usize {
        self.numbers.bytes()
    }
}

/// Reads the vector of one particle.
#[inline(always)]
pub fn get(from: [WriteColumn<'_>; 3], i: usize) -> Vec3A {
    Vec3A::new(from[0].get(i), from[1].get(i), from[2].get(i))
}

/// Writes one particle's vector.
#[inline(always)]
pub fn set(to: [WriteColumn<'_>; 3], i: usize, value: Vec3A) {
    to[0].set(i, value.x);
    to[1].set(i, value.y);
    to[2].set(i, value.z);
}
