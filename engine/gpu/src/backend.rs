//! Steps garments on the processor or on a graphics device, as asked for or whichever measures faster; the result is a
//! [`Cloth`] either way.
//!
//! A step is over when the call returns, on both: how benchmarks and validation need it. A frame loop that can take results a
//! frame late drives `cloth::Offload` itself. Whatever goes wrong with the device, the processor goes on from the last places, and
//! [`ClothStepper::fallback`] says why.
//!
//! A device meets capsules and planes. Contact of cloth with cloth, and with the skin, is the processor's: a scene that has
//! either is stepped by it, whatever was asked for, and no device is opened ([`Backends::for_scene`]).

use std::sync::atomic::{AtomicU8, Ordering};
use std::sync::{Arc, OnceLock};
use std::time::{Duration, Instant};

use toile_base::garment::Garment;
use toile_base::numeric::statistics::quantile;
use toile_engine::cloth::contact::garments::GarmentContact;
use toile_engine::cloth::{Cloth, Settings, Step};
use toile_engine::colliders::Colliders;
use toile_engine::workers::{SharePanicked, WorkerPool};

use crate::Adapter;
use crate::cloth_batch::ClothBatch;
use crate::graphics::{DeviceGarments, Graphics, StageTimes, StepWork};

toile_base::named! {
    /// Where garments are stepped.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
    pub enum Backend {
        /// The processor (the default).
        #[default]
        Cpu = "cpu",
        /// A graphics device, as long as there is one.
        Gpu = "gpu",
        /// Whichever is faster with these garments, measured when they are first stepped.
        Auto = "auto",
    }
}

/// The backend of a run: opened once, shared by all of its steppers.
#[derive(Debug, Clone)]
pub struct Backends {
    backend: Backend,
    graphics: Result<Graphics, String>,
    known: Arc<SharedFindings>,
}

/// Why the processor steps garments that keep out of each other or out of themselves.
const CLOTH_ON_CLOTH: &str = "no device keeps cloth out of cloth; switch layers and folds off (`--no-layers --no-folds`) to step \
                              without that on one";

/// Why the processor steps garments that lie on the skin.
const CLOTH_ON_SKIN: &str =
    "a device has the body as capsules and not as skin; switch skin off (`--no-skin`) to step on those";

/// Why the processor steps garments of fabrics that rub, or whose links have more than one slope.
const FRICTION: &str = "no device has friction, second slopes or buckling; take `hysteresis`, `stretch`, `shear_lock` and `buckling` out of the \
     fabric's file to step it on one";

/// The same where the surroundings have a skin that the settings ask for.
fn on_skin(colliders: &Colliders, settings: &Settings) -> Option<&'static str> {
    (colliders.skin().is_some() && settings.contact.skin > 0).then_some(CLOTH_ON_SKIN)
}

/// Classes of scenes that are measured apart: by the bits of their particles' number.
const CLASSES: usize = 32;

/// Results that the steppers of a run share.
#[derive(Debug, Default)]
struct SharedFindings {
    /// The first reason for which any of them went over to the processor.
    fallback: OnceLock<String>,
    /// What has stepped: 1 the processor, 2 the device.
    used: AtomicU8,
    /// What `auto` was decided by, of each class.
    measured: [OnceLock<BackendTimes>; CLASSES],
}

impl Backends {
    /// Steps everything on the processor.
    pub fn cpu() -> Self {
        Self { backend: Backend::Cpu, graphics: Err(String::new()), known: Arc::default() }
    }

    /// What was asked for: opens the fastest device unless that is the processor. At load, some tenths of a second.
    pub fn open(backend: Backend) -> Self {
        match backend {
            Backend::Cpu => Self::cpu(),
            _ => Self { graphics: Graphics::open(), backend, known: Arc::default() },
        }
    }

    /// What was asked for, for the garments of a scene: the processor, and no device is opened, where these settings ask for
    /// contact that a device does not have. At load.
    pub fn for_scene(
        backend: Backend,
        layers: Option<&GarmentContact>,
        colliders: &Colliders,
        settings: &Settings,
    ) -> Self {
        let apart = layers.is_some_and(|layers| layers.asked(settings)).then_some(CLOTH_ON_CLOTH);
        match apart.or(on_skin(colliders, settings)) {
            Some(reason) => Self { backend, graphics: Err(reason.to_owned()), known: Arc::default() },
            None => Self::open(backend),
        }
    }

