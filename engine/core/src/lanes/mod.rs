//! Lanes: one kernel, run on 1, 4, 8 or 16 numbers at a time.
//!
//! Reads: numbers in columns. Writes: numbers in [`WriteColumn`]s. Every operation is one that IEEE 754 rounds exactly (no fused
//! multiply-add, no estimate of the processor), so a kernel gives the same bits at every width and on every machine.
//! Budget: nothing of its own; a kernel is compiled once a width and called through one branch.
//! Thread: any. This is one of the few rooms with unsafe code: vector instructions, and columns that workers share.

#[expect(unsafe_code, reason = "the workers of a step share its columns")]
mod column;
mod math;
#[cfg(not(target_arch = "x86_64"))]
mod quad;
mod scalar;
mod two;
#[cfg(target_arch = "x86_64")]
#[expect(unsafe_code, reason = "vector instructions, picked at run time")]
mod x86;

use std::fmt;
use std::ops::{Add, Mul, Neg, Sub};

pub(crate) use column::Shared;
pub use column::{ReadColumn, Readable, Store, WriteColumn};
pub use math::{V3, reciprocal_root, times_reciprocal_root};
pub use two::Two;

/// Most lanes of any width: storage is padded to it.
pub const MOST: usize = 16;

/// Which of a vector's lanes something holds for.
pub trait Mask: Copy {
    /// Lanes, at most 32.
    const N: usize;

    /// Whether it holds for any lane.
    fn any(self) -> bool;
    /// Lane by lane: both.
    fn and(self, other: Self) -> Self;
    /// A bit a lane, the first lane lowest.
    fn bits(self) -> u32;
    /// The mask with these bits; those past the lanes are passed over.
    fn of(bits: u32) -> Self;
}

/// Numbers side by side: what arithmetic takes them to be.
pub trait Numbers: Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Neg<Output = Self> {
    /// How many.
    const N: usize;
    /// Its mask.
    type Mask: Mask;

