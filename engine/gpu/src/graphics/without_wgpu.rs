//! No device: this build has no GPU support. Values of these types cannot be made.

use std::convert::Infallible;

use crate::Adapter;
use crate::cloth_batch::ClothBatch;
use crate::device_work::{StageTimes, StepWork};

/// An open device.
#[derive(Debug, Clone)]
pub struct Graphics(Infallible);

/// Garments on a device.
#[derive(Debug)]
pub struct DeviceGarments(Infallible);

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
