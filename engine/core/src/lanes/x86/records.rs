//! Records of four numbers, turned: `N` records become four vectors, and back. 128 bits at a time, each holds one record; four
//! such vectors are turned within their quarters.
//!
//! Soundness: the methods of `Lanes` that the macro `vector!` makes check the records before they call a function of this file.

use super::*;

impl Four {
    #[inline(always)]
    pub(super) unsafe fn read_records(from: impl Records, k: usize) -> [Self; RECORD] {
        // SAFETY: `load_records` checked that four records from the `k`th on lie within the column, with all their numbers.
        // The loads ask for no alignment, and every x86-64 processor has SSE2.
        unsafe {
            let rows = [
                _mm_loadu_ps(from.place(k)),
                _mm_loadu_ps(from.place(k + 1)),
                _mm_loadu_ps(from.place(k + 2)),
                _mm_loadu_ps(from.place(k + 3)),
            ];
            let [x, y, z, w] = Self::turned(rows);
            [Self(x), Self(y), Self(z), Self(w)]
        }
    }
    #[inline(always)]
    pub(super) unsafe fn write_records([x, y, z, w]: [Self; RECORD], to: impl Records, k: usize) {
        let [a, b, c, d] = Self::turned([x.0, y.0, z.0, w.0]);
        // SAFETY: `store_records` checked that four records from the `k`th on lie within the column, with all their numbers.
        // The stores ask for no alignment, and every x86-64 processor has SSE2.
        unsafe {
            _mm_storeu_ps(to.place(k), a);
            _mm_storeu_ps(to.place(k + 1), b);
            _mm_storeu_ps(to.place(k + 2), c);
            _mm_storeu_ps(to.place(k + 3), d);
        }
    }
    #[inline(always)]
    fn turned([a, b, c, d]: [__m128; 4]) -> [__m128; 4] {
        // SAFETY: every x86-64 processor has SSE2, and the block uses registers only.
        unsafe {
            let (low, high) = (_mm_unpacklo_ps(a, b), _mm_unpackhi_ps(a, b));
            let (low2, high2) = (_mm_unpacklo_ps(c, d), _mm_unpackhi_ps(c, d));
            [_mm_movelh_ps(low, low2), _mm_movehl_ps(low2, low), _mm_movelh_ps(high, high2), _mm_movehl_ps(high2, high)]
        }
    }
}

/// Four vectors turned within their quarters. A macro, because a closure is not compiled for the width.
macro_rules! turned {
    ($v:expr, $low:ident, $high:ident, $low2:ident, $high2:ident, $wide:ident, $narrow:ident) => {{
        let [a, b, c, d] = $v;
        let (low, high) = ($wide($low(a, b)), $wide($high(a, b)));
        let (low2, high2) = ($wide($low(c, d)), $wide($high(c, d)));
        [
            $narrow($low2(low, low2)),
            $narrow($high2(low, low2)),
            $narrow($low2(high, high2)),
            $narrow($high2(high, high2)),
        ]
    }};
}

