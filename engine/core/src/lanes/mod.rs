//! Lanes: one kernel, run on 1, 4, 8 or 16 numbers at a time.
//!
//! Every operation is one that IEEE 754 rounds exactly: no fused multiply-add, no estimate of the processor. A kernel
//! therefore gives the same bits at every width and on every machine.
//!
//! This is one of the few modules with unsafe code: vector instructions, and columns that workers share.

#[expect(unsafe_code, reason = "the workers of a step share its columns")]
mod column;
mod math;
#[cfg(target_arch = "aarch64")]
#[expect(unsafe_code, reason = "vector instructions, which every aarch64 has")]
mod neon;
#[cfg(not(any(
    target_arch = "x86_64",
    target_arch = "aarch64",
    all(target_arch = "wasm32", target_feature = "simd128")
)))]
mod quad;
#[expect(unsafe_code, reason = "places that were checked when they were listed")]
mod records;
mod scalar;
#[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
#[expect(unsafe_code, reason = "numbers are read and written at places that were checked")]
mod simd128;
mod traits;
mod two;
mod vector;
#[cfg(target_arch = "x86_64")]
#[expect(unsafe_code, reason = "vector instructions, picked at run time")]
mod x86;

use std::fmt;

pub(crate) use column::Shared;
pub use column::{MOST, ReadColumn, Readable, Store, TABLE, WriteColumn};
pub use math::{V3, reciprocal_root};
pub use records::{DOUBLE, RECORD, RecordList, RecordRun, Records, RecordsAt};
pub use traits::{Kernel, Lanes, Mask, Numbers};
pub use two::Two;

#[cfg(target_arch = "aarch64")]
use neon::Four;
#[cfg(not(any(
    target_arch = "x86_64",
    target_arch = "aarch64",
    all(target_arch = "wasm32", target_feature = "simd128")
)))]
use quad::Four;
#[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
use simd128::Four;
#[cfg(target_arch = "x86_64")]
use x86::Four;

toile_base::named! {
    /// How many lanes kernels run on, narrowest first.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
    pub enum Width {
        /// Plain f32: the reference that the others are held against.
        One,
        /// What every x86-64 and aarch64 has, and WebAssembly with SIMD128.
        Four,
        /// 256 bits at once: AVX2.
        Eight,
        /// 512 bits at once: AVX-512.
        Sixteen,
    }
}

impl Width {
    /// Number of lanes.
    pub fn lanes(self) -> usize {
        match self {
            Self::One => 1,
            Self::Four => 4,
            Self::Eight => 8,
            Self::Sixteen => 16,
        }
    }

    /// The width of so many lanes.
    pub fn of(lanes: usize) -> Option<Self> {
        Self::ALL.into_iter().find(|w| w.lanes() == lanes)
    }

    /// Whether this processor has it.
    pub fn available(self) -> bool {
        match self {
            Self::One | Self::Four => true,
            #[cfg(target_arch = "x86_64")]
            Self::Eight => x86::Avx2::detect().is_some(),
            #[cfg(target_arch = "x86_64")]
            Self::Sixteen => x86::Avx512::detect().is_some(),
            #[cfg(not(target_arch = "x86_64"))]
            _ => false,
        }
    }

    /// The widest that this processor has.
    pub fn widest() -> Self {
        Self::ALL.into_iter().rfind(|w| w.available()).unwrap_or(Self::One)
    }

    /// Runs a kernel at this width, or at the widest below it that the processor has.
    #[inline]
    pub fn run<K: Kernel>(self, kernel: K) -> K::Out {
        #[cfg(target_arch = "x86_64")]
        if self == Self::Sixteen
            && let Some(avx512) = x86::Avx512::detect()
        {
            return avx512.run(kernel);
        }
        #[cfg(target_arch = "x86_64")]
        if self >= Self::Eight
            && let Some(avx2) = x86::Avx2::detect()
        {
            return avx2.run(kernel);
        }
        if self == Self::One { kernel.run::<f32>() } else { kernel.run::<Four>() }
    }
}

impl fmt::Display for Width {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.lanes())
    }
}

#[cfg(test)]
mod tests;