    /// The same number in every lane.
    fn splat(value: f32) -> Self;
    /// `N` numbers from `at` on. Stops where they are not all there.
    fn load(from: impl Readable, at: usize) -> Self;
    /// `n < N` numbers from `at` on, the other lanes 0.
    fn load_part(from: impl Readable, at: usize, n: usize) -> Self;
    /// Writes `N` numbers from `at` on. Stops where they do not fit.
    fn store(self, to: WriteColumn<'_>, at: usize);
    /// Writes the first `n < N` lanes.
    fn store_part(self, to: WriteColumn<'_>, at: usize, n: usize);
    /// Quotient, exactly rounded.
    fn div(self, by: Self) -> Self;
    /// Root, exactly rounded.
    fn sqrt(self) -> Self;
    /// `a < b ? a : b`, lane by lane: the other operand where one is not a number.
    fn min(self, other: Self) -> Self;
    /// `a > b ? a : b`.
    fn max(self, other: Self) -> Self;
    /// Lane by lane: less than; false where either is not a number.
    fn lt(self, other: Self) -> Self::Mask;
    /// `mask ? self : other`.
    fn select(self, mask: Self::Mask, other: Self) -> Self;
    /// The number whose bits are `magic - (bits >> 1)`: the seed of a reciprocal root.
    fn root_seed(self, magic: u32) -> Self;
    /// Each lane's number from the lane above it; the last lane's from the first.
    fn rotate_down(self) -> Self;
    /// Each lane's number from the lane below it; the first lane's from the last.
    fn rotate_up(self) -> Self;
    /// Its numbers, but the first lane's from another.
    fn with_first(self, other: Self) -> Self;
}

/// A vector of the processor.
pub trait Lanes: Numbers {
    /// The first `N` numbers of an array.
    fn from_array(values: &[f32; MOST]) -> Self;
    /// Its numbers, the rest 0.
    fn to_array(self) -> [f32; MOST];
    /// The numbers at `index[..n]`, `n <= N`, the other lanes 0.
    fn gather(from: impl Readable, index: &[u32], n: usize) -> Self {
        let mut values = [0.0; MOST];
        for (v, &i) in values.iter_mut().zip(&index[..n.min(Self::N)]) {
            *v = from.reader().get(i as usize);
        }
        Self::from_array(&values)
    }
    /// Writes the first `n` lanes to `index[..n]`; no index may be there twice.
    fn scatter(self, to: WriteColumn<'_>, index: &[u32], n: usize) {
        let values = self.to_array();
        for (v, &i) in values.iter().zip(&index[..n.min(Self::N)]) {
            to.set(i as usize, *v);
        }
    }
    /// `N` of the 16 numbers that lie four by four from `quads` on, the `lane`th first; `lane` is a multiple of `N`.
    fn load_quads(from: impl Readable, quads: &[u32; 4], lane: usize) -> Self {
        let mut values = [0.0; MOST];
        for (i, v) in values.iter_mut().enumerate().take(Self::N) {
            *v = from.reader().get(quads[(lane + i) / 4 % 4] as usize + i % 4);
        }
        Self::from_array(&values)
    }
    /// Writes to the same places; no two quads may share one.
    fn store_quads(self, to: WriteColumn<'_>, quads: &[u32; 4], lane: usize) {
        for (i, v) in self.to_array().into_iter().enumerate().take(Self::N) {
            to.set(quads[(lane + i) / 4 % 4] as usize + i % 4, v);
        }
    }
    /// The least of its lanes, none of which is NaN.
    fn least(self) -> f32 {
        let values = self.to_array();
        values[1..Self::N].iter().fold(values[0], |least, v| if *v < least { *v } else { least })
    }
}

/// A kernel for any lanes. `run` has to be `#[inline(always)]`, or it is not compiled for the width it is called at.
pub trait Kernel {
    /// What it gives back.
    type Out;
    /// The kernel at one width.
    fn run<L: Lanes>(self) -> Self::Out;
}

/// How many lanes kernels run on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Width {
    /// Plain f32: the twin that the others are held against.
    One,
    /// What every x86-64 and aarch64 has.
    Four,
    /// AVX2.
    Eight,
    /// AVX-512.
    Sixteen,
}

impl Width {
    /// All widths, narrowest first.
    pub const ALL: [Self; 4] = [Self::One, Self::Four, Self::Eight, Self::Sixteen];

    /// Lanes.
    pub fn lanes(self) -> usize {
        match self {
            Self::One => 1,
            Self::Four => 4,
            Self::Eight => 8,
            Self::Sixteen => 16,
        }
    }

    /// The width of so many lanes.
    pub fn of(lanes: usize) -> Option<Self> {
        Self::ALL.into_iter().find(|w| w.lanes() == lanes)
    }

    /// Whether this processor has it.
    pub fn available(self) -> bool {
        match self {
            Self::One | Self::Four => true,
            #[cfg(target_arch = "x86_64")]
            Self::Eight => is_x86_feature_detected!("avx2"),
            #[cfg(target_arch = "x86_64")]
            Self::Sixteen => x86::has_sixteen(),
            #[cfg(not(target_arch = "x86_64"))]
            _ => false,
        }
    }

    /// The widest that this processor has.
    pub fn widest() -> Self {
        Self::ALL.into_iter().rfind(|w| w.available()).unwrap_or(Self::One)
    }

    /// Runs a kernel at this width, or at the widest below it that the processor has.
    #[inline]
    pub fn run<K: Kernel>(self, kernel: K) -> K::Out {
        match self {
            #[cfg(target_arch = "x86_64")]
            Self::Sixteen if self.available() => x86::run16(kernel),
            #[cfg(target_arch = "x86_64")]
            Self::Eight | Self::Sixteen if Self::Eight.available() => x86::run8(kernel),
            Self::One => kernel.run::<f32>(),
            #[cfg(target_arch = "x86_64")]
            _ => kernel.run::<x86::Four>(),
            #[cfg(not(target_arch = "x86_64"))]
            _ => kernel.run::<quad::Four>(),
        }
    }
}

impl fmt::Display for Width {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.lanes())
    }
}

#[cfg(test)]
mod tests;
