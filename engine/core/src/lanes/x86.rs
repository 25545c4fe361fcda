//! Vectors of x86-64: 4 lanes everywhere, 8 with AVX2, 16 with AVX-512.
//!
//! The types are private to `lanes`: only [`run8`] and [`run16`] hand the wide ones to a kernel, after the processor was
//! asked. That is what makes the unsafe blocks below sound.

use std::arch::x86_64::*;
use std::ops::{Add, Mul, Neg, Sub};

use super::{Column, Kernel, Lanes, MOST, Mask};

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
        impl Lanes for $name {
            const N: usize = $n;
            type Mask = $answers;

            #[inline(always)]
            fn splat(value: f32) -> Self {
                // SAFETY: as above.
                Self(unsafe { $set(value) })
            }
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
            fn load(from: Column<'_>, at: usize) -> Self {
                let place = from.place(at, $n);
                // SAFETY: the column has so many numbers there.
                Self(unsafe { $load(place) })
            }
            #[inline(always)]
            fn load_part(from: Column<'_>, at: usize, n: usize) -> Self {
                let place = from.place(at, n.min($n));
                // SAFETY: the column has `n` numbers there, and no more are read.
                unsafe { Self::read(place, n.min($n)) }
            }
            #[inline(always)]
            fn store(self, to: Column<'_>, at: usize) {
                let place = to.place(at, $n);
                // SAFETY: the column has so many numbers there.
                unsafe { $store(place, self.0) }
            }
            #[inline(always)]
            fn store_part(self, to: Column<'_>, at: usize, n: usize) {
                let place = to.place(at, n.min($n));
                // SAFETY: the column has `n` numbers there, and no more are written.
                unsafe { self.write(place, n.min($n)) }
            }
            #[inline(always)]
            fn gather(from: Column<'_>, index: &[u32], n: usize) -> Self {
                Self::pick(from, &index[..n.min($n)])
            }
            #[inline(always)]
            fn scatter(self, to: Column<'_>, index: &[u32], n: usize) {
                self.spread(to, &index[..n.min($n)]);
            }
            #[inline(always)]
            fn load_quads(from: Column<'_>, quads: &[u32; 4], lane: usize) -> Self {
                // SAFETY: the column has four numbers at each place.
                unsafe { Self::read_quads(from.quads(quads), lane / 4 % 4) }
            }
            #[inline(always)]
            fn store_quads(self, to: Column<'_>, quads: &[u32; 4], lane: usize) {
                // SAFETY: as above.
                unsafe { self.write_quads(to.quads(quads), lane / 4 % 4) }
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

// SAFETY of all blocks below: SSE2 is part of x86-64; the wider types exist only inside of `run8` and `run16`.
mod widths {
    use super::*;

    impl Four {
        /// The first `n < 4` numbers at a place.
        #[inline(always)]
        pub(super) unsafe fn read(place: *mut f32, n: usize) -> Self {
            let mut out = [0.0; MOST];
            for (i, v) in out.iter_mut().enumerate().take(n) {
                // SAFETY: the caller has `n` numbers there.
                *v = unsafe { *place.add(i) };
            }
            Self::from_array(&out)
        }
        #[inline(always)]
        pub(super) unsafe fn write(self, place: *mut f32, n: usize) {
            for (i, v) in self.to_array().into_iter().enumerate().take(n) {
                // SAFETY: the caller has `n` numbers there.
                unsafe { *place.add(i) = v };
            }
        }
        #[inline(always)]
        pub(super) fn less(self, o: Self) -> Answers4 {
            Answers4(unsafe { _mm_cmplt_ps(self.0, o.0) })
        }
        #[inline(always)]
        pub(super) fn choose(self, mask: Answers4, o: Self) -> Self {
            Self(unsafe { _mm_or_ps(_mm_and_ps(mask.0, self.0), _mm_andnot_ps(mask.0, o.0)) })
        }
        #[inline(always)]
        pub(super) fn seed(self, magic: u32) -> Self {
            Self(unsafe {
                let half = _mm_srli_epi32::<1>(_mm_castps_si128(self.0));
                _mm_castsi128_ps(_mm_sub_epi32(_mm_set1_epi32(magic.cast_signed()), half))
            })
        }
    }

    /// One number after another: what widths without such an instruction do.
    macro_rules! by_hand {
        ($name:ident, $($method:ident),+) => {
            impl $name {
                $(by_hand!(@ $method);)+
            }
        };
        (@ pick) => {
            #[inline(always)]
            pub(super) fn pick(from: Column<'_>, index: &[u32]) -> Self {
                let mut values = [0.0; MOST];
                for (v, &i) in values.iter_mut().zip(index) {
                    *v = from.get(i as usize);
                }
                Self::from_array(&values)
            }
        };
        (@ spread) => {
            #[inline(always)]
            pub(super) fn spread(self, to: Column<'_>, index: &[u32]) {
                for (v, &i) in self.to_array().into_iter().zip(index) {
                    to.set(i as usize, v);
                }
            }
        };
    }
    by_hand!(Four, pick, spread);
    by_hand!(Eight, pick, spread);

    impl Sixteen {
        #[inline(always)]
        pub(super) fn pick(from: Column<'_>, index: &[u32]) -> Self {
            let (first, at) = Self::places(from, index);
            Self(unsafe { _mm512_mask_i32gather_ps::<4>(_mm512_setzero_ps(), first, at, from.place(0, 0)) })
        }
        #[inline(always)]
        pub(super) fn spread(self, to: Column<'_>, index: &[u32]) {
            let (first, at) = Self::places(to, index);
            unsafe { _mm512_mask_i32scatter_ps::<4>(to.place(0, 0), first, at, self.0) }
        }
        /// Which lanes are used, and their places: all within the column.
        #[inline(always)]
        fn places(column: Column<'_>, index: &[u32]) -> (__mmask16, __m512i) {
            let first = Self::first(index.len().min(MOST));
            // SAFETY: masked to the list's length.
            let at = unsafe { _mm512_maskz_loadu_epi32(first, index.as_ptr().cast()) };
            let len = unsafe { _mm512_set1_epi32(column.len().min(i32::MAX as usize) as i32) };
            let outside = unsafe { _mm512_mask_cmpge_epu32_mask(first, at, len) };
            assert!(outside == 0, "a kernel left its column");
            (first, at)
        }
    }

    // SAFETY of the following: the caller has four numbers at each place.
    impl Four {
        #[inline(always)]
        pub(super) unsafe fn read_quads(at: [*mut f32; 4], first: usize) -> Self {
            Self(unsafe { _mm_loadu_ps(at[first]) })
        }
        #[inline(always)]
        pub(super) unsafe fn write_quads(self, at: [*mut f32; 4], first: usize) {
            unsafe { _mm_storeu_ps(at[first], self.0) }
        }
    }

    impl Eight {
        #[inline(always)]
        pub(super) unsafe fn read_quads(at: [*mut f32; 4], first: usize) -> Self {
            let [a, b] = [at[first], at[(first + 1) % 4]];
            Self(unsafe { _mm256_insertf128_ps::<1>(_mm256_castps128_ps256(_mm_loadu_ps(a)), _mm_loadu_ps(b)) })
        }
        #[inline(always)]
        pub(super) unsafe fn write_quads(self, at: [*mut f32; 4], first: usize) {
            unsafe {
                _mm_storeu_ps(at[first], _mm256_castps256_ps128(self.0));
                _mm_storeu_ps(at[(first + 1) % 4], _mm256_extractf128_ps::<1>(self.0));
            }
        }
    }

    impl Sixteen {
        #[inline(always)]
        pub(super) unsafe fn read_quads(at: [*mut f32; 4], _: usize) -> Self {
            unsafe {
                let v = _mm512_castps128_ps512(_mm_loadu_ps(at[0]));
                let v = _mm512_insertf32x4::<1>(v, _mm_loadu_ps(at[1]));
                let v = _mm512_insertf32x4::<2>(v, _mm_loadu_ps(at[2]));
                Self(_mm512_insertf32x4::<3>(v, _mm_loadu_ps(at[3])))
            }
        }
        #[inline(always)]
        pub(super) unsafe fn write_quads(self, at: [*mut f32; 4], _: usize) {
            unsafe {
                _mm_storeu_ps(at[0], _mm512_castps512_ps128(self.0));
                _mm_storeu_ps(at[1], _mm512_extractf32x4_ps::<1>(self.0));
                _mm_storeu_ps(at[2], _mm512_extractf32x4_ps::<2>(self.0));
                _mm_storeu_ps(at[3], _mm512_extractf32x4_ps::<3>(self.0));
            }
        }
    }

    impl Mask for Answers4 {
        #[inline(always)]
        fn any(self) -> bool {
            self.bits() != 0
        }
        #[inline(always)]
        fn and(self, o: Self) -> Self {
            Self(unsafe { _mm_and_ps(self.0, o.0) })
        }
        #[inline(always)]
        fn bits(self) -> u32 {
            (unsafe { _mm_movemask_ps(self.0) }).cast_unsigned()
        }
        #[inline(always)]
        fn of(bits: u32) -> Self {
            Self(unsafe {
                let lane = _mm_setr_epi32(1, 2, 4, 8);
                let bits = _mm_set1_epi32(bits.cast_signed());
                _mm_castsi128_ps(_mm_cmpeq_epi32(_mm_and_si128(bits, lane), lane))
            })
        }
    }

    impl Eight {
        #[inline(always)]
        pub(super) unsafe fn read(place: *mut f32, n: usize) -> Self {
            Self(unsafe { _mm256_maskload_ps(place, Self::first(n)) })
        }
        #[inline(always)]
        pub(super) unsafe fn write(self, place: *mut f32, n: usize) {
            unsafe { _mm256_maskstore_ps(place, Self::first(n), self.0) }
        }
        #[inline(always)]
        fn first(n: usize) -> __m256i {
            unsafe { _mm256_loadu_si256(FIRST.as_ptr().add(8 - n.min(8)).cast()) }
        }
        #[inline(always)]
        pub(super) fn less(self, o: Self) -> Answers8 {
            Answers8(unsafe { _mm256_cmp_ps::<_CMP_LT_OQ>(self.0, o.0) })
        }
        #[inline(always)]
        pub(super) fn choose(self, mask: Answers8, o: Self) -> Self {
            Self(unsafe { _mm256_blendv_ps(o.0, self.0, mask.0) })
        }
        #[inline(always)]
        pub(super) fn seed(self, magic: u32) -> Self {
            Self(unsafe {
                let half = _mm256_srli_epi32::<1>(_mm256_castps_si256(self.0));
                _mm256_castsi256_ps(_mm256_sub_epi32(_mm256_set1_epi32(magic.cast_signed()), half))
            })
        }
    }

    impl Mask for Answers8 {
        #[inline(always)]
        fn any(self) -> bool {
            self.bits() != 0
        }
        #[inline(always)]
        fn and(self, o: Self) -> Self {
            Self(unsafe { _mm256_and_ps(self.0, o.0) })
        }
        #[inline(always)]
        fn bits(self) -> u32 {
            (unsafe { _mm256_movemask_ps(self.0) }).cast_unsigned()
        }
        #[inline(always)]
        fn of(bits: u32) -> Self {
            Self(unsafe {
                let lane = _mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128);
                let bits = _mm256_set1_epi32(bits.cast_signed());
                _mm256_castsi256_ps(_mm256_cmpeq_epi32(_mm256_and_si256(bits, lane), lane))
            })
        }
    }

    impl Sixteen {
        #[inline(always)]
        pub(super) unsafe fn read(place: *mut f32, n: usize) -> Self {
            Self(unsafe { _mm512_maskz_loadu_ps(Self::first(n), place) })
        }
        #[inline(always)]
        pub(super) unsafe fn write(self, place: *mut f32, n: usize) {
            unsafe { _mm512_mask_storeu_ps(place, Self::first(n), self.0) }
        }
        #[inline(always)]
        fn first(n: usize) -> __mmask16 {
            ((1u32 << n) - 1) as __mmask16
        }
        #[inline(always)]
        pub(super) fn less(self, o: Self) -> Answers16 {
            Answers16(unsafe { _mm512_cmp_ps_mask::<_CMP_LT_OQ>(self.0, o.0) })
        }
        #[inline(always)]
        pub(super) fn choose(self, mask: Answers16, o: Self) -> Self {
            Self(unsafe { _mm512_mask_blend_ps(mask.0, o.0, self.0) })
        }
        #[inline(always)]
        pub(super) fn seed(self, magic: u32) -> Self {
            Self(unsafe {
                let half = _mm512_srli_epi32::<1>(_mm512_castps_si512(self.0));
                _mm512_castsi512_ps(_mm512_sub_epi32(_mm512_set1_epi32(magic.cast_signed()), half))
            })
        }
    }

    impl Mask for Answers16 {
        #[inline(always)]
        fn any(self) -> bool {
            self.0 != 0
        }
        #[inline(always)]
        fn and(self, o: Self) -> Self {
            Self(self.0 & o.0)
        }
        #[inline(always)]
        fn bits(self) -> u32 {
            u32::from(self.0)
        }
        #[inline(always)]
        fn of(bits: u32) -> Self {
            Self(bits as __mmask16)
        }
    }
}
