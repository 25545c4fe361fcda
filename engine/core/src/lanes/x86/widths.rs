//! What each width of x86-64 does in its own way: masks, parts of a vector, index lists, the seed of a root.
//!
//! Soundness: SSE2 is part of x86-64. The wider types exist only in kernels that `Avx2::run` and `Avx512::run` start, and only
//! `detect` makes a value of these two types, where it found the features.

use super::*;

impl Four {
    /// The first `n < 4` numbers at a place. Never by way of an array: a vector read from what was just written number
    /// by number has to wait until all of it has reached the cache.
    #[inline(always)]
    pub(super) unsafe fn read(place: *const f32, n: usize) -> Self {
        // SAFETY: `load_part` checked that the column has `n` numbers there, and no branch reads more.
        Self(unsafe {
            match n {
                1 => _mm_load_ss(place),
                2 => _mm_castpd_ps(_mm_load_sd(place.cast())),
                3 => _mm_movelh_ps(_mm_castpd_ps(_mm_load_sd(place.cast())), _mm_load_ss(place.add(2))),
                _ => _mm_setzero_ps(),
            }
        })
    }
    #[inline(always)]
    pub(super) unsafe fn write(self, place: *mut f32, n: usize) {
        // SAFETY: `store_part` checked that the column has `n` numbers there, and no branch writes more.
        unsafe {
            match n {
                1 => _mm_store_ss(place, self.0),
                2 => _mm_store_sd(place.cast(), _mm_castps_pd(self.0)),
                3 => {
                    _mm_store_sd(place.cast(), _mm_castps_pd(self.0));
                    _mm_store_ss(place.add(2), _mm_movehl_ps(self.0, self.0));
                }
                _ => {}
            }
        }
    }
    #[inline(always)]
    pub(super) fn less(self, o: Self) -> Answers4 {
        // SAFETY: every x86-64 processor has SSE2, and the block uses registers only.
        Answers4(unsafe { _mm_cmplt_ps(self.0, o.0) })
    }
    #[inline(always)]
    pub(super) fn choose(self, mask: Answers4, o: Self) -> Self {
        // SAFETY: every x86-64 processor has SSE2, and the block uses registers only.
        Self(unsafe { _mm_or_ps(_mm_and_ps(mask.0, self.0), _mm_andnot_ps(mask.0, o.0)) })
    }
    #[inline(always)]
    pub(super) fn seed(self, magic: u32) -> Self {
        // SAFETY: every x86-64 processor has SSE2, and the block uses registers only.
        Self(unsafe {
            let half = _mm_srli_epi32::<1>(_mm_castps_si128(self.0));
            _mm_castsi128_ps(_mm_sub_epi32(_mm_set1_epi32(magic.cast_signed()), half))
        })
    }
}

by_hand!(Four, pick, spread);
by_hand!(Eight, pick, spread);

impl Four {
    /// The numbers at four places.
    #[inline(always)]
    fn pick_all(from: impl Readable, index: &[u32]) -> Self {
        let from = from.reader();
        let [a, b, c, d] = [index[0], index[1], index[2], index[3]];
        let [a, b, c, d] = [from.get(a as usize), from.get(b as usize), from.get(c as usize), from.get(d as usize)];
        // SAFETY: every x86-64 processor has SSE2, and the block uses registers only.
        Self(unsafe { _mm_setr_ps(a, b, c, d) })
    }
}

impl Eight {
    /// The numbers at eight places.
    #[inline(always)]
    fn pick_all(from: impl Readable, index: &[u32]) -> Self {
        let [a, b] = [Four::pick_all(from, index), Four::pick_all(from, &index[4..])];
        // SAFETY: `Avx2::detect` found AVX2 before this kernel started; the block uses registers only.
        Self(unsafe { _mm256_insertf128_ps::<1>(_mm256_castps128_ps256(a.0), b.0) })
    }
}

