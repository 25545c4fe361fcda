//! Vectors of WebAssembly: four lanes in a register of SIMD128, where the compilation has that feature.
//!
//! Soundness: a module of WebAssembly with an instruction that its host does not have is refused as a whole, so the host has
//! every instruction below. Each is one that IEEE 754 rounds exactly; none is of the relaxed ones.

#![allow(unused_unsafe, reason = "`vector!` calls instructions of processors that are unsafe to call; these are safe")]

use std::arch::wasm32::*;
use std::ops::{Add, Mul, Neg, Sub};

use super::vector::{by_hand, vector};
use super::{DOUBLE, Lanes, MOST, Mask, Numbers, RECORD, ReadColumn, Readable, Records, RecordsAt, TABLE, WriteColumn};

vector!(
    Four,
    v128,
    Answers4,
    4,
    f32x4_add,
    f32x4_sub,
    f32x4_mul,
    f32x4_div,
    f32x4_sqrt,
    lesser,
    greater,
    f32x4_splat,
    four_at,
    put_four
);
by_hand!(Four, pick, spread);

/// Answers of four lanes: all bits of a lane, or none.
#[derive(Clone, Copy)]
pub struct Answers4(v128);

/// A bit a lane, the first lane lowest.
const BITS: v128 = u32x4(1, 2, 4, 8);

/// `a < b ? a : b`, which is the pseudo-minimum with its operands in the other order.
#[inline(always)]
fn lesser(a: v128, b: v128) -> v128 {
    f32x4_pmin(b, a)
}

/// `a > b ? a : b`.
#[inline(always)]
fn greater(a: v128, b: v128) -> v128 {
    f32x4_pmax(b, a)
}

/// The four numbers at a place.
///
/// # Safety
/// They are there.
#[inline(always)]
unsafe fn four_at(place: *const f32) -> v128 {
    // SAFETY: the caller has four numbers there; the instruction asks for no alignment.
    unsafe { v128_load(place.cast()) }
}

/// Writes four numbers to a place.
///
/// # Safety
/// There is room for them.
#[inline(always)]
unsafe fn put_four(place: *mut f32, numbers: v128) {
    // SAFETY: the caller has room for four numbers there; the instruction asks for no alignment.
    unsafe { v128_store(place.cast(), numbers) }
}

/// Four records become all first numbers, all second ones and so on; and back.
#[inline(always)]
fn turned([a, b, c, d]: [v128; RECORD]) -> [v128; RECORD] {
    let (low, high) = (u32x4_shuffle::<0, 4, 1, 5>(a, b), u32x4_shuffle::<2, 6, 3, 7>(a, b));
    let (low2, high2) = (u32x4_shuffle::<0, 4, 1, 5>(c, d), u32x4_shuffle::<2, 6, 3, 7>(c, d));
    [
        u64x2_shuffle::<0, 2>(low, low2),
        u64x2_shuffle::<1, 3>(low, low2),
        u64x2_shuffle::<0, 2>(high, high2),
        u64x2_shuffle::<1, 3>(high, high2),
    ]
}

