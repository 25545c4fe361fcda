//! No device: this build has no GPU support. Values of these types cannot be made.

use std::convert::Infallible;

use toile_engine::cloth::program::STAGES;

use crate::Adapter;
use crate::batch::Batch;

/// An open device.
#[derive(Debug, Clone)]
pub struct Graphics(Infallible);

/// What a device spent.
#[derive(Debug, Clone, Copy)]
pub struct Spent {
    /// On each stage (ns).
    pub stages_ns: [f64; STAGES.len()],
    /// In all (ns).
    pub whole_ns: f64,
}

/// Garments on a device.
#[derive(Debug)]
pub struct Garments(Infallible);

impl Graphics {
    /// Opens no device.
    ///
    /// # Errors
    /// Always: one sentence with the cure.
    pub fn open() -> Result<Self, String> {
        Err("this build has no GPU support; build it with `--features gpu`".to_owned())
    }

    /// What the adapter says of itself.
    pub fn adapter(&self) -> &Adapter {
        match self.0 {}
    }
}

impl Garments {
    /// Lays garments out on a device.
    ///
    /// # Errors
    /// Never: there is no device.
    pub fn lay(graphics: &Graphics, _: &Batch<'_, '_>) -> Result<Self, String> {
        match graphics.0 {}
    }

    /// Whether these garments can be stepped as they are laid out.
    pub fn holds(&self, _: &Batch<'_, '_>) -> bool {
        match self.0 {}
    }

    /// One step.
    ///
    /// # Errors
    /// Never: there is no device.
    pub fn step(&mut self, _: &mut Batch<'_, '_>) -> Result<(), String> {
        match self.0 {}
    }

    /// What the device spent.
    pub fn spent(&self) -> Option<Spent> {
        match self.0 {}
    }
}
