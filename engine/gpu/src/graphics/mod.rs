//! An open device with the cloth's kernels, garments on it whose state is a [`Cloth`](toile_engine::cloth::Cloth), and skins;
//! in a build without GPU support opening one is an error.

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