    /// A stepper for some garments.
    pub fn stepper(&self) -> ClothStepper {
        let mut stepper = ClothStepper { known: Arc::clone(&self.known), ..ClothStepper::default() };
        match (self.backend, &self.graphics) {
            (Backend::Cpu, _) => {}
            (backend, Ok(graphics)) => {
                stepper.graphics = Some(graphics.clone());
                stepper.undecided = backend == Backend::Auto;
            }
            (_, Err(reason)) => stepper.fall_back(reason.clone()),
        }
        stepper
    }

    /// The device that was opened.
    pub fn adapter(&self) -> Option<&Adapter> {
        self.graphics.as_ref().ok().map(Graphics::adapter)
    }

    /// What its steppers have stepped with so far: `cpu`, `gpu`, `both`, or `nothing`.
    pub fn used(&self) -> &'static str {
        // Relaxed: it orders nothing else.
        ["nothing", "cpu", "gpu", "both"][usize::from(self.known.used.load(Ordering::Relaxed) & 3)]
    }

    /// Backend that was asked for.
    pub fn asked(&self) -> Backend {
        self.backend
    }

    /// Why the processor stepped although a device was asked for: the first reason, one sentence with the cure.
    pub fn fallback(&self) -> Option<&str> {
        let unopened = self.graphics.as_ref().err().filter(|_| self.backend != Backend::Cpu);
        self.known.fallback.get().or(unopened).map(String::as_str)
    }
}

impl From<Graphics> for Backends {
    /// A device that is open, and asked for.
    fn from(graphics: Graphics) -> Self {
        Self { backend: Backend::Gpu, graphics: Ok(graphics), known: Arc::default() }
    }
}

/// Time of one step on both backends (us), medians of some steps.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BackendTimes {
    /// The processor, with the worker pool that was given.
    pub cpu_us: f64,
    /// The graphics device, until its result was there.
    pub gpu_us: f64,
}

/// Steps garments on the processor or on a graphics device.
#[derive(Debug, Default)]
pub struct ClothStepper {
    graphics: Option<Graphics>,
    on_device: Option<DeviceGarments>,
    fallback: Option<String>,
    known: Arc<SharedFindings>,
    measured: Option<BackendTimes>,
    undecided: bool,
}

/// Longest that either side is measured for after the step that lays everything out and one more (s), and the most steps.
const MEASURING: (Duration, usize) = (Duration::from_millis(300), 25);

impl ClothStepper {
    /// Steps on the processor, with no device.
    pub fn cpu() -> Self {
        Self::default()
    }

    /// What steps: the device, or the processor.
    pub fn backend(&self) -> Backend {
        if self.graphics.is_some() { Backend::Gpu } else { Backend::Cpu }
    }

    /// The device that steps, if one does.
    pub fn adapter(&self) -> Option<&Adapter> {
        self.graphics.as_ref().map(Graphics::adapter)
    }

    /// Why the processor steps although a device was asked for: one sentence with the cure.
    pub fn fallback(&self) -> Option<&str> {
        self.fallback.as_deref()
    }

    /// Times by which [`Backend::Auto`] was decided.
    pub fn measured(&self) -> Option<BackendTimes> {
        self.measured
    }

    /// What the device spent on the stages of the last step with `Settings::timed`, where it has a clock for it.
    pub fn spent(&self) -> Option<StageTimes> {
        self.on_device.as_ref().and_then(DeviceGarments::spent)
    }

    /// What a plain step asks of the device that steps, once one has been made.
    pub fn work(&self) -> Option<StepWork> {
        self.on_device.as_ref().map(DeviceGarments::work)
    }

