//! Vectors of x86-64: 4 lanes everywhere, 8 with AVX2, 16 with AVX-512.
//!
//! The types are private to `lanes`: only [`run8`] and [`run16`] hand the wide ones to a kernel, after the processor was
//! asked. That is what makes the unsafe blocks below sound.
//!
//! Reads: numbers in columns. Writes: numbers in columns. Budget: one instruction an operation, one branch a kernel.
//! Thread: any.

mod records;
mod widths;

use std::arch::x86_64::*;
use std::ops::{Add, Mul, Neg, Sub};

use super::{
    DOUBLE, Kernel, Lanes, MOST, Mask, Numbers, RECORD, ReadColumn, Readable, Records, RecordsAt, TABLE, WriteColumn,
};

/// Whether the processor and the system have 16 lanes.
pub fn has_sixteen() -> bool {
    is_x86_feature_detected!("avx512f") && is_x86_feature_detected!("avx512dq")
}

/// A kernel on 8 lanes; the caller has asked for AVX2.
#[inline]
pub fn run8<K: Kernel>(kernel: K) -> K::Out {
    #[target_feature(enable = "avx2")]
    fn inner<K: Kernel>(kernel: K) -> K::Out {
        kernel.run::<Eight>()
    }
    // SAFETY: `Width::run` calls this only where AVX2 was detected.
    unsafe { inner(kernel) }
}

/// A kernel on 16 lanes; the caller has asked for AVX-512.
#[inline]
pub fn run16<K: Kernel>(kernel: K) -> K::Out {
    #[target_feature(enable = "avx2,avx512f,avx512dq")]
    fn inner<K: Kernel>(kernel: K) -> K::Out {
        kernel.run::<Sixteen>()
    }
    // SAFETY: `Width::run` calls this only where AVX-512 was detected.
    unsafe { inner(kernel) }
}

/// First `n` lanes of eight, as `_mm256_maskload_ps` wants them.
static FIRST: [i32; 16] = [-1, -1, -1, -1, -1, -1, -1, -1, 0, 0, 0, 0, 0, 0, 0, 0];

