//! Vectors of x86-64: 4 lanes everywhere, 8 with AVX2, 16 with AVX-512.
//!
//! The types are private to `lanes`. Only [`Avx2::run`] and [`Avx512::run`] hand the wide ones to a kernel, and a value of `Avx2` or
//! `Avx512` exists only where the processor was asked. That makes the unsafe blocks below sound.

mod records;
mod widths;

use std::arch::x86_64::*;
use std::ops::{Add, Mul, Neg, Sub};

use super::vector::{by_hand, vector};
use super::{
    DOUBLE, Kernel, Lanes, MOST, Mask, Numbers, RECORD, ReadColumn, Readable, Records, RecordsAt, TABLE, WriteColumn,
};

/// Proof that the processor and the system have AVX2: 8 lanes.
#[derive(Clone, Copy)]
pub struct Avx2(());

/// Proof that the processor and the system have AVX2 and the two parts of AVX-512 that kernels use: 16 lanes.
#[derive(Clone, Copy)]
pub struct Avx512(());

impl Avx2 {
    /// Asks the processor; the standard library remembers the answer.
    #[inline]
    pub fn detect() -> Option<Self> {
        is_x86_feature_detected!("avx2").then_some(Self(()))
    }

    /// Runs a kernel on 8 lanes.
    #[inline]
    pub fn run<K: Kernel>(self, kernel: K) -> K::Out {
        #[target_feature(enable = "avx2")]
        fn inner<K: Kernel>(kernel: K) -> K::Out {
            kernel.run::<Eight>()
        }
        // SAFETY: only `detect` makes a value of this type, and only where it found AVX2, the one feature that `inner` enables.
        unsafe { inner(kernel) }
    }
}

impl Avx512 {
    /// Asks the processor; the standard library remembers the answer.
    #[inline]
    pub fn detect() -> Option<Self> {
        let all = is_x86_feature_detected!("avx2")
            && is_x86_feature_detected!("avx512f")
            && is_x86_feature_detected!("avx512dq");
        all.then_some(Self(()))
    }

    /// Runs a kernel on 16 lanes.
    #[inline]
    pub fn run<K: Kernel>(self, kernel: K) -> K::Out {
        #[target_feature(enable = "avx2,avx512f,avx512dq")]
        fn inner<K: Kernel>(kernel: K) -> K::Out {
            kernel.run::<Sixteen>()
        }
        // SAFETY: only `detect` makes a value of this type, and only where it found all features that `inner` enables.
        unsafe { inner(kernel) }
    }
}

/// First `n` lanes of eight, as `_mm256_maskload_ps` wants them.
static FIRST: [i32; 16] = [-1, -1, -1, -1, -1, -1, -1, -1, 0, 0, 0, 0, 0, 0, 0, 0];

vector!(
    Four,
    __m128,
    Answers4,
    4,
    _mm_add_ps,
    _mm_sub_ps,
    _mm_mul_ps,
    _mm_div_ps,
    _mm_sqrt_ps,
    _mm_min_ps,
    _mm_max_ps,
    _mm_set1_ps,
    _mm_loadu_ps,
    _mm_storeu_ps
);
vector!(
    Eight,
    __m256,
    Answers8,
    8,
    _mm256_add_ps,
    _mm256_sub_ps,
    _mm256_mul_ps,
    _mm256_div_ps,
    _mm256_sqrt_ps,
    _mm256_min_ps,
    _mm256_max_ps,
    _mm256_set1_ps,
    _mm256_loadu_ps,
    _mm256_storeu_ps
);
vector!(
    Sixteen,
    __m512,
    Answers16,
    16,
    _mm512_add_ps,
    _mm512_sub_ps,
    _mm512_mul_ps,
    _mm512_div_ps,
    _mm512_sqrt_ps,
    _mm512_min_ps,
    _mm512_max_ps,
    _mm512_set1_ps,
    _mm512_loadu_ps,
    _mm512_storeu_ps
);

/// Answers of four lanes.
#[derive(Clone, Copy)]
pub struct Answers4(__m128);
/// Answers of eight lanes.
#[derive(Clone, Copy)]
pub struct Answers8(__m256);
/// Answers of sixteen lanes.
#[derive(Clone, Copy)]
pub struct Answers16(__mmask16);
