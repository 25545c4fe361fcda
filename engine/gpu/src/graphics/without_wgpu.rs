//! No device: this build has no GPU support. Values of these types cannot be made.

use std::convert::Infallible;

use glam::{Affine3A, Vec3};
use toile_base::skeleton::BONES;
use toile_engine::skin::{Blend, SkinningJob};

use crate::Adapter;
use crate::cloth_batch::ClothBatch;
use crate::device_work::{StageTimes, StepWork};

/// An open device.
#[derive(Debug, Clone)]
pub struct Graphics(Infallible);

/// Garments on a device.
#[derive(Debug)]
pub struct DeviceGarments(Infallible);

/// Bodies on a device.
#[derive(Debug)]
pub struct DeviceSkins(Infallible);

impl Graphics {
    /// Opens no device.
    ///
    /// # Errors
    /// Always: one sentence with the cure.
    pub fn open() -> Result<Self, String> {
        Err("this build has no GPU support; build it with `--features gpu`".to_owned())
    }

    /// Name, backend and driver of the adapter.
    pub fn adapter(&self) -> &Adapter {
        match self.0 {}
    }
}

impl DeviceGarments {
    /// Lays garments out on a device.
    ///
    /// # Errors
    /// Never: there is no device.
    pub fn lay(graphics: &Graphics, _: &ClothBatch<'_, '_>) -> Result<Self, String> {
        match graphics.0 {}
    }

    /// Whether these garments can be stepped as they are laid out.
    pub fn holds(&self, _: &ClothBatch<'_, '_>) -> bool {
        match self.0 {}
    }

    /// One step.
    ///
    /// # Errors
    /// Never: there is no device.
    pub fn step(&mut self, _: &mut ClothBatch<'_, '_>) -> Result<(), String> {
        match self.0 {}
    }

    /// What a plain step asks of the device.
    pub fn work(&self) -> StepWork {
        match self.0 {}
    }

    /// What the device spent.
    pub fn spent(&self) -> Option<StageTimes> {
        match self.0 {}
    }
}

impl DeviceSkins {
    /// Lays skins out on a device.
    ///
    /// # Errors
    /// Never: there is no device.
    pub fn lay(graphics: &Graphics, _: &[&SkinningJob]) -> Result<Self, String> {
        match graphics.0 {}
    }

    /// Poses the bodies.
    ///
    /// # Errors
    /// Never: there is no device.
    pub fn step(&mut self, _: Blend, _: &[&[Affine3A; BONES]], _: bool) -> Result<(), String> {
        match self.0 {}
    }

    /// Waits for what was sent.
    ///
    /// # Errors
    /// Never: there is no device.
    pub fn finish(&mut self) -> Result<(), String> {
        match self.0 {}
    }

    /// Time of one dispatch by the device's own clock (ns).
    ///
    /// # Errors
    /// Never: there is no device.
    pub fn device_ns(&self, _: Blend, _: u32) -> Result<Option<f64>, String> {
        match self.0 {}
    }

    /// World positions (m) of a body.
    pub fn positions(&self, _: usize) -> &[Vec3] {
        match self.0 {}
    }

    /// Unit normals of a body.
    pub fn normals(&self, _: usize) -> &[Vec3] {
        match self.0 {}
    }
}
