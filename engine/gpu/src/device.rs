//! A graphics device for compute and for drawing: opened once, with the smallest limits that suffice.

use std::fmt;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, OnceLock};
use std::time::Duration;

use wgpu::{Backends, DeviceType, Instance, Limits, MemoryHints, Surface};

use crate::adapters::{self, describe};
use crate::wait::block_on;

/// Why a GPU cannot compute the cloth, or draw it. A caller that gets one for the cloth goes on with the CPU.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum GpuError {
    /// No driver answers, or none of the asked kind, or none that can show on the given surface.
    #[error(
        "no graphics adapter was found {0}; install a Vulkan driver, for example the package mesa-vulkan-drivers, which \
         works on the processor, or do without a GPU"
    )]
    NoAdapter(&'static str),
    /// There are adapters, but none of the asked name.
    #[error("no graphics adapter's name contains `{asked}`; there are {known}: choose one of these")]
    Unknown {
        /// The name asked for.
        asked: String,
        /// The names there are.
        known: String,
    },
    /// The adapter's limits are below what the scene needs.
    #[error(
        "{adapter} allows {limit} of {has}, and this scene needs {needs}; use fewer or coarser garments, or the CPU"
    )]
    TooSmall {
        /// Name of the adapter.
        adapter: String,
        /// The limit, as WebGPU names it.
        limit: &'static str,
        /// What the adapter has.
        has: u64,
        /// What the scene needs.
        needs: u64,
    },
    /// The adapter does not open.
    #[error(
        "the graphics adapter {adapter} cannot be opened ({reason}); update its driver, choose another, or do without a GPU"
    )]
    Refused {
        /// Name of the adapter.
        adapter: String,
        /// Error of the driver.
        reason: String,
    },
    /// Something that only the CPU computes.
    #[error("garment {garment} cannot be stepped on the GPU: {what}; use the CPU for it")]
    Unsupported {
        /// Name of the garment.
        garment: String,
        /// What it has that no kernel does.
        what: &'static str,
    },
    /// Unplugged, reset by its driver, or out of memory.
    #[error("the graphics device was lost ({0}); the cloth goes on from its last places on the CPU")]
    Lost(String),
}

/// Choice of the adapter.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub enum AdapterChoice {
    /// The fastest kind: a card of its own, a processor's graphics, a virtual one, a driver on the processor.
    #[default]
    Fastest,
    /// The first whose name contains this, whatever its case.
    Named(String),
    /// One that works on the processor: the same numbers and pictures on every machine.
    Software,
}

/// Longest that a graphics card may take for a step (s): a hundred times what a frame has. The caller goes on with
/// the CPU after that.
const PATIENCE: Duration = Duration::from_secs(1);

/// What a scene asks of a device.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct DeviceNeeds {
    /// Its largest buffer (bytes).
    pub largest: u64,
    /// Workgroups of its largest dispatch.
    pub workgroups: u32,
}

/// Storage buffers that a kernel sees at most: three of the scene, five of its own.
pub const STORAGE_BUFFERS: u32 = 8;

impl DeviceNeeds {
    /// As limits: those that every driver has, but for these three.
    fn limits(self) -> Limits {
        let least = Limits::downlevel_defaults();
        Limits {
            max_storage_buffers_per_shader_stage: STORAGE_BUFFERS,
            max_storage_buffer_binding_size: least.max_storage_buffer_binding_size.max(self.largest),
            max_buffer_size: least.max_buffer_size.max(self.largest),
            max_compute_workgroups_per_dimension: least.max_compute_workgroups_per_dimension.max(self.workgroups),
            ..least
        }
    }

    /// The same for a device that draws as well, pictures as large as the adapter has them. Where no scene is known yet,
    /// the cloth's storage buffers are asked for only if the adapter has so many: pictures alone need none.
    fn limits_to_draw(self, has: &Limits) -> Limits {
        let limits = self.limits().using_resolution(has.clone());
        let most = if self == Self::default() { has.max_storage_buffers_per_shader_stage } else { u32::MAX };
        Limits { max_storage_buffers_per_shader_stage: STORAGE_BUFFERS.min(most), ..limits }
    }
}