macro_rules! vector {
    ($name:ident, $raw:ty, $answers:ident, $n:literal, $add:ident, $sub:ident, $mul:ident, $div:ident, $sqrt:ident,
     $min:ident, $max:ident, $set:ident, $load:ident, $store:ident) => {
        /// A vector of this width.
        #[derive(Clone, Copy)]
        pub struct $name($raw);

        impl Add for $name {
            type Output = Self;
            #[inline(always)]
            fn add(self, o: Self) -> Self {
                // SAFETY: see the module: the processor has this width.
                Self(unsafe { $add(self.0, o.0) })
            }
        }
        impl Sub for $name {
            type Output = Self;
            #[inline(always)]
            fn sub(self, o: Self) -> Self {
                // SAFETY: as above.
                Self(unsafe { $sub(self.0, o.0) })
            }
        }
        impl Mul for $name {
            type Output = Self;
            #[inline(always)]
            fn mul(self, o: Self) -> Self {
                // SAFETY: as above.
                Self(unsafe { $mul(self.0, o.0) })
            }
        }
        impl Neg for $name {
            type Output = Self;
            #[inline(always)]
            fn neg(self) -> Self {
                Self::splat(-0.0) - self
            }
        }
        impl Numbers for $name {
            const N: usize = $n;
            type Mask = $answers;

            #[inline(always)]
            fn splat(value: f32) -> Self {
                // SAFETY: as above.
                Self(unsafe { $set(value) })
            }
            #[inline(always)]
            fn load(from: impl Readable, at: usize) -> Self {
                let place = from.reader().place(at, $n);
                // SAFETY: the column has so many numbers there.
                Self(unsafe { $load(place) })
            }
            #[inline(always)]
            fn load_part(from: impl Readable, at: usize, n: usize) -> Self {
                let place = from.reader().place(at, n.min($n));
                // SAFETY: the column has `n` numbers there, and no more are read.
                unsafe { Self::read(place, n.min($n)) }
            }
            #[inline(always)]
            fn store(self, to: WriteColumn<'_>, at: usize) {
                let place = to.place(at, $n);
                // SAFETY: the column has so many numbers there.
                unsafe { $store(place, self.0) }
            }
            #[inline(always)]
            fn store_part(self, to: WriteColumn<'_>, at: usize, n: usize) {
                let place = to.place(at, n.min($n));
                // SAFETY: the column has `n` numbers there, and no more are written.
                unsafe { self.write(place, n.min($n)) }
            }
            #[inline(always)]
            fn div(self, by: Self) -> Self {
                // SAFETY: as above.
                Self(unsafe { $div(self.0, by.0) })
            }
            #[inline(always)]
            fn sqrt(self) -> Self {
                // SAFETY: as above.
                Self(unsafe { $sqrt(self.0) })
            }
            #[inline(always)]
            fn min(self, o: Self) -> Self {
                // SAFETY: as above.
                Self(unsafe { $min(self.0, o.0) })
            }
            #[inline(always)]
            fn max(self, o: Self) -> Self {
                // SAFETY: as above.
                Self(unsafe { $max(self.0, o.0) })
            }
            #[inline(always)]
            fn lt(self, o: Self) -> $answers {
                self.less(o)
            }
            #[inline(always)]
            fn select(self, mask: $answers, o: Self) -> Self {
                self.choose(mask, o)
            }
            #[inline(always)]
            fn root_seed(self, magic: u32) -> Self {
                self.seed(magic)
            }
            #[inline(always)]
            fn rotate_down(self) -> Self {
                self.down()
            }
            #[inline(always)]
            fn rotate_up(self) -> Self {
                self.up()
            }
            #[inline(always)]
            fn with_first(self, other: Self) -> Self {
                self.but_first(other)
            }
        }
        impl Lanes for $name {
            #[inline(always)]
            fn from_array(values: &[f32; MOST]) -> Self {
                // SAFETY: as above; the array is long enough for every width.
                Self(unsafe { $load(values.as_ptr()) })
            }
            #[inline(always)]
            fn to_array(self) -> [f32; MOST] {
                let mut out = [0.0; MOST];
                // SAFETY: as above.
                unsafe { $store(out.as_mut_ptr(), self.0) };
                out
            }
            #[inline(always)]
            fn gather(from: impl Readable, index: &[u32], n: usize) -> Self {
                Self::pick(from, &index[..n.min($n)])
            }
            #[inline(always)]
            fn scatter(self, to: WriteColumn<'_>, index: &[u32], n: usize) {
                self.spread(to, &index[..n.min($n)]);
            }
            #[inline(always)]
            fn among(table: &[f32; TABLE], at: &[u32; MOST]) -> Self {
                Self::pick_among(table, at)
            }
            #[inline(always)]
            fn load_quads(from: impl Readable, quads: &[u32; 4], lane: usize) -> Self {
                // SAFETY: the column has four numbers at each place.
                unsafe { Self::read_quads(from.reader().quads(quads), lane / 4 % 4) }
            }
            #[inline(always)]
            fn store_quads(self, to: WriteColumn<'_>, quads: &[u32; 4], lane: usize) {
                // SAFETY: as above.
                unsafe { self.write_quads(to.quads(quads), lane / 4 % 4) }
            }
            #[inline(always)]
            fn load_records(from: impl Records, k: usize) -> [Self; RECORD] {
                from.check(k, $n);
                // SAFETY: all of them are there.
                unsafe { Self::read_records(from, k) }
            }
            #[inline(always)]
            fn store_records(values: [Self; RECORD], to: impl Records, k: usize) {
                to.check(k, $n);
                // SAFETY: as above.
                unsafe { Self::write_records(values, to, k) }
            }
            #[inline(always)]
            fn store_doubles(values: [Self; DOUBLE], to: RecordsAt<'_>, k: usize) {
                to.check_doubles(k, $n);
                // SAFETY: as above, with the numbers of two each.
                unsafe { Self::write_doubles(values, to, k) }
            }
            #[inline(always)]
            fn least(self) -> f32 {
                self.lowest()
            }
        }
    };
}

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