impl Eight {
    #[inline(always)]
    pub(super) unsafe fn read_records(from: impl Records, k: usize) -> [Self; RECORD] {
        // SAFETY: `load_records` checked that eight records from the `k`th on lie within the column, with all their numbers.
        // `pair` reads two of them in each of the four calls; `Avx2::detect` found AVX2.
        unsafe {
            let [x, y, z, w] = Self::turned([
                Self::pair(from, k),
                Self::pair(from, k + 1),
                Self::pair(from, k + 2),
                Self::pair(from, k + 3),
            ]);
            [Self(x), Self(y), Self(z), Self(w)]
        }
    }
    #[inline(always)]
    pub(super) unsafe fn write_records([x, y, z, w]: [Self; RECORD], to: impl Records, k: usize) {
        // SAFETY: `store_records` checked that eight records from the `k`th on lie within the column, with all their numbers.
        // `part` writes two of them in each of the four calls; `Avx2::detect` found AVX2.
        unsafe {
            let [a, b, c, d] = Self::turned([x.0, y.0, z.0, w.0]);
            Self::part(a, to, k);
            Self::part(b, to, k + 1);
            Self::part(c, to, k + 2);
            Self::part(d, to, k + 3);
        }
    }
    #[inline(always)]
    unsafe fn pair(from: impl Records, k: usize) -> __m256 {
        // SAFETY: `read_records` passes a `k` for which it knows records `k` and `k + 4`. The loads ask for no alignment, and
        // `Avx2::detect` found AVX2.
        unsafe {
            let low = _mm256_castps128_ps256(_mm_loadu_ps(from.place(k)));
            _mm256_insertf128_ps::<1>(low, _mm_loadu_ps(from.place(k + 4)))
        }
    }
    #[inline(always)]
    unsafe fn part(pair: __m256, to: impl Records, k: usize) {
        // SAFETY: `write_records` passes a `k` for which it knows records `k` and `k + 4`. The stores ask for no alignment, and
        // `Avx2::detect` found AVX2.
        unsafe {
            _mm_storeu_ps(to.place(k), _mm256_castps256_ps128(pair));
            _mm_storeu_ps(to.place(k + 4), _mm256_extractf128_ps::<1>(pair));
        }
    }
    #[inline(always)]
    unsafe fn turned(v: [__m256; 4]) -> [__m256; 4] {
        // SAFETY: `Avx2::detect` found AVX2 before this kernel started; the block uses registers only.
        unsafe {
            turned!(
                v,
                _mm256_unpacklo_ps,
                _mm256_unpackhi_ps,
                _mm256_unpacklo_pd,
                _mm256_unpackhi_pd,
                _mm256_castps_pd,
                _mm256_castpd_ps
            )
        }
    }
}

impl Sixteen {
    #[inline(always)]
    pub(super) unsafe fn read_records(from: impl Records, k: usize) -> [Self; RECORD] {
        // SAFETY: `load_records` checked that 16 records from the `k`th on lie within the column, with all their numbers.
        // `four` reads four of them in each of the four calls; `Avx512::detect` found AVX-512.
        unsafe {
            let [x, y, z, w] = Self::turned([
                Self::four(from, k),
                Self::four(from, k + 1),
                Self::four(from, k + 2),
                Self::four(from, k + 3),
            ]);
            [Self(x), Self(y), Self(z), Self(w)]
        }
    }
    #[inline(always)]
    pub(super) unsafe fn write_records([x, y, z, w]: [Self; RECORD], to: impl Records, k: usize) {
        // SAFETY: `store_records` checked that 16 records from the `k`th on lie within the column, with all their numbers.
        // `part` writes four of them in each of the four calls; `Avx512::detect` found AVX-512.
        unsafe {
            let [a, b, c, d] = Self::turned([x.0, y.0, z.0, w.0]);
            Self::part(a, to, k);
            Self::part(b, to, k + 1);
            Self::part(c, to, k + 2);
            Self::part(d, to, k + 3);
        }
    }
    #[inline(always)]
    unsafe fn four(from: impl Records, k: usize) -> __m512 {
        // SAFETY: `read_records` passes a `k` for which it knows records `k`, `k + 4`, `k + 8` and `k + 12`.
        // The loads ask for no alignment, and `Avx512::detect` found AVX-512.
        unsafe {
            let v = _mm512_castps128_ps512(_mm_loadu_ps(from.place(k)));
            let v = _mm512_insertf32x4::<1>(v, _mm_loadu_ps(from.place(k + 4)));
            let v = _mm512_insertf32x4::<2>(v, _mm_loadu_ps(from.place(k + 8)));
            _mm512_insertf32x4::<3>(v, _mm_loadu_ps(from.place(k + 12)))
        }
    }
    #[inline(always)]
    unsafe fn part(four: __m512, to: impl Records, k: usize) {
        // SAFETY: `write_records` passes a `k` for which it knows records `k`, `k + 4`, `k + 8` and `k + 12`.
        // The stores ask for no alignment, and `Avx512::detect` found AVX-512.
        unsafe {
            _mm_storeu_ps(to.place(k), _mm512_castps512_ps128(four));
            _mm_storeu_ps(to.place(k + 4), _mm512_extractf32x4_ps::<1>(four));
            _mm_storeu_ps(to.place(k + 8), _mm512_extractf32x4_ps::<2>(four));
            _mm_storeu_ps(to.place(k + 12), _mm512_extractf32x4_ps::<3>(four));
        }
    }
    #[inline(always)]
    unsafe fn turned(v: [__m512; 4]) -> [__m512; 4] {
        // SAFETY: `Avx512::detect` found AVX-512 before this kernel started; the block uses registers only.
        unsafe {
            turned!(
                v,
                _mm512_unpacklo_ps,
                _mm512_unpackhi_ps,
                _mm512_unpacklo_pd,
                _mm512_unpackhi_pd,
                _mm512_castps_pd,
                _mm512_castpd_ps
            )
        }
    }
}