/// An open device, and the queue that it is fed by. Clones are the same device: whatever one of them meets, all know.
#[derive(Debug, Clone)]
pub struct Device {
    /// Where surfaces are made.
    pub instance: Instance,
    /// Adapter that it was opened on.
    pub opened_on: wgpu::Adapter,
    /// What makes buffers, textures and pipelines.
    pub device: wgpu::Device,
    /// The queue that takes commands.
    pub queue: wgpu::Queue,
    adapter: crate::Adapter,
    lost: Arc<AtomicBool>,
    fault: Arc<OnceLock<String>>,
}

impl Device {
    /// The instance without a window system of its own: it sees every driver of this machine.
    pub fn instance() -> Instance {
        adapters::instance()
    }

    /// Opens the chosen adapter, to compute.
    ///
    /// # Errors
    /// [`GpuError`]: none there, none of that name, limits below the needs, or one that does not open.
    pub fn open(choice: &AdapterChoice, needs: DeviceNeeds) -> Result<Self, GpuError> {
        let instance = Self::instance();
        let adapter = choose(&instance, None, choice)?;
        Self::on(instance, adapter, needs.limits(), MemoryHints::Performance)
    }

    /// Opens the chosen adapter, for pictures off the screen.
    ///
    /// # Errors
    /// As [`Device::open_to_draw`].
    pub fn offscreen(choice: &AdapterChoice) -> Result<Self, GpuError> {
        Self::open_to_draw(Self::instance(), None, choice, DeviceNeeds::default())
    }

    /// Opens the chosen adapter of an instance, one that can show on `surface` where one is given, to draw and to compute
    /// a scene that needs so much. With the least needs any driver will do that draws; most scenes fit it too.
    ///
    /// # Errors
    /// As [`Device::open`].
    pub fn open_to_draw(
        instance: Instance,
        surface: Option<&Surface<'_>>,
        choice: &AdapterChoice,
        needs: DeviceNeeds,
    ) -> Result<Self, GpuError> {
        let adapter = choose(&instance, surface, choice)?;
        let limits = needs.limits_to_draw(&adapter.limits());
        Self::on(instance, adapter, limits, MemoryHints::MemoryUsage)
    }

    fn on(
        instance: Instance,
        opened_on: wgpu::Adapter,
        limits: Limits,
        memory_hints: MemoryHints,
    ) -> Result<Self, GpuError> {
        let adapter = describe(&opened_on.get_info());
        enough(&limits, &opened_on.limits(), &adapter.name)?;
        let request = opened_on.request_device(&wgpu::DeviceDescriptor {
            label: Some("toile"),
            // A clock for the stages, where there is one; nothing depends on it.
            required_features: opened_on.features() & wgpu::Features::TIMESTAMP_QUERY,
            required_limits: limits,
            memory_hints,
            ..Default::default()
        });
        let refused = |e: wgpu::RequestDeviceError| GpuError::Refused {
            adapter: adapter.name.clone(),
            reason: one_line(&e.to_string()),
        };
        let (device, queue) = block_on(request).map_err(refused)?;
        let (lost, fault) = (Arc::new(AtomicBool::new(false)), Arc::new(OnceLock::new()));
        watch(&device, &lost, &fault);
        Ok(Self { instance, opened_on, device, queue, adapter, lost, fault })
    }

    /// Name, backend and driver of the adapter.
    pub fn adapter(&self) -> &crate::Adapter {
        &self.adapter
    }

    /// Whether both are the same device, opened once: only then can one draw what the other has computed.
    pub fn is(&self, other: &Self) -> bool {
        // Numbers that wgpu gives its devices repeat from instance to instance.
        Arc::ptr_eq(&self.lost, &other.lost)
    }

    /// True where the processor does its work.
    pub fn is_software(&self) -> bool {
        self.opened_on.get_info().device_type == DeviceType::Cpu
    }

    /// True once the device is gone: unplugged, reset by its driver, given up, or out of memory. Everything made by it has
    /// to be made anew by another.
    pub fn lost(&self) -> bool {
        // Relaxed: the flag guards no other data; the next drawing or step asks for it.
        self.lost.load(Ordering::Relaxed)
    }

