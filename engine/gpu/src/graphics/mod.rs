//! An open device with the cloth's kernels, garments on it whose state is a [`Cloth`](toile_engine::cloth::Cloth), and skins;
//! in a build without GPU support opening one is an error.
//!
//! Reads: cloths, and what surrounds them in a step. Writes: the same cloths, after the step.
//! Budget: [`Graphics::open`] some tenths of a second, [`DeviceGarments::lay`] some milliseconds a garment, both at load; a step waits for
//! its result.
//! Thread: any; a device may be shared.

#[cfg(feature = "wgpu")]
mod with_wgpu;
#[cfg(not(feature = "wgpu"))]
mod without_wgpu;

#[cfg(feature = "wgpu")]
mod device_skins;

#[cfg(feature = "wgpu")]
pub use device_skins::DeviceSkins;
#[cfg(feature = "wgpu")]
pub use with_wgpu::{DeviceGarments, Graphics};
#[cfg(not(feature = "wgpu"))]
pub use without_wgpu::{DeviceGarments, DeviceSkins, Graphics};

pub use crate::device_work::{StageTimes, StepWork};