impl Sixteen {
    #[inline(always)]
    pub(super) fn pick_among(table: &[f32; TABLE], at: &[u32; MOST]) -> Self {
        let [low, high] = [table.as_ptr(), table[MOST..].as_ptr()];
        // SAFETY: both halves of the table and all places are there; of a place its lowest five bits count.
        Self(unsafe {
            let at = _mm512_loadu_epi32(at.as_ptr().cast());
            _mm512_permutex2var_ps(_mm512_loadu_ps(low), at, _mm512_loadu_ps(high))
        })
    }
    #[inline(always)]
    pub(super) fn pick(from: impl Readable, index: &[u32]) -> Self {
        let (first, at) = Self::places(from, index);
        // SAFETY: `places` checked that every used lane's place lies within the column; unused lanes are masked and read nothing.
        // `Avx512::detect` found AVX-512.
        Self(unsafe { _mm512_mask_i32gather_ps::<4>(_mm512_setzero_ps(), first, at, from.reader().place(0, 0)) })
    }
    #[inline(always)]
    pub(super) fn spread(self, to: WriteColumn<'_>, index: &[u32]) {
        let (first, at) = Self::places(to, index);
        // SAFETY: `places` checked that every used lane's place lies within the column; unused lanes are masked and write nothing.
        // `Avx512::detect` found AVX-512.
        unsafe { _mm512_mask_i32scatter_ps::<4>(to.place(0, 0), first, at, self.0) }
    }
    /// Which lanes are used, and their places: all within the column.
    #[inline(always)]
    fn places(column: impl Readable, index: &[u32]) -> (__mmask16, __m512i) {
        let first = Self::first(index.len().min(MOST));
        // SAFETY: masked to the list's length.
        let at = unsafe { _mm512_maskz_loadu_epi32(first, index.as_ptr().cast()) };
        // SAFETY: `Avx512::detect` found AVX-512 before this kernel started; the block uses registers only.
        let len = unsafe { _mm512_set1_epi32(column.reader().len().min(i32::MAX as usize) as i32) };
        // SAFETY: `Avx512::detect` found AVX-512 before this kernel started; the block uses registers only.
        let outside = unsafe { _mm512_mask_cmpge_epu32_mask(first, at, len) };
        assert!(outside == 0, "a kernel left its column");
        (first, at)
    }
}

impl Four {
    #[inline(always)]
    pub(super) fn lowest(self) -> f32 {
        // SAFETY: every x86-64 processor has SSE2, and the block uses registers only.
        unsafe {
            let two = _mm_min_ps(self.0, _mm_movehl_ps(self.0, self.0));
            _mm_cvtss_f32(_mm_min_ss(two, _mm_shuffle_ps::<1>(two, two)))
        }
    }
}

impl Eight {
    #[inline(always)]
    pub(super) fn lowest(self) -> f32 {
        // SAFETY: `Avx2::detect` found AVX2 before this kernel started; the block uses registers only.
        let [a, b] = unsafe { [_mm256_castps256_ps128(self.0), _mm256_extractf128_ps::<1>(self.0)] };
        // SAFETY: every x86-64 processor has SSE2, and the block uses registers only.
        Four(unsafe { _mm_min_ps(a, b) }).lowest()
    }
}

impl Sixteen {
    #[inline(always)]
    pub(super) fn lowest(self) -> f32 {
        // SAFETY: `Avx512::detect` found AVX-512 before this kernel started; the block uses registers only.
        let [a, b] = unsafe { [_mm512_castps512_ps256(self.0), _mm512_extractf32x8_ps::<1>(self.0)] };
        // SAFETY: `Avx512::detect` found AVX2 along with AVX-512; the block uses registers only.
        Eight(unsafe { _mm256_min_ps(a, b) }).lowest()
    }
}

// Quads: four numbers at each of four places.
impl Four {
    #[inline(always)]
    pub(super) unsafe fn read_quads(at: [*const f32; 4], first: usize) -> Self {
        // SAFETY: `load_quads` took the places from `quads`, which checked that the column has four numbers at each.
        // The load asks for no alignment, and every x86-64 processor has SSE2.
        Self(unsafe { _mm_loadu_ps(at[first]) })
    }
    #[inline(always)]
    pub(super) unsafe fn write_quads(self, at: [*mut f32; 4], first: usize) {
        // SAFETY: `store_quads` took the places from `quads`, which checked that the column has four numbers at each.
        // The store asks for no alignment, and every x86-64 processor has SSE2.
        unsafe { _mm_storeu_ps(at[first], self.0) }
    }
}

