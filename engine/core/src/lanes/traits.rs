//! What a kernel needs of the numbers that it runs on.

use std::ops::{Add, Mul, Neg, Sub};

use super::column::{MOST, ReadColumn, Readable, TABLE, WriteColumn};
use super::records::{DOUBLE, RECORD, Records, RecordsAt};

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
    /// How many numbers lie side by side.
    const N: usize;
    /// The truth values that comparing them gives.
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
    /// The numbers of a table at `at[..N]`, all of them below [`TABLE`].
    fn among(table: &[f32; TABLE], at: &[u32; MOST]) -> Self {
        Self::gather(ReadColumn::new(table), at, Self::N)
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
    /// The numbers of `N` records from the `k`th on: all first numbers, all second ones, all third, all fourth.
    fn load_records(from: impl Records, k: usize) -> [Self; RECORD] {
        let mut values = [[0.0; MOST]; RECORD];
        for (number, values) in values.iter_mut().enumerate() {
            values.iter_mut().enumerate().take(Self::N).for_each(|(i, v)| *v = from.get(k + i, number));
        }
        values.each_ref().map(Self::from_array)
    }
    /// Writes them back; where one record is there twice, all that is written to it is alike.
    fn store_records(values: [Self; RECORD], to: impl Records, k: usize) {
        for (number, values) in values.into_iter().enumerate() {
            values.to_array().into_iter().enumerate().take(Self::N).for_each(|(i, v)| to.set(k + i, number, v));
        }
    }
    /// Writes `N` double records from the `k`th on: all first numbers, all second ones and so on.
    fn store_doubles(values: [Self; DOUBLE], to: RecordsAt<'_>, k: usize) {
        to.check_doubles(k, Self::N);
        for (number, values) in values.into_iter().enumerate() {
            values.to_array().into_iter().enumerate().take(Self::N).for_each(|(i, v)| to.set(k + i, number, v));
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
    /// Result of the kernel.
    type Out;
    /// The kernel at one width.
    fn run<L: Lanes>(self) -> Self::Out;
}
