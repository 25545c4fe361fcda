//! Four lanes in plain Rust, for processors whose vectors no other module has; the compiler makes vectors of them.

use std::ops::{Add, Mul, Neg, Sub};

use super::{Lanes, MOST, Mask, Numbers, Readable, WriteColumn};

/// Four numbers side by side, which the compiler puts into one register.
#[derive(Clone, Copy)]
pub struct Four([f32; 4]);

/// Four truth values, the mask of [`Four`].
#[derive(Clone, Copy)]
pub struct Answers([bool; 4]);

impl Mask for Answers {
    const N: usize = 4;

    #[inline(always)]
    fn any(self) -> bool {
        self.0.into_iter().any(|b| b)
    }
    #[inline(always)]
    fn and(self, other: Self) -> Self {
        Self(std::array::from_fn(|i| self.0[i] && other.0[i]))
    }
    #[inline(always)]
    fn bits(self) -> u32 {
        self.0.into_iter().enumerate().fold(0, |sum, (i, b)| sum | u32::from(b) << i)
    }
    #[inline(always)]
    fn of(bits: u32) -> Self {
        Self(std::array::from_fn(|i| bits >> i & 1 != 0))
    }
}

macro_rules! operator {
    ($trait:ident, $name:ident) => {
        impl $trait for Four {
            type Output = Self;
            #[inline(always)]
            fn $name(self, other: Self) -> Self {
                Self(std::array::from_fn(|i| self.0[i].$name(other.0[i])))
            }
        }
    };
}
operator!(Add, add);
operator!(Sub, sub);
operator!(Mul, mul);

impl Neg for Four {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self(self.0.map(|v| -v))
    }
}

impl Numbers for Four {
    const N: usize = 4;
    type Mask = Answers;

    #[inline(always)]
    fn splat(value: f32) -> Self {
        Self([value; 4])
    }
    #[inline(always)]
    fn load(from: impl Readable, at: usize) -> Self {
        Self(std::array::from_fn(|i| from.reader().get(at + i)))
    }
    #[inline(always)]
    fn load_part(from: impl Readable, at: usize, n: usize) -> Self {
        Self(std::array::from_fn(|i| if i < n { from.reader().get(at + i) } else { 0.0 }))
    }
    #[inline(always)]
    fn store(self, to: WriteColumn<'_>, at: usize) {
        self.store_part(to, at, 4);
    }
    #[inline(always)]
    fn store_part(self, to: WriteColumn<'_>, at: usize, n: usize) {
        self.0.into_iter().take(n).enumerate().for_each(|(i, v)| to.set(at + i, v));
    }
    #[inline(always)]
    fn div(self, by: Self) -> Self {
        Self(std::array::from_fn(|i| self.0[i] / by.0[i]))
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(self.0.map(f32::sqrt))
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Self(std::array::from_fn(|i| Numbers::min(self.0[i], other.0[i])))
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Self(std::array::from_fn(|i| Numbers::max(self.0[i], other.0[i])))
    }
    #[inline(always)]
    fn lt(self, other: Self) -> Answers {
        Answers(std::array::from_fn(|i| self.0[i] < other.0[i]))
    }
    #[inline(always)]
    fn select(self, mask: Answers, other: Self) -> Self {
        Self(std::array::from_fn(|i| if mask.0[i] { self.0[i] } else { other.0[i] }))
    }
    #[inline(always)]
    fn root_seed(self, magic: u32) -> Self {
        Self(self.0.map(|v| v.root_seed(magic)))
    }
    #[inline(always)]
    fn rotate_down(self) -> Self {
        let [a, b, c, d] = self.0;
        Self([b, c, d, a])
    }
    #[inline(always)]
    fn rotate_up(self) -> Self {
        let [a, b, c, d] = self.0;
        Self([d, a, b, c])
    }
    #[inline(always)]
    fn with_first(self, other: Self) -> Self {
        Self([other.0[0], self.0[1], self.0[2], self.0[3]])
    }
}

impl Lanes for Four {
    #[inline(always)]
    fn from_array(values: &[f32; MOST]) -> Self {
        Self(std::array::from_fn(|i| values[i]))
    }
    #[inline(always)]
    fn to_array(self) -> [f32; MOST] {
        std::array::from_fn(|i| if i < 4 { self.0[i] } else { 0.0 })
    }
}
