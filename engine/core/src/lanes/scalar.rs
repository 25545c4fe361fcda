//! One lane: f32 itself. The scalar reference of every kernel.

use super::{Lanes, MOST, Mask, Numbers, Readable, WriteColumn};

impl Mask for bool {
    const N: usize = 1;

    #[inline(always)]
    fn any(self) -> bool {
        self
    }
    #[inline(always)]
    fn and(self, other: Self) -> Self {
        self && other
    }
    #[inline(always)]
    fn bits(self) -> u32 {
        u32::from(self)
    }
    #[inline(always)]
    fn of(bits: u32) -> Self {
        bits & 1 != 0
    }
}

impl Numbers for f32 {
    const N: usize = 1;
    type Mask = bool;

    #[inline(always)]
    fn splat(value: f32) -> Self {
        value
    }
    #[inline(always)]
    fn load(from: impl Readable, at: usize) -> Self {
        from.reader().get(at)
    }
    #[inline(always)]
    fn load_part(_: impl Readable, _: usize, _: usize) -> Self {
        0.0
    }
    #[inline(always)]
    fn store(self, to: WriteColumn<'_>, at: usize) {
        to.set(at, self);
    }
    #[inline(always)]
    fn store_part(self, _: WriteColumn<'_>, _: usize, _: usize) {}
    #[inline(always)]
    fn div(self, by: Self) -> Self {
        self / by
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        f32::sqrt(self)
    }
    // As the processors' instructions have it, which `f32::min` is not where a number is missing.
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        if self < other { self } else { other }
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        if self > other { self } else { other }
    }
    #[inline(always)]
    fn lt(self, other: Self) -> bool {
        self < other
    }
    #[inline(always)]
    fn select(self, mask: bool, other: Self) -> Self {
        if mask { self } else { other }
    }
    #[inline(always)]
    fn root_seed(self, magic: u32) -> Self {
        f32::from_bits(magic.wrapping_sub(self.to_bits() >> 1))
    }
    #[inline(always)]
    fn rotate_down(self) -> Self {
        self
    }
    #[inline(always)]
    fn rotate_up(self) -> Self {
        self
    }
    #[inline(always)]
    fn with_first(self, other: Self) -> Self {
        other
    }
}

impl Lanes for f32 {
    #[inline(always)]
    fn from_array(values: &[f32; MOST]) -> Self {
        values[0]
    }
    #[inline(always)]
    fn to_array(self) -> [f32; MOST] {
        let mut out = [0.0; MOST];
        out[0] = self;
        out
    }
    #[inline(always)]
    fn load_quads(from: impl Readable, quads: &[u32; 4], lane: usize) -> Self {
        from.reader().get(quads[lane / 4 % 4] as usize + lane % 4)
    }
    #[inline(always)]
    fn store_quads(self, to: WriteColumn<'_>, quads: &[u32; 4], lane: usize) {
        to.set(quads[lane / 4 % 4] as usize + lane % 4, self);
    }
}