impl Eight {
    #[inline(always)]
    pub(super) unsafe fn read_quads(at: [*const f32; 4], first: usize) -> Self {
        let [a, b] = [at[first], at[(first + 1) % 4]];
        // SAFETY: `load_quads` took the places from `quads`, which checked that the column has four numbers at each.
        // The loads ask for no alignment, and `Avx2::detect` found AVX2.
        Self(unsafe { _mm256_insertf128_ps::<1>(_mm256_castps128_ps256(_mm_loadu_ps(a)), _mm_loadu_ps(b)) })
    }
    #[inline(always)]
    pub(super) unsafe fn write_quads(self, at: [*mut f32; 4], first: usize) {
        // SAFETY: `store_quads` took the places from `quads`, which checked that the column has four numbers at each.
        // The stores ask for no alignment, and `Avx2::detect` found AVX2.
        unsafe {
            _mm_storeu_ps(at[first], _mm256_castps256_ps128(self.0));
            _mm_storeu_ps(at[(first + 1) % 4], _mm256_extractf128_ps::<1>(self.0));
        }
    }
}

impl Sixteen {
    #[inline(always)]
    pub(super) unsafe fn read_quads(at: [*const f32; 4], _: usize) -> Self {
        // SAFETY: `load_quads` took the places from `quads`, which checked that the column has four numbers at each.
        // The loads ask for no alignment, and `Avx512::detect` found AVX-512.
        unsafe {
            let v = _mm512_castps128_ps512(_mm_loadu_ps(at[0]));
            let v = _mm512_insertf32x4::<1>(v, _mm_loadu_ps(at[1]));
            let v = _mm512_insertf32x4::<2>(v, _mm_loadu_ps(at[2]));
            Self(_mm512_insertf32x4::<3>(v, _mm_loadu_ps(at[3])))
        }
    }
    #[inline(always)]
    pub(super) unsafe fn write_quads(self, at: [*mut f32; 4], _: usize) {
        // SAFETY: `store_quads` took the places from `quads`, which checked that the column has four numbers at each.
        // The stores ask for no alignment, and `Avx512::detect` found AVX-512.
        unsafe {
            _mm_storeu_ps(at[0], _mm512_castps512_ps128(self.0));
            _mm_storeu_ps(at[1], _mm512_extractf32x4_ps::<1>(self.0));
            _mm_storeu_ps(at[2], _mm512_extractf32x4_ps::<2>(self.0));
            _mm_storeu_ps(at[3], _mm512_extractf32x4_ps::<3>(self.0));
        }
    }
}

impl Mask for Answers4 {
    const N: usize = 4;

    #[inline(always)]
    fn any(self) -> bool {
        self.bits() != 0
    }
    #[inline(always)]
    fn and(self, o: Self) -> Self {
        // SAFETY: every x86-64 processor has SSE2, and the block uses registers only.
        Self(unsafe { _mm_and_ps(self.0, o.0) })
    }
    #[inline(always)]
    fn bits(self) -> u32 {
        // SAFETY: every x86-64 processor has SSE2, and the block uses registers only.
        (unsafe { _mm_movemask_ps(self.0) }).cast_unsigned()
    }
    #[inline(always)]
    fn of(bits: u32) -> Self {
        // SAFETY: every x86-64 processor has SSE2, and the block uses registers only.
        Self(unsafe {
            let lane = _mm_setr_epi32(1, 2, 4, 8);
            let bits = _mm_set1_epi32(bits.cast_signed());
            _mm_castsi128_ps(_mm_cmpeq_epi32(_mm_and_si128(bits, lane), lane))
        })
    }
}