impl Four {
    /// The first `n < 4` numbers at a place, the other lanes 0.
    ///
    /// # Safety
    /// There are `n` numbers.
    #[inline(always)]
    unsafe fn read(place: *const f32, n: usize) -> Self {
        // SAFETY: the caller has `n` numbers there, and no branch reads more.
        Self(unsafe {
            match n {
                1 => v128_load32_zero(place.cast()),
                2 => v128_load64_zero(place.cast()),
                3 => v128_load32_lane::<2>(v128_load64_zero(place.cast()), place.add(2).cast()),
                _ => f32x4_splat(0.0),
            }
        })
    }
    /// Writes the first `n < 4` numbers.
    ///
    /// # Safety
    /// There is room for `n` numbers.
    #[inline(always)]
    unsafe fn write(self, place: *mut f32, n: usize) {
        // SAFETY: the caller has `n` numbers there, and no branch writes more.
        unsafe {
            match n {
                1 => v128_store32_lane::<0>(self.0, place.cast()),
                2 => v128_store64_lane::<0>(self.0, place.cast()),
                3 => {
                    v128_store64_lane::<0>(self.0, place.cast());
                    v128_store32_lane::<2>(self.0, place.add(2).cast());
                }
                _ => {}
            }
        }
    }
    #[inline(always)]
    fn less(self, o: Self) -> Answers4 {
        Answers4(f32x4_lt(self.0, o.0))
    }
    #[inline(always)]
    fn choose(self, mask: Answers4, o: Self) -> Self {
        Self(v128_bitselect(self.0, o.0, mask.0))
    }
    #[inline(always)]
    fn seed(self, magic: u32) -> Self {
        Self(u32x4_sub(u32x4_splat(magic), u32x4_shr(self.0, 1)))
    }
    #[inline(always)]
    fn pick_all(from: impl Readable, index: &[u32]) -> Self {
        let from = from.reader();
        let [a, b, c, d]: [f32; 4] = std::array::from_fn(|i| from.get(index[i] as usize));
        Self(f32x4(a, b, c, d))
    }
    #[inline(always)]
    fn lowest(self) -> f32 {
        let two = lesser(self.0, u64x2_shuffle::<1, 0>(self.0, self.0));
        f32x4_extract_lane::<0>(lesser(two, u32x4_shuffle::<1, 0, 3, 2>(two, two)))
    }
    /// The four numbers at one of four places.
    ///
    /// # Safety
    /// There are four numbers at each place.
    #[inline(always)]
    unsafe fn read_quads(at: [*const f32; 4], first: usize) -> Self {
        // SAFETY: the caller has four numbers at each place.
        Self(unsafe { four_at(at[first]) })
    }
    /// Writes four numbers to one of four places.
    ///
    /// # Safety
    /// There are four numbers at each place.
    #[inline(always)]
    unsafe fn write_quads(self, at: [*mut f32; 4], first: usize) {
        // SAFETY: the caller has four numbers at each place.
        unsafe { put_four(at[first], self.0) }
    }
    /// Four records from the `k`th on, turned.
    ///
    /// # Safety
    /// They are there.
    #[inline(always)]
    unsafe fn read_records(from: impl Records, k: usize) -> [Self; RECORD] {
        // SAFETY: the caller has checked the four records, each of which has four numbers.
        let records = std::array::from_fn(|i| unsafe { four_at(from.place(k + i)) });
        turned(records).map(Self)
    }
    /// Writes four records from the `k`th on.
    ///
    /// # Safety
    /// They are there.
    #[inline(always)]
    unsafe fn write_records(values: [Self; RECORD], to: impl Records, k: usize) {
        for (i, record) in turned(values.map(|v| v.0)).into_iter().enumerate() {
            // SAFETY: the caller has checked the four records, each of which has four numbers.
            unsafe { put_four(to.place(k + i), record) }
        }
    }
    /// Writes four double records from the `k`th on.
    ///
    /// # Safety
    /// They are there, with eight numbers each.
    #[inline(always)]
    unsafe fn write_doubles([a, b, c, d, e, f, g, h]: [Self; DOUBLE], to: RecordsAt<'_>, k: usize) {
        let halves = [turned([a.0, b.0, c.0, d.0]), turned([e.0, f.0, g.0, h.0])];
        for i in 0..4 {
            // SAFETY: the caller has checked the four double records, each of which has eight numbers.
            unsafe {
                put_four(to.place(k + i), halves[0][i]);
                put_four(to.place(k + i).add(RECORD), halves[1][i]);
            }
        }
    }
    #[inline(always)]
    fn down(self) -> Self {
        Self(u32x4_shuffle::<1, 2, 3, 0>(self.0, self.0))
    }
    #[inline(always)]
    fn up(self) -> Self {
        Self(u32x4_shuffle::<3, 0, 1, 2>(self.0, self.0))
    }
    #[inline(always)]
    fn but_first(self, other: Self) -> Self {
        Self(u32x4_shuffle::<4, 1, 2, 3>(self.0, other.0))
    }
}

impl Mask for Answers4 {
    const N: usize = 4;

    #[inline(always)]
    fn any(self) -> bool {
        v128_any_true(self.0)
    }
    #[inline(always)]
    fn and(self, o: Self) -> Self {
        Self(v128_and(self.0, o.0))
    }
    #[inline(always)]
    fn bits(self) -> u32 {
        u32::from(u32x4_bitmask(self.0))
    }
    #[inline(always)]
    fn of(bits: u32) -> Self {
        Self(u32x4_eq(v128_and(u32x4_splat(bits), BITS), BITS))
    }
}