    /// The first thing that went wrong, if any: what was asked for then was not drawn or computed.
    pub fn fault(&self) -> Option<&str> {
        self.fault.get().map(String::as_str)
    }

    /// Whether what a scene asks for is within the limits that the device was opened with.
    ///
    /// # Errors
    /// [`GpuError::TooSmall`].
    pub fn takes(&self, needs: DeviceNeeds) -> Result<(), GpuError> {
        enough(&needs.limits(), &self.device.limits(), &self.adapter.name)
    }

    /// Whether the device is still there and has taken all that was asked of it.
    ///
    /// # Errors
    /// [`GpuError::Lost`], with what the driver said first.
    pub fn sound(&self) -> Result<(), GpuError> {
        if !self.lost() && self.fault().is_none() {
            return Ok(());
        }
        Err(GpuError::Lost(self.fault.get().cloned().unwrap_or_else(|| "no reason was given".into())))
    }

    /// Gives the device up, as a driver does that is reset: for trying what happens then.
    pub fn lose(&self) {
        self.device.destroy();
        // Relaxed: see above.
        self.lost.store(true, Ordering::Relaxed);
    }

    /// How long an answer may take: none for a driver that computes on the processor, which is slow but does not hang.
    pub fn patience(&self) -> Option<Duration> {
        (!self.is_software()).then_some(PATIENCE)
    }

    /// Gives the device up where it has not answered for longer than it may.
    ///
    /// # Errors
    /// [`GpuError::Lost`].
    pub fn answers(&self, waiting: Option<Duration>) -> Result<(), GpuError> {
        if waiting.zip(self.patience()).is_some_and(|(waiting, patience)| waiting > patience) {
            let _ = self.fault.set("it has not answered for a second".to_owned());
            // Relaxed: see above.
            self.lost.store(true, Ordering::Relaxed);
        }
        self.sound()
    }

    /// Waits until everything that was submitted is done, for as long as an answer may take. Never in the frame.
    ///
    /// # Errors
    /// [`GpuError::Lost`].
    pub fn done(&self) -> Result<(), GpuError> {
        let wait = wgpu::PollType::Wait { submission_index: None, timeout: self.patience() };
        let late = matches!(self.device.poll(wait), Err(wgpu::PollError::Timeout));
        self.answers(late.then_some(Duration::MAX))
    }

    /// Waits until everything that was submitted is done, so that time is measured whole. Never in the frame.
    pub fn finish(&self) {
        // A device that is lost has nothing left to wait for.
        let _ = self.device.poll(wgpu::PollType::wait_indefinitely());
    }
}

impl fmt::Display for Device {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let crate::Adapter { name, backend, kind, .. } = &self.adapter;
        write!(f, "{name} ({backend}, {kind})")
    }
}

/// Keeps the first thing that goes wrong; without this, a driver that refuses something would end the program.
fn watch(device: &wgpu::Device, lost: &Arc<AtomicBool>, fault: &Arc<OnceLock<String>>) {
    let (flag, first) = (Arc::clone(lost), Arc::clone(fault));
    device.set_device_lost_callback(move |_, reason| {
        let _ = first.set(one_line(&reason));
        // Relaxed: the flag guards no other data.
        flag.store(true, Ordering::Relaxed);
    });
    let (flag, first) = (Arc::clone(lost), Arc::clone(fault));
    device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
        if matches!(error, wgpu::Error::OutOfMemory { .. }) {
            // Relaxed: see above.
            flag.store(true, Ordering::Relaxed);
        }
        // Only the first error names the cause; later ones follow from it.
        let _ = first.set(one_line(&error.to_string()));
    }));
}

fn one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// Kinds of adapters, the fastest first.
fn rank(kind: DeviceType) -> u8 {
    match kind {
        DeviceType::DiscreteGpu => 0,
        DeviceType::IntegratedGpu => 1,
        DeviceType::VirtualGpu => 2,
        DeviceType::Other => 3,
        DeviceType::Cpu => 4,
    }
}

