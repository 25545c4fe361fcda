//! Two vectors as one: where each operation waits for the one before it, the two do not wait for each other.

use std::ops::{Add, Mul, Neg, Sub};

use super::{Mask, Numbers, Readable, WriteColumn};

/// Two values of a type side by side: twice the lanes.
#[derive(Clone, Copy)]
pub struct Two<L>(L, L);

impl<M: Mask> Mask for Two<M> {
    const N: usize = 2 * M::N;

    #[inline(always)]
    fn any(self) -> bool {
        self.0.any() || self.1.any()
    }
    #[inline(always)]
    fn and(self, other: Self) -> Self {
        Self(self.0.and(other.0), self.1.and(other.1))
    }
    #[inline(always)]
    fn bits(self) -> u32 {
        self.0.bits() | self.1.bits() << M::N
    }
    #[inline(always)]
    fn of(bits: u32) -> Self {
        Self(M::of(bits), M::of(bits >> M::N))
    }
}

macro_rules! operator {
    ($trait:ident, $name:ident) => {
        impl<L: Numbers> $trait for Two<L> {
            type Output = Self;
            #[inline(always)]
            fn $name(self, other: Self) -> Self {
                Self(self.0.$name(other.0), self.1.$name(other.1))
            }
        }
    };
}
operator!(Add, add);
operator!(Sub, sub);
operator!(Mul, mul);

impl<L: Numbers> Neg for Two<L> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self(-self.0, -self.1)
    }
}

impl<L: Numbers> Numbers for Two<L> {
    const N: usize = 2 * L::N;
    type Mask = Two<L::Mask>;

    #[inline(always)]
    fn splat(value: f32) -> Self {
        Self(L::splat(value), L::splat(value))
    }
    #[inline(always)]
    fn load(from: impl Readable, at: usize) -> Self {
        Self(L::load(from, at), L::load(from, at + L::N))
    }
    #[inline(always)]
    fn load_part(from: impl Readable, at: usize, n: usize) -> Self {
        if n < L::N {
            Self(L::load_part(from, at, n), L::splat(0.0))
        } else {
            Self(L::load(from, at), L::load_part(from, at + L::N, n - L::N))
        }
    }
    #[inline(always)]
    fn store(self, to: WriteColumn<'_>, at: usize) {
        self.0.store(to, at);
        self.1.store(to, at + L::N);
    }
    #[inline(always)]
    fn store_part(self, to: WriteColumn<'_>, at: usize, n: usize) {
        if n < L::N {
            self.0.store_part(to, at, n);
        } else {
            self.0.store(to, at);
            self.1.store_part(to, at + L::N, n - L::N);
        }
    }
    #[inline(always)]
    fn div(self, by: Self) -> Self {
        Self(self.0.div(by.0), self.1.div(by.1))
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(self.0.sqrt(), self.1.sqrt())
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Self(self.0.min(other.0), self.1.min(other.1))
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Self(self.0.max(other.0), self.1.max(other.1))
    }
    #[inline(always)]
    fn lt(self, other: Self) -> Self::Mask {
        Two(self.0.lt(other.0), self.1.lt(other.1))
    }
    #[inline(always)]
    fn select(self, mask: Self::Mask, other: Self) -> Self {
        Self(self.0.select(mask.0, other.0), self.1.select(mask.1, other.1))
    }
    #[inline(always)]
    fn root_seed(self, magic: u32) -> Self {
        Self(self.0.root_seed(magic), self.1.root_seed(magic))
    }
    #[inline(always)]
    fn rotate_down(self) -> Self {
        Self(self.0.with_first(self.1).rotate_down(), self.1.with_first(self.0).rotate_down())
    }
    #[inline(always)]
    fn rotate_up(self) -> Self {
        let (low, high) = (self.0.rotate_up(), self.1.rotate_up());
        Self(low.with_first(high), high.with_first(low))
    }
    #[inline(always)]
    fn with_first(self, other: Self) -> Self {
        Self(self.0.with_first(other.0), self.1)
    }
}
