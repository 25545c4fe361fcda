//! Vectors of aarch64: four lanes in a register of NEON.
//!
//! Soundness: NEON is part of aarch64, so the processor has every instruction below. Each is one that IEEE 754 rounds exactly:
//! no fused multiply-add, and no estimate of a root or a quotient.

use std::arch::aarch64::*;
use std::ops::{Add, Mul, Neg, Sub};

use super::vector::{by_hand, vector};
use super::{DOUBLE, Lanes, MOST, Mask, Numbers, RECORD, ReadColumn, Readable, Records, RecordsAt, TABLE, WriteColumn};

vector!(
    Four,
    float32x4_t,
    Answers4,
    4,
    vaddq_f32,
    vsubq_f32,
    vmulq_f32,
    vdivq_f32,
    vsqrtq_f32,
    lesser,
    greater,
    vdupq_n_f32,
    vld1q_f32,
    vst1q_f32
);
by_hand!(Four, pick, spread);

/// Answers of four lanes: all bits of a lane, or none.
#[derive(Clone, Copy)]
pub struct Answers4(uint32x4_t);

/// A bit a lane, the first lane lowest.
const BITS: [u32; 4] = [1, 2, 4, 8];

/// `a < b ? a : b`. NEON's own minimum treats what is not a number, and zeros of both signs, in another way.
#[inline]
#[target_feature(enable = "neon")]
fn lesser(a: float32x4_t, b: float32x4_t) -> float32x4_t {
    vbslq_f32(vcltq_f32(a, b), a, b)
}

/// `a > b ? a : b`.
#[inline]
#[target_feature(enable = "neon")]
fn greater(a: float32x4_t, b: float32x4_t) -> float32x4_t {
    vbslq_f32(vcgtq_f32(a, b), a, b)
}

