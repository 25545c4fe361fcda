//! Bodies that a device skins, for benchmarks: what came back can be waited for, and the device's clock read.

use glam::{Affine3A, Vec3};
use toile_base::skeleton::BONES;
use toile_engine::skin::{Blend, SkinningJob};

use super::Graphics;
use crate::device::{AdapterChoice, Device, GpuError};
use crate::skin::{Skinning, needs};

/// Bodies on a device.
#[derive(Debug)]
pub struct DeviceSkins {
    device: Device,
    skinning: Skinning,
}

impl DeviceSkins {
    /// Lays skins out on a device, or on the same adapter opened once more where they need more than the least limits.
    ///
    /// # Errors
    /// One sentence with the cure: a limit that is too small, or a device that is lost.
    pub fn lay(graphics: &Graphics, jobs: &[&SkinningJob]) -> Result<Self, String> {
        let needs = needs(jobs);
        let opened = &graphics.opened().device;
        let laid = || -> Result<Self, GpuError> {
            let device = match opened.takes(needs) {
                Ok(()) => opened.clone(),
                Err(_) => Device::open(&AdapterChoice::Named(graphics.adapter().name.clone()), needs)?,
            };
            let skinning = Skinning::new(&device, jobs)?;
            Ok(Self { device, skinning })
        };
        laid().map_err(|e| e.to_string())
    }

    /// Poses the bodies, each by its palette, without waiting; with `fetch` the result comes back.
    ///
    /// # Errors
    /// One sentence: the device is lost.
    pub fn step(&mut self, blend: Blend, palettes: &[&[Affine3A; BONES]], fetch: bool) -> Result<(), String> {
        self.skinning.fetch = fetch;
        self.skinning.step(&self.device, blend, palettes).map_err(|e| e.to_string())
    }

    /// Waits for everything that was sent, and takes it in.
    ///
    /// # Errors
    /// As [`DeviceSkins::step`].
    pub fn finish(&mut self) -> Result<(), String> {
        self.skinning.finish(&self.device).map_err(|e| e.to_string())
    }

    /// Time of one dispatch over all bodies by the device's own clock (ns), the mean of so many; none where it has none.
    ///
    /// # Errors
    /// As [`DeviceSkins::step`].
    pub fn device_ns(&self, blend: Blend, dispatches: u32) -> Result<Option<f64>, String> {
        self.skinning.device_ns(&self.device, blend, dispatches).map_err(|e| e.to_string())
    }

    /// World positions (m) of a body at the newest step that has come back `[vertices]`.
    ///
    /// # Panics
    /// Where there is no such body.
    pub fn positions(&self, body: usize) -> &[Vec3] {
        self.skinning.positions(body)
    }

    /// Unit normals of a body, as of the same step `[vertices]`.
    ///
    /// # Panics
    /// Where there is no such body.
    pub fn normals(&self, body: usize) -> &[Vec3] {
        self.skinning.normals(body)
    }
}