fn choose(
    instance: &Instance,
    surface: Option<&Surface<'_>>,
    choice: &AdapterChoice,
) -> Result<wgpu::Adapter, GpuError> {
    let mut found = block_on(instance.enumerate_adapters(Backends::PRIMARY));
    found.sort_by_key(|a| rank(a.get_info().device_type));
    found.retain(|a| surface.is_none_or(|s| a.is_surface_supported(s)));
    let known: Vec<String> = found.iter().map(|a| a.get_info().name).collect();
    let matches = |a: &wgpu::Adapter| match choice {
        AdapterChoice::Fastest => true,
        AdapterChoice::Named(name) => a.get_info().name.to_lowercase().contains(&name.to_lowercase()),
        AdapterChoice::Software => a.get_info().device_type == DeviceType::Cpu,
    };
    found.into_iter().find(matches).ok_or_else(|| match choice {
        AdapterChoice::Named(asked) if !known.is_empty() => {
            GpuError::Unknown { asked: asked.clone(), known: known.join(", ") }
        }
        AdapterChoice::Software => GpuError::NoAdapter("that works on the processor"),
        _ if surface.is_some() => GpuError::NoAdapter("that can show on this display"),
        _ => GpuError::NoAdapter("on this machine"),
    })
}

fn enough(needs: &Limits, has: &Limits, adapter: &str) -> Result<(), GpuError> {
    let mut short = None;
    needs.check_limits_with_fail_fn(has, false, |limit, needs, has| {
        short.get_or_insert((limit, needs, has));
    });
    match short {
        None => Ok(()),
        Some((limit, needs, has)) => Err(GpuError::TooSmall { adapter: adapter.into(), limit, has, needs }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_every_driver_has_is_all_that_a_small_scene_asks_for() {
        let limits = DeviceNeeds { largest: 1 << 20, workgroups: 9 }.limits();
        let least = Limits { max_storage_buffers_per_shader_stage: STORAGE_BUFFERS, ..Limits::downlevel_defaults() };
        assert_eq!(limits, least);
        assert_eq!(enough(&limits, &Limits::default(), "any"), Ok(()));
    }

    #[test]
    fn a_device_that_draws_asks_for_the_adapters_pictures_and_for_no_more() {
        let few = Limits { max_texture_dimension_2d: 9000, ..Limits::downlevel_defaults() };
        let (least, scene) = (DeviceNeeds::default(), DeviceNeeds { largest: 1, workgroups: 1 });
        assert_eq!(least.limits_to_draw(&few), few.clone(), "what draws needs no storage buffers");
        assert_eq!(scene.limits_to_draw(&few).max_storage_buffers_per_shader_stage, STORAGE_BUFFERS);
        let many = Limits { max_texture_dimension_2d: 9000, ..Limits::default() };
        assert_eq!(least.limits_to_draw(&many), scene.limits_to_draw(&many), "the cloth's where they are there");
    }

    #[test]
    fn hardware_comes_before_software() {
        let kinds = [
            DeviceType::DiscreteGpu,
            DeviceType::IntegratedGpu,
            DeviceType::VirtualGpu,
            DeviceType::Other,
            DeviceType::Cpu,
        ];
        assert!(kinds.map(rank).is_sorted_by(|a, b| a < b));
    }

    #[test]
    fn every_refusal_names_a_cure() {
        let (some, garment) = (String::from("x"), String::from("shirt"));
        let errors = [
            GpuError::NoAdapter("on this machine"),
            GpuError::Unknown { asked: some.clone(), known: some.clone() },
            GpuError::TooSmall { adapter: some.clone(), limit: "max_buffer_size", has: 1, needs: 2 },
            GpuError::Refused { adapter: some.clone(), reason: some.clone() },
            GpuError::Unsupported { garment, what: "there is wind" },
            GpuError::Lost(some),
        ];
        for (error, cure) in errors.iter().zip(["install", "choose", "fewer", "update", "use the CPU", "on the CPU"]) {
            assert!(error.to_string().contains(cure), "{error}");
        }
    }

    #[test]
    fn a_limit_that_is_too_small_is_named() {
        let limits = DeviceNeeds { largest: 1 << 40, workgroups: 9 }.limits();
        let error = enough(&limits, &Limits::default(), "a small card").expect_err("a terabyte is too much");
        assert!(matches!(&error, GpuError::TooSmall { needs, .. } if *needs == 1 << 40), "{error}");
    }
}