/// Four records become all first numbers, all second ones and so on; and back.
#[inline]
#[target_feature(enable = "neon")]
fn turned([a, b, c, d]: [float32x4_t; RECORD]) -> [float32x4_t; RECORD] {
    let even = [vtrn1q_f32(a, b), vtrn1q_f32(c, d)].map(|v| vreinterpretq_f64_f32(v));
    let odd = [vtrn2q_f32(a, b), vtrn2q_f32(c, d)].map(|v| vreinterpretq_f64_f32(v));
    [
        vreinterpretq_f32_f64(vtrn1q_f64(even[0], even[1])),
        vreinterpretq_f32_f64(vtrn1q_f64(odd[0], odd[1])),
        vreinterpretq_f32_f64(vtrn2q_f64(even[0], even[1])),
        vreinterpretq_f32_f64(vtrn2q_f64(odd[0], odd[1])),
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
            let zero = vdupq_n_f32(0.0);
            match n {
                1 => vld1q_lane_f32::<0>(place, zero),
                2 => vcombine_f32(vld1_f32(place), vget_low_f32(zero)),
                3 => vld1q_lane_f32::<2>(place.add(2), vcombine_f32(vld1_f32(place), vget_low_f32(zero))),
                _ => zero,
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
                1 => vst1q_lane_f32::<0>(place, self.0),
                2 => vst1_f32(place, vget_low_f32(self.0)),
                3 => {
                    vst1_f32(place, vget_low_f32(self.0));
                    vst1q_lane_f32::<2>(place.add(2), self.0);
                }
                _ => {}
            }
        }
    }
    #[inline(always)]
    fn less(self, o: Self) -> Answers4 {
        // SAFETY: every aarch64 has NEON.
        Answers4(unsafe { vcltq_f32(self.0, o.0) })
    }
    #[inline(always)]
    fn choose(self, mask: Answers4, o: Self) -> Self {
        // SAFETY: every aarch64 has NEON.
        Self(unsafe { vbslq_f32(mask.0, self.0, o.0) })
    }
    #[inline(always)]
    fn seed(self, magic: u32) -> Self {
        // SAFETY: every aarch64 has NEON.
        Self(unsafe {
            let half = vshrq_n_u32::<1>(vreinterpretq_u32_f32(self.0));
            vreinterpretq_f32_u32(vsubq_u32(vdupq_n_u32(magic), half))
        })
    }
    #[inline(always)]
    fn pick_all(from: impl Readable, index: &[u32]) -> Self {
        let from = from.reader();
        let four: [f32; 4] = std::array::from_fn(|i| from.get(index[i] as usize));
        // SAFETY: the array has four numbers.
        Self(unsafe { vld1q_f32(four.as_ptr()) })
    }
    #[inline(always)]
    fn lowest(self) -> f32 {
        // SAFETY: every aarch64 has NEON.
        unsafe {
            let two = lesser(self.0, vextq_f32::<2>(self.0, self.0));
            vgetq_lane_f32::<0>(lesser(two, vextq_f32::<1>(two, two)))
        }
    }
    /// The four numbers at one of four places.
    ///
    /// # Safety
    /// There are four numbers at each place.
    #[inline(always)]
    unsafe fn read_quads(at: [*const f32; 4], first: usize) -> Self {
        // SAFETY: the caller has four numbers at each place.
        Self(unsafe { vld1q_f32(at[first]) })
    }
    /// Writes four numbers to one of four places.
    ///
    /// # Safety
    /// There are four numbers at each place.
    #[inline(always)]
    unsafe fn write_quads(self, at: [*mut f32; 4], first: usize) {
        // SAFETY: the caller has four numbers at each place.
        unsafe { vst1q_f32(at[first], self.0) }
    }
    /// Four records from the `k`th on, turned.
    ///
    /// # Safety
    /// They are there.
    #[inline(always)]
    unsafe fn read_records(from: impl Records, k: usize) -> [Self; RECORD] {
        // SAFETY: the caller has checked the four records, each of which has four numbers.
        let turned = unsafe {
            turned([
                vld1q_f32(from.place(k)),
                vld1q_f32(from.place(k + 1)),
                vld1q_f32(from.place(k + 2)),
                vld1q_f32(from.place(k + 3)),
            ])
        };
        turned.map(Self)
    }
    /// Writes four records from the `k`th on.
    ///
    /// # Safety
    /// They are there.
    #[inline(always)]
    unsafe fn write_records(values: [Self; RECORD], to: impl Records, k: usize) {
        // SAFETY: every aarch64 has NEON.
        let turned = unsafe { turned(values.map(|v| v.0)) };
        for (i, record) in turned.into_iter().enumerate() {
            // SAFETY: the caller has checked the four records, each of which has four numbers.
            unsafe { vst1q_f32(to.place(k + i), record) }
        }
    }
    /// Writes four double records from the `k`th on.
    ///
    /// # Safety
    /// They are there, with eight numbers each.
    #[inline(always)]
    unsafe fn write_doubles([a, b, c, d, e, f, g, h]: [Self; DOUBLE], to: RecordsAt<'_>, k: usize) {
        // SAFETY: every aarch64 has NEON.
        let halves = unsafe { [turned([a.0, b.0, c.0, d.0]), turned([e.0, f.0, g.0, h.0])] };
        for i in 0..4 {
            // SAFETY: the caller has checked the four double records, each of which has eight numbers.
            unsafe {
                vst1q_f32(to.place(k + i), halves[0][i]);
                vst1q_f32(to.place(k + i).add(RECORD), halves[1][i]);
            }
        }
    }
    #[inline(always)]
    fn down(self) -> Self {
        // SAFETY: every aarch64 has NEON.
        Self(unsafe { vextq_f32::<1>(self.0, self.0) })
    }
    #[inline(always)]
    fn up(self) -> Self {
        // SAFETY: every aarch64 has NEON.
        Self(unsafe { vextq_f32::<3>(self.0, self.0) })
    }
    #[inline(always)]
    fn but_first(self, other: Self) -> Self {
        // SAFETY: every aarch64 has NEON.
        Self(unsafe { vcopyq_laneq_f32::<0, 0>(self.0, other.0) })
    }
}

impl Mask for Answers4 {
    const N: usize = 4;

    #[inline(always)]
    fn any(self) -> bool {
        // SAFETY: every aarch64 has NEON.
        unsafe { vmaxvq_u32(self.0) != 0 }
    }
    #[inline(always)]
    fn and(self, o: Self) -> Self {
        // SAFETY: every aarch64 has NEON.
        Self(unsafe { vandq_u32(self.0, o.0) })
    }
    #[inline(always)]
    fn bits(self) -> u32 {
        // SAFETY: the array has four numbers.
        unsafe { vaddvq_u32(vandq_u32(self.0, vld1q_u32(BITS.as_ptr()))) }
    }
    #[inline(always)]
    fn of(bits: u32) -> Self {
        // SAFETY: the array has four numbers.
        Self(unsafe { vtstq_u32(vdupq_n_u32(bits), vld1q_u32(BITS.as_ptr())) })
    }
}