// Double records: eight vectors become `N` runs of eight numbers. Two turns, and their quarters side by side.
impl Four {
    #[inline(always)]
    pub(super) unsafe fn write_doubles([a, b, c, d, e, f, g, h]: [Self; DOUBLE], to: RecordsAt<'_>, k: usize) {
        let first = Self::turned([a.0, b.0, c.0, d.0]);
        let second = Self::turned([e.0, f.0, g.0, h.0]);
        for i in 0..4 {
            // SAFETY: `store_doubles` checked that four double records from the `k`th on lie within the column.
            // Each has eight numbers. The stores ask for no alignment, and every x86-64 processor has SSE2.
            unsafe {
                _mm_storeu_ps(to.place(k + i), first[i]);
                _mm_storeu_ps(to.place(k + i).add(RECORD), second[i]);
            }
        }
    }
}

impl Eight {
    #[inline(always)]
    pub(super) unsafe fn write_doubles([a, b, c, d, e, f, g, h]: [Self; DOUBLE], to: RecordsAt<'_>, k: usize) {
        // SAFETY: `store_doubles` checked that eight double records from the `k`th on lie within the column.
        // Each has eight numbers. The stores ask for no alignment, and `Avx2::detect` found AVX2.
        unsafe {
            let first = Self::turned([a.0, b.0, c.0, d.0]);
            let second = Self::turned([e.0, f.0, g.0, h.0]);
            for i in 0..4 {
                _mm256_storeu_ps(to.place(k + i), _mm256_permute2f128_ps::<0x20>(first[i], second[i]));
                _mm256_storeu_ps(to.place(k + i + 4), _mm256_permute2f128_ps::<0x31>(first[i], second[i]));
            }
        }
    }
}

impl Sixteen {
    #[inline(always)]
    pub(super) unsafe fn write_doubles([a, b, c, d, e, f, g, h]: [Self; DOUBLE], to: RecordsAt<'_>, k: usize) {
        // SAFETY: `store_doubles` checked that 16 double records from the `k`th on lie within the column.
        // `halves` writes two of them in each of the eight calls; `Avx512::detect` found AVX-512.
        unsafe {
            let first = Self::turned([a.0, b.0, c.0, d.0]);
            let second = Self::turned([e.0, f.0, g.0, h.0]);
            let low = _mm512_setr_epi64(0, 1, 8, 9, 2, 3, 10, 11);
            let high = _mm512_setr_epi64(4, 5, 12, 13, 6, 7, 14, 15);
            for i in 0..4 {
                let (first, second) = (_mm512_castps_pd(first[i]), _mm512_castps_pd(second[i]));
                Self::halves(_mm512_permutex2var_pd(first, low, second), to, k + i);
                Self::halves(_mm512_permutex2var_pd(first, high, second), to, k + i + 8);
            }
        }
    }
    #[inline(always)]
    unsafe fn halves(two: __m512d, to: RecordsAt<'_>, k: usize) {
        // SAFETY: `write_doubles` passes a `k` for which it knows double records `k` and `k + 4`, of eight numbers each.
        // The stores ask for no alignment, and `Avx512::detect` found AVX-512.
        unsafe {
            let two = _mm512_castpd_ps(two);
            _mm256_storeu_ps(to.place(k), _mm512_castps512_ps256(two));
            _mm256_storeu_ps(to.place(k + 4), _mm512_extractf32x8_ps::<1>(two));
        }
    }
}
