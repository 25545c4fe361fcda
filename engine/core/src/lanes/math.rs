//! What kernels share: a vector of three, and the reciprocal root.

use std::ops::{Add, Mul, Sub};

use super::{Lanes, Numbers, Readable, WriteColumn};

/// 1 / sqrt(x) to 8e-7 of its value, from exactly rounded operations only: a seed from the bits and two Newton steps,
/// the first with the constants that make its largest error least (Walczyk, Moroz, Cieslinski 2021, "Improving the
/// accuracy of the fast inverse square root"). A third of the time of root and quotient, and, unlike the processors'
/// estimates, the same bits everywhere. 0 gives a large finite number.
#[inline(always)]
pub fn reciprocal_root<L: Numbers>(x: L) -> L {
    let y = x.root_seed(0x5F1F_FFF9);
    let y = y * L::splat(0.703_952_25) * (L::splat(2.389_244_6) - x * y * y);
    y * (L::splat(1.5) - L::splat(0.5) * x * y * y)
}

/// Three coordinates, each in lanes.
#[derive(Clone, Copy)]
pub struct V3<L> {
    /// The x coordinates.
    pub x: L,
    /// The y coordinates.
    pub y: L,
    /// The z coordinates.
    pub z: L,
}

impl<L: Numbers> V3<L> {
    /// The same vector in every lane.
    #[inline(always)]
    pub fn splat(v: glam::Vec3A) -> Self {
        Self { x: L::splat(v.x), y: L::splat(v.y), z: L::splat(v.z) }
    }
    /// `n <= N` vectors from three columns; `n == N` is the fast way.
    #[inline(always)]
    pub fn load(from: [impl Readable; 3], at: usize, n: usize) -> Self {
        if n == L::N {
            Self { x: L::load(from[0], at), y: L::load(from[1], at), z: L::load(from[2], at) }
        } else {
            Self { x: L::load_part(from[0], at, n), y: L::load_part(from[1], at, n), z: L::load_part(from[2], at, n) }
        }
    }
    /// Writes the first `n` vectors.
    #[inline(always)]
    pub fn store(self, to: [WriteColumn<'_>; 3], at: usize, n: usize) {
        if n == L::N {
            self.x.store(to[0], at);
            self.y.store(to[1], at);
            self.z.store(to[2], at);
        } else {
            self.x.store_part(to[0], at, n);
            self.y.store_part(to[1], at, n);
            self.z.store_part(to[2], at, n);
        }
    }
    /// Inner product.
    #[inline(always)]
    pub fn dot(self, o: Self) -> L {
        self.x * o.x + self.y * o.y + self.z * o.z
    }
    /// Cross product.
    #[inline(always)]
    pub fn cross(self, o: Self) -> Self {
        Self { x: self.y * o.z - self.z * o.y, y: self.z * o.x - self.x * o.z, z: self.x * o.y - self.y * o.x }
    }
    /// `mask ? self : other`.
    #[inline(always)]
    pub fn select(self, mask: L::Mask, other: Self) -> Self {
        Self { x: self.x.select(mask, other.x), y: self.y.select(mask, other.y), z: self.z.select(mask, other.z) }
    }
    /// [`Numbers::rotate_down`] of each coordinate.
    #[inline(always)]
    pub fn rotate_down(self) -> Self {
        Self { x: self.x.rotate_down(), y: self.y.rotate_down(), z: self.z.rotate_down() }
    }
    /// [`Numbers::rotate_up`] of each coordinate.
    #[inline(always)]
    pub fn rotate_up(self) -> Self {
        Self { x: self.x.rotate_up(), y: self.y.rotate_up(), z: self.z.rotate_up() }
    }
    /// [`Numbers::with_first`] of each coordinate.
    #[inline(always)]
    pub fn with_first(self, o: Self) -> Self {
        Self { x: self.x.with_first(o.x), y: self.y.with_first(o.y), z: self.z.with_first(o.z) }
    }
}

impl<L: Lanes> V3<L> {
    /// The vectors at an index list.
    #[inline(always)]
    pub fn gather(from: [impl Readable; 3], index: &[u32], n: usize) -> Self {
        Self { x: L::gather(from[0], index, n), y: L::gather(from[1], index, n), z: L::gather(from[2], index, n) }
    }
    /// Writes the vectors to an index list without repetition.
    #[inline(always)]
    pub fn scatter(self, to: [WriteColumn<'_>; 3], index: &[u32], n: usize) {
        self.x.scatter(to[0], index, n);
        self.y.scatter(to[1], index, n);
        self.z.scatter(to[2], index, n);
    }
    /// The vectors at four times four places: [`Lanes::load_quads`].
    #[inline(always)]
    pub fn load_quads(from: [impl Readable; 3], quads: &[u32; 4], lane: usize) -> Self {
        let [x, y, z] = from;
        Self { x: L::load_quads(x, quads, lane), y: L::load_quads(y, quads, lane), z: L::load_quads(z, quads, lane) }
    }
    /// Writes the vectors of particles in quads to three columns.
    #[inline(always)]
    pub fn store_quads(self, to: [WriteColumn<'_>; 3], quads: &[u32; 4], lane: usize) {
        self.x.store_quads(to[0], quads, lane);
        self.y.store_quads(to[1], quads, lane);
        self.z.store_quads(to[2], quads, lane);
    }
}

impl<L: Numbers> Add for V3<L> {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        Self { x: self.x + o.x, y: self.y + o.y, z: self.z + o.z }
    }
}

impl<L: Numbers> Sub for V3<L> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        Self { x: self.x - o.x, y: self.y - o.y, z: self.z - o.z }
    }
}

impl<L: Numbers> Mul<L> for V3<L> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, k: L) -> Self {
        Self { x: self.x * k, y: self.y * k, z: self.z * k }
    }
}
