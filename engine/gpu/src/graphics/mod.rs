//! Graphics: an open device with the cloth's kernels, and garments on it whose state is a [`Cloth`](toile_engine::cloth::Cloth);
//! in a build without GPU support there is none, and opening one says so.
//!
//! Reads: cloths, and what surrounds them in a step. Writes: the same cloths, after the step.
//! Budget: [`Graphics::open`] some tenths of a second, [`Garments::lay`] some milliseconds a garment, both at load; a step waits for
//! its result.
//! Thread: any; a device may be shared.

#[cfg(not(feature = "wgpu"))]
mod absent;
#[cfg(feature = "wgpu")]
mod present;

#[cfg(not(feature = "wgpu"))]
pub use absent::{Garments, Graphics, Spent, Work};
#[cfg(feature = "wgpu")]
pub use present::{Garments, Graphics, Spent, Work};