impl Eight {
    #[inline(always)]
    pub(super) unsafe fn read(place: *const f32, n: usize) -> Self {
        // SAFETY: `load_part` checked that the column has `n` numbers there; the mask of `first` lets the load read no others.
        // `Avx2::detect` found AVX2.
        Self(unsafe { _mm256_maskload_ps(place, Self::first(n)) })
    }
    #[inline(always)]
    pub(super) unsafe fn write(self, place: *mut f32, n: usize) {
        // SAFETY: `store_part` checked that the column has `n` numbers there; the mask of `first` lets the store write no others.
        // `Avx2::detect` found AVX2.
        unsafe { _mm256_maskstore_ps(place, Self::first(n), self.0) }
    }
    #[inline(always)]
    fn first(n: usize) -> __m256i {
        // SAFETY: the load begins between entry 0 and entry 8 of `FIRST`, which has 16 entries, and reads eight. It asks for no
        // alignment, and `Avx2::detect` found AVX2.
        unsafe { _mm256_loadu_si256(FIRST.as_ptr().add(8 - n.min(8)).cast()) }
    }
    #[inline(always)]
    pub(super) fn less(self, o: Self) -> Answers8 {
        // SAFETY: `Avx2::detect` found AVX2 before this kernel started; the block uses registers only.
        Answers8(unsafe { _mm256_cmp_ps::<_CMP_LT_OQ>(self.0, o.0) })
    }
    #[inline(always)]
    pub(super) fn choose(self, mask: Answers8, o: Self) -> Self {
        // SAFETY: `Avx2::detect` found AVX2 before this kernel started; the block uses registers only.
        Self(unsafe { _mm256_blendv_ps(o.0, self.0, mask.0) })
    }
    #[inline(always)]
    pub(super) fn seed(self, magic: u32) -> Self {
        // SAFETY: `Avx2::detect` found AVX2 before this kernel started; the block uses registers only.
        Self(unsafe {
            let half = _mm256_srli_epi32::<1>(_mm256_castps_si256(self.0));
            _mm256_castsi256_ps(_mm256_sub_epi32(_mm256_set1_epi32(magic.cast_signed()), half))
        })
    }
}

impl Mask for Answers8 {
    const N: usize = 8;

    #[inline(always)]
    fn any(self) -> bool {
        self.bits() != 0
    }
    #[inline(always)]
    fn and(self, o: Self) -> Self {
        // SAFETY: `Avx2::detect` found AVX2 before this kernel started; the block uses registers only.
        Self(unsafe { _mm256_and_ps(self.0, o.0) })
    }
    #[inline(always)]
    fn bits(self) -> u32 {
        // SAFETY: `Avx2::detect` found AVX2 before this kernel started; the block uses registers only.
        (unsafe { _mm256_movemask_ps(self.0) }).cast_unsigned()
    }
    #[inline(always)]
    fn of(bits: u32) -> Self {
        // SAFETY: `Avx2::detect` found AVX2 before this kernel started; the block uses registers only.
        Self(unsafe {
            let lane = _mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128);
            let bits = _mm256_set1_epi32(bits.cast_signed());
            _mm256_castsi256_ps(_mm256_cmpeq_epi32(_mm256_and_si256(bits, lane), lane))
        })
    }
}

impl Sixteen {
    #[inline(always)]
    pub(super) unsafe fn read(place: *const f32, n: usize) -> Self {
        // SAFETY: `load_part` checked that the column has `n` numbers there; the mask of `first` lets the load read no others.
        // `Avx512::detect` found AVX-512.
        Self(unsafe { _mm512_maskz_loadu_ps(Self::first(n), place) })
    }
    #[inline(always)]
    pub(super) unsafe fn write(self, place: *mut f32, n: usize) {
        // SAFETY: `store_part` checked that the column has `n` numbers there; the mask of `first` lets the store write no others.
        // `Avx512::detect` found AVX-512.
        unsafe { _mm512_mask_storeu_ps(place, Self::first(n), self.0) }
    }
    #[inline(always)]
    fn first(n: usize) -> __mmask16 {
        ((1u32 << n) - 1) as __mmask16
    }
    #[inline(always)]
    pub(super) fn less(self, o: Self) -> Answers16 {
        // SAFETY: `Avx512::detect` found AVX-512 before this kernel started; the block uses registers only.
        Answers16(unsafe { _mm512_cmp_ps_mask::<_CMP_LT_OQ>(self.0, o.0) })
    }
    #[inline(always)]
    pub(super) fn choose(self, mask: Answers16, o: Self) -> Self {
        // SAFETY: `Avx512::detect` found AVX-512 before this kernel started; the block uses registers only.
        Self(unsafe { _mm512_mask_blend_ps(mask.0, o.0, self.0) })
    }
    #[inline(always)]
    pub(super) fn seed(self, magic: u32) -> Self {
        // SAFETY: `Avx512::detect` found AVX-512 before this kernel started; the block uses registers only.
        Self(unsafe {
            let half = _mm512_srli_epi32::<1>(_mm512_castps_si512(self.0));
            _mm512_castsi512_ps(_mm512_sub_epi32(_mm512_set1_epi32(magic.cast_signed()), half))
        })
    }
}