    /// One step of each garment. With a pool the processor shares the work: one garment's, or the garments themselves.
    ///
    /// # Errors
    /// [`SharePanicked`]: a worker of the pool has; only where garments are shared among them.
    pub fn step(&mut self, batch: &mut ClothBatch<'_, '_>, pool: Option<&mut WorkerPool>) -> Result<(), SharePanicked> {
        let mut pool = pool;
        if self.graphics.is_some()
            && let Some(reason) = batch.steps.first().and_then(|step| on_skin(step.colliders, step.settings))
        {
            self.fall_back(reason.to_owned());
        }
        if self.graphics.is_some()
            && batch.garments.iter().any(|g| !g.layout().friction.slots.is_empty() || g.layout().link_curves.acts())
        {
            self.fall_back(FRICTION.to_owned());
        }
        if std::mem::take(&mut self.undecided) {
            self.decide(batch, pool.as_deref_mut())?;
        }
        if let Some(graphics) = &self.graphics {
            match on_device(graphics, &mut self.on_device, batch) {
                Ok(()) => {
                    self.uses(2);
                    return Ok(());
                }
                Err(reason) => self.fall_back(reason),
            }
        }
        self.uses(1);
        on_processor(batch, pool)
    }

    /// One step of garments that keep out of each other or out of themselves, by the processor.
    ///
    /// # Errors
    /// [`SharePanicked`]: a worker of the pool has.
    pub fn step_apart(
        &mut self,
        layers: &mut GarmentContact,
        pool: &mut WorkerPool,
        (cloths, garments): (&mut [Cloth], &[Garment]),
        step: &Step<'_>,
    ) -> Result<(), SharePanicked> {
        if self.graphics.is_some() {
            self.fall_back(CLOTH_ON_CLOTH.to_owned());
        }
        self.uses(1);
        layers.step(pool, cloths, garments, step)
    }

    fn uses(&self, what: u8) {
        // Relaxed: it orders nothing else.
        self.known.used.fetch_or(what, Ordering::Relaxed);
    }

    /// Switches to the processor.
    fn fall_back(&mut self, reason: String) {
        // Only the first is kept.
        let _ = self.known.fallback.set(reason.clone());
        (self.graphics, self.on_device, self.fallback) = (None, None, Some(reason));
    }

    /// Steps copies of the garments on both for a while, where they stand, and keeps the faster; what another stepper of the run has
    /// measured with about as many particles counts for this one.
    fn decide(
        &mut self,
        batch: &mut ClothBatch<'_, '_>,
        mut pool: Option<&mut WorkerPool>,
    ) -> Result<(), SharePanicked> {
        let Some(graphics) = self.graphics.clone() else { return Ok(()) };
        let particles: usize = batch.cloths.iter().map(|c| c.positions.len()).sum();
        let known = Arc::clone(&self.known);
        let class = &known.measured[(particles.max(1).ilog2() as usize).min(CLASSES - 1)];
        if let Some(measured) = class.get() {
            self.settle(*measured);
            return Ok(());
        }
        let mut copies = batch.cloths.to_vec();
        let mut trial = ClothBatch { cloths: &mut copies, garments: batch.garments, steps: batch.steps };
        let mut laid = None;
        let gpu_us = median_us(|| on_device(&graphics, &mut laid, &mut trial));
        let mut copies = batch.cloths.to_vec();
        let mut trial = ClothBatch { cloths: &mut copies, garments: batch.garments, steps: batch.steps };
        let cpu_us = median_us(|| on_processor(&mut trial, pool.as_deref_mut()))?;
        match gpu_us {
            Err(reason) => self.fall_back(reason),
            Ok(gpu_us) => {
                // Of two that measure at once, the first counts for both.
                self.settle(*class.get_or_init(|| BackendTimes { cpu_us, gpu_us }));
            }
        }
        Ok(())
    }

    fn settle(&mut self, measured: BackendTimes) {
        self.measured = Some(measured);
        if measured.cpu_us <= measured.gpu_us {
            self.graphics = None;
        }
    }
}

/// Median time (us) of some steps; the first, which lays everything out, does not count.
fn median_us<E>(mut step: impl FnMut() -> Result<(), E>) -> Result<f64, E> {
    step()?;
    let (begun, mut times) = (Instant::now(), Vec::new());
    while times.is_empty() || (times.len() < MEASURING.1 && begun.elapsed() < MEASURING.0) {
        let start = Instant::now();
        step()?;
        times.push(start.elapsed().as_secs_f64() * 1e6);
    }
    // Never empty: the loop runs at least once.
    Ok(quantile(&mut times, 0.5).unwrap_or(0.0))
}

