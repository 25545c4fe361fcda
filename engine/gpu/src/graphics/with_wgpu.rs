//! A device by wgpu.

use std::sync::Arc;

use glam::Vec3A;
use toile_base::garment::Garment;
use toile_base::numeric::hash;
use toile_engine::cloth::step::guard::GuardEvents;
use toile_engine::cloth::{Cloth, Settings};
use toile_engine::colliders::Colliders;

use crate::Adapter;
use crate::cloth::Offload;
use crate::cloth::cloth_device::ClothDevice;
use crate::cloth_batch::ClothBatch;
use crate::device::{AdapterChoice, DeviceNeeds, GpuError};
use crate::device_work::{StageTimes, StepWork};

/// An open device with the cloth's kernels; clones are the same device.
#[derive(Debug, Clone)]
pub struct Graphics(Arc<ClothDevice>);

/// Garments on a device.
#[derive(Debug)]
pub struct DeviceGarments {
    offload: Offload,
    /// Events of each garment before it was uploaded here.
    before: Vec<GuardEvents>,
    /// What each garment was made of, and where it lay in memory then.
    made_of: Vec<(usize, u64)>,
    scratch: [Vec<Vec3A>; 2],
}

impl Graphics {
    /// Opens the fastest adapter.
    ///
    /// # Errors
    /// One sentence with the cure: none there, or one that does not open.
    pub fn open() -> Result<Self, String> {
        Self::choose(&AdapterChoice::Fastest)
    }

    /// Opens the chosen adapter.
    ///
    /// # Errors
    /// As [`Graphics::open`].
    pub fn choose(choice: &AdapterChoice) -> Result<Self, String> {
        ClothDevice::new(choice, DeviceNeeds::default()).map(|opened| Self(Arc::new(opened))).map_err(|e| e.to_string())
    }

    /// Name, backend and driver of the adapter.
    pub fn adapter(&self) -> &Adapter {
        self.0.device.adapter()
    }

    /// The device, and the kernels on it.
    pub fn opened(&self) -> &Arc<ClothDevice> {
        &self.0
    }
}

impl DeviceGarments {
    /// Lays garments out on a device, each where its cloth is.
    ///
    /// # Errors
    /// One sentence with the cure: a limit that is too small, or something that only the processor computes.
    pub fn lay(graphics: &Graphics, batch: &ClothBatch<'_, '_>) -> Result<Self, String> {
        let Some(first) = batch.steps.first() else { return Err("there is no garment to step; give one".to_owned()) };
        let colliders: Vec<&Colliders> = batch.steps.iter().map(|step| step.colliders).collect();
        let opened = bearing(graphics, batch, &colliders, first.settings)?;
        let mut offload =
            Offload::on(&opened, batch.garments, &colliders, first.settings).map_err(|e| e.to_string())?;
        for (k, cloth) in batch.cloths.iter().enumerate() {
            offload.go_on(k, cloth);
        }
        let most = batch.cloths.iter().map(|c| c.positions.len()).max().unwrap_or(0);
        // The colliders count for themselves.
        let before = batch.cloths.iter().map(|c| GuardEvents { held_colliders: 0, ..c.events }).collect();
        let made_of = batch.garments.iter().map(|g| (address(g), fingerprint(g))).collect();
        Ok(Self { offload, before, made_of, scratch: [(); 2].map(|()| Vec::with_capacity(most)) })
    }

    /// Whether these garments can be stepped as they are laid out: the settings may ask for more substeps.
    pub fn holds(&self, batch: &ClothBatch<'_, '_>) -> bool {
        // What lies where it lay is what it was: garments do not change while they are worn.
        let same =
            |(garment, (at, of)): (&&Garment, &(usize, u64))| address(garment) == *at || fingerprint(garment) == *of;
        batch.steps.first().is_some_and(|step| self.offload.holds(batch.garments, step.settings))
            && batch.garments.iter().zip(&self.made_of).all(same)
    }

    /// One step: sends what has been disturbed, steps, waits for the result, and gives it to the cloths.
    ///
    /// # Errors
    /// One sentence with the cure: the device is lost, or something that only the processor computes. The cloths then are as
    /// before.
    pub fn step(&mut self, batch: &mut ClothBatch<'_, '_>) -> Result<(), String> {
        for (k, cloth) in batch.cloths.iter().enumerate() {
            self.send(k, cloth);
        }
        let taken = self.offload.tally().taken;
        self.offload.step(batch.garments, batch.steps).map_err(|e| e.to_string())?;
        self.offload.finish().map_err(|e| e.to_string())?;
        if self.offload.tally().taken == taken {
            return Err(GpuError::Lost("a step did not come back".to_owned()).to_string());
        }
        for (k, cloth) in batch.cloths.iter_mut().enumerate() {
            let events = self.before[k] + self.offload.events(k);
            cloth.prepare(batch.garments[k], batch.steps[0].settings);
            cloth.take_over(self.offload.positions(k), self.offload.velocities(k), events);
            let (pins, root) = self.offload.course(k);
            cloth.follow(pins, root);
        }
        Ok(())
    }

    /// What a plain step asks of the device.
    pub fn work(&self) -> StepWork {
        self.offload.work()
    }

    /// What the device spent on the last step that was timed.
    pub fn spent(&self) -> Option<StageTimes> {
        self.offload.spent()
    }

    /// A cloth's particles, where they are not as the device left them.
    fn send(&mut self, k: usize, cloth: &Cloth) {
        let vectors = |[x, y, z]: [&[f32]; 3], to: &mut Vec<Vec3A>| {
            to.clear();
            to.extend(x.iter().zip(y).zip(z).map(|((x, y), z)| Vec3A::new(*x, *y, *z)));
        };
        let [x, v] = &mut self.scratch;
        vectors(cloth.state().positions(), x);
        vectors(cloth.state().velocities(), v);
        let same = |a: &[Vec3A], b: &[Vec3A]| a.iter().zip(b).all(|(a, b)| a == b);
        if !(same(x, self.offload.positions(k)) && same(v, self.offload.velocities(k))) {
            self.offload.put(k, x, v, &cloth.positions);
        }
    }
}

fn address(garment: &Garment) -> usize {
    std::ptr::from_ref(garment).addr()
}

/// FNV-1a over what a garment is laid out from: it distinguishes two with as many particles.
fn fingerprint(garment: &Garment) -> u64 {
    let layout = garment.layout();
    let numbers = [&garment.inverse_mass[..], &layout.weft.rest, &layout.weft.compliance, &layout.shear.compliance];
    let fibers = [&layout.fibers.rest[..], &layout.fibers.compliance, &layout.crossing.rest];
    let start = garment.start.iter().flat_map(|p| p.to_array());
    hash::of_numbers(numbers.into_iter().chain(fibers).flatten().copied().chain(start))
}

/// The device, or the same adapter opened once more for a scene that asks for more than the least limits.
fn bearing(
    graphics: &Graphics,
    batch: &ClothBatch<'_, '_>,
    colliders: &[&Colliders],
    settings: &Settings,
) -> Result<Arc<ClothDevice>, String> {
    let needs = Offload::needs(batch.garments, colliders, settings);
    if graphics.0.device.takes(needs).is_ok() {
        return Ok(Arc::clone(&graphics.0));
    }
    let same = AdapterChoice::Named(graphics.adapter().name.clone());
    ClothDevice::new(&same, needs).map(Arc::new).map_err(|e| e.to_string())
}