impl Mask for Answers16 {
    const N: usize = 16;

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

// The lanes of a fiber's neighbours: one lane on, one lane back.
impl Four {
    #[inline(always)]
    pub(super) fn down(self) -> Self {
        // SAFETY: every x86-64 processor has SSE2, and the block uses registers only.
        Self(unsafe { _mm_shuffle_ps::<0b00_11_10_01>(self.0, self.0) })
    }
    #[inline(always)]
    pub(super) fn up(self) -> Self {
        // SAFETY: every x86-64 processor has SSE2, and the block uses registers only.
        Self(unsafe { _mm_shuffle_ps::<0b10_01_00_11>(self.0, self.0) })
    }
    #[inline(always)]
    pub(super) fn but_first(self, other: Self) -> Self {
        // SAFETY: every x86-64 processor has SSE2, and the block uses registers only.
        Self(unsafe { _mm_move_ss(self.0, other.0) })
    }
}

impl Eight {
    #[inline(always)]
    pub(super) fn down(self) -> Self {
        // SAFETY: `Avx2::detect` found AVX2 before this kernel started; the block uses registers only.
        Self(unsafe { _mm256_permutevar8x32_ps(self.0, _mm256_setr_epi32(1, 2, 3, 4, 5, 6, 7, 0)) })
    }
    #[inline(always)]
    pub(super) fn up(self) -> Self {
        // SAFETY: `Avx2::detect` found AVX2 before this kernel started; the block uses registers only.
        Self(unsafe { _mm256_permutevar8x32_ps(self.0, _mm256_setr_epi32(7, 0, 1, 2, 3, 4, 5, 6)) })
    }
    #[inline(always)]
    pub(super) fn but_first(self, other: Self) -> Self {
        // SAFETY: `Avx2::detect` found AVX2 before this kernel started; the block uses registers only.
        Self(unsafe { _mm256_blend_ps::<1>(self.0, other.0) })
    }
}

impl Sixteen {
    #[inline(always)]
    pub(super) fn down(self) -> Self {
        // SAFETY: `Avx512::detect` found AVX-512 before this kernel started; the block uses registers only.
        let v = unsafe { _mm512_castps_si512(self.0) };
        // SAFETY: `Avx512::detect` found AVX-512 before this kernel started; the block uses registers only.
        Self(unsafe { _mm512_castsi512_ps(_mm512_alignr_epi32::<1>(v, v)) })
    }
    #[inline(always)]
    pub(super) fn up(self) -> Self {
        // SAFETY: `Avx512::detect` found AVX-512 before this kernel started; the block uses registers only.
        let v = unsafe { _mm512_castps_si512(self.0) };
        // SAFETY: `Avx512::detect` found AVX-512 before this kernel started; the block uses registers only.
        Self(unsafe { _mm512_castsi512_ps(_mm512_alignr_epi32::<15>(v, v)) })
    }
    #[inline(always)]
    pub(super) fn but_first(self, other: Self) -> Self {
        // SAFETY: `Avx512::detect` found AVX-512 before this kernel started; the block uses registers only.
        Self(unsafe { _mm512_mask_blend_ps(1, self.0, other.0) })
    }
}