fn on_processor(batch: &mut ClothBatch<'_, '_>, pool: Option<&mut WorkerPool>) -> Result<(), SharePanicked> {
    let (garments, steps) = (batch.garments, batch.steps);
    let Some(first) = steps.first() else { return Ok(()) };
    let step = |k: usize| Step { settings: first.settings, ..steps[k] };
    match (&mut *batch.cloths, pool) {
        ([cloth], Some(pool)) => {
            cloth.step_with(pool, garments[0], &step(0));
            Ok(())
        }
        (cloths, Some(pool)) => pool.each(cloths, |k, cloth| cloth.step(garments[k], &step(k))),
        (cloths, None) => {
            cloths.iter_mut().zip(garments).enumerate().for_each(|(k, (cloth, garment))| cloth.step(garment, &step(k)));
            Ok(())
        }
    }
}

/// Uploads the garments the first time, and again where the settings need larger buffers.
fn on_device(
    graphics: &Graphics,
    on: &mut Option<DeviceGarments>,
    batch: &mut ClothBatch<'_, '_>,
) -> Result<(), String> {
    if on.as_ref().is_none_or(|on| !on.holds(batch)) {
        let laid = DeviceGarments::lay(graphics, batch)?;
        *on = Some(laid);
    }
    on.as_mut().map_or(Ok(()), |on| on.step(batch))
}

#[cfg(test)]
mod tests {
    use glam::{Affine3A, Vec3};
    use toile_bake::bake;

    use toile_bake::Shape;
    use toile_base::skeleton::BONES;

    use super::*;
    use toile_engine::cloth::ContactRates;

    #[test]
    fn without_a_device_the_processor_steps_and_says_why() {
        let none = |backend| Backends { backend, graphics: Err("no adapter".into()), known: Arc::default() };
        let means = none(Backend::Gpu);
        let stepper = means.stepper();
        assert_eq!((stepper.backend(), stepper.fallback()), (Backend::Cpu, Some("no adapter")));
        assert_eq!(means.fallback(), Some("no adapter"));
        let asked = none(Backend::Cpu);
        assert_eq!((asked.stepper().fallback(), asked.fallback()), (None, None), "no device was asked for");
    }
    /// A sheet that can meet itself, what keeps it out of itself, and what surrounds it.
    fn sheet() -> (Garment, GarmentContact, Colliders) {
        let place = |row: u32, column: u32| (Vec3::new(column as f32, 1.0, row as f32) * 0.02, row == 0);
        let fabric = toile_assets::fabric::built_in("cotton-lawn").expect("it is built in");
        let garment = bake("sheet", "one", &Shape::sheet(6, 6, place), &fabric).expect("a sheet is cloth");
        let layers = GarmentContact::new(std::slice::from_ref(&garment)).expect("it has faces");
        (garment, layers, Colliders::new(&[], &[], true).expect("a floor"))
    }

    #[test]
    fn cloth_on_cloth_is_the_processors_whatever_was_asked_for_and_says_so() {
        let (garment, mut layers, colliders) = sheet();
        let settings = Settings { workers: 1, ..Settings::default() };
        for backend in [Backend::Auto, Backend::Gpu] {
            let means = Backends::for_scene(backend, Some(&layers), &colliders, &settings);
            assert_eq!((means.fallback(), means.adapter()), (Some(CLOTH_ON_CLOTH), None));
            let mut cloths = [Cloth::new(&garment, &colliders)];
            let step = Step { palette: &[Affine3A::IDENTITY; BONES], colliders: &colliders, settings: &settings };
            let mut pool = WorkerPool::new(1).expect("the caller");
            let mut stepper = means.stepper();
            let garments = std::slice::from_ref(&garment);
            stepper.step_apart(&mut layers, &mut pool, (&mut cloths, garments), &step).expect("no worker panics");
            assert_eq!((means.used(), stepper.backend()), ("cpu", Backend::Cpu));
        }
        let cpu = Backends::for_scene(Backend::Cpu, Some(&layers), &colliders, &settings);
        assert_eq!(cpu.fallback(), None, "no device was asked for");
        let off = Settings { contact: ContactRates { folds: 0, layers: 0, ..settings.contact }, ..settings };
        let means = Backends::for_scene(Backend::Gpu, Some(&layers), &colliders, &off);
        assert_ne!(means.fallback(), Some(CLOTH_ON_CLOTH), "nothing asks for it");
    }
}
