//! The device that computes: opened once, with the smallest limits that the scene needs.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, OnceLock};

use wgpu::{Backends, DeviceType, Instance, InstanceDescriptor, Limits};

use crate::native::describe;
use crate::wait::block_on;

/// Why the cloth cannot be computed on a GPU. Whoever gets one goes on with the CPU.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum GpuError {
    /// No driver answers, or none of the asked kind.
    #[error(
        "no graphics adapter was found{0}; install a Vulkan driver, for example the package mesa-vulkan-drivers, which \
         computes on the processor, or use the CPU"
    )]
    NoAdapter(String),
    /// The adapter's limits are below what the scene needs.
    #[error(
        "{adapter} allows {limit} of {has}, and this scene needs {needs}; use fewer or coarser garments, or the CPU"
    )]
    TooSmall {
        /// The adapter.
        adapter: String,
        /// The limit, as WebGPU names it.
        limit: &'static str,
        /// What the adapter has.
        has: u64,
        /// What the scene needs.
        needs: u64,
    },
    /// The adapter does not open.
    #[error("the graphics adapter {adapter} cannot be opened ({reason}); update its driver or use the CPU")]
    Refused {
        /// The adapter.
        adapter: String,
        /// What the driver says.
        reason: String,
    },
    /// Something that only the CPU computes.
    #[error("garment {garment} cannot be stepped on the GPU: {what}; use the CPU for it")]
    Unsupported {
        /// The garment.
        garment: String,
        /// What it has that no kernel does.
        what: &'static str,
    },
    /// Unplugged, reset by its driver, or out of memory.
    #[error("the graphics device was lost ({0}); the cloth goes on from its last places on the CPU")]
    Lost(String),
}

/// Which adapter is wanted.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub enum Choice {
    /// The fastest kind: a card of its own, a processor's graphics, a virtual one, a driver on the processor.
    #[default]
    Fastest,
    /// One that computes on the processor: the same on every machine.
    Software,
}

/// What a scene asks of a device.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Needs {
    /// Its largest buffer (bytes).
    pub largest: u64,
    /// Workgroups of its largest dispatch.
    pub workgroups: u32,
}

/// Storage buffers that a kernel sees at most: three of the scene, five of its own.
pub const STORAGE_BUFFERS: u32 = 8;

impl Needs {
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
}

/// An open device, and the queue that it is fed by.
#[derive(Debug)]
pub struct Device {
    /// What makes buffers and pipelines.
    pub device: wgpu::Device,
    /// What takes commands.
    pub queue: wgpu::Queue,
    adapter: crate::Adapter,
    lost: Arc<AtomicBool>,
    fault: Arc<OnceLock<String>>,
}

impl Device {
    /// Opens the chosen adapter.
    ///
    /// # Errors
    /// [`GpuError`]: none there, limits below the needs, or one that does not open.
    pub fn open(choice: &Choice, needs: Needs) -> Result<Self, GpuError> {
        let instance = Instance::new(InstanceDescriptor::new_without_display_handle());
        let adapter = choose(&instance, choice)?;
        let described = describe(&adapter.get_info());
        let limits = needs.limits();
        enough(&limits, &adapter.limits(), &described.name)?;
        let request = adapter.request_device(&wgpu::DeviceDescriptor {
            label: Some("cloth"),
            // A clock for the stages, where there is one; nothing depends on it.
            required_features: adapter.features() & wgpu::Features::TIMESTAMP_QUERY,
            required_limits: limits,
            memory_hints: wgpu::MemoryHints::Performance,
            ..Default::default()
        });
        let refused = |e: wgpu::RequestDeviceError| GpuError::Refused {
            adapter: described.name.clone(),
            reason: one_line(&e.to_string()),
        };
        let (device, queue) = block_on(request).map_err(refused)?;
        let (lost, fault) = (Arc::new(AtomicBool::new(false)), Arc::new(OnceLock::new()));
        watch(&device, &lost, &fault);
        Ok(Self { device, queue, adapter: described, lost, fault })
    }

    /// What the adapter says of itself.
    pub fn adapter(&self) -> &crate::Adapter {
        &self.adapter
    }

    /// Whether what a scene asks for is within the limits that the device was opened with.
    ///
    /// # Errors
    /// [`GpuError::TooSmall`].
    pub fn takes(&self, needs: Needs) -> Result<(), GpuError> {
        enough(&needs.limits(), &self.device.limits(), &self.adapter.name)
    }

    /// Whether the device is still there and has taken all that was asked of it.
    ///
    /// # Errors
    /// [`GpuError::Lost`], with what the driver said first.
    pub fn sound(&self) -> Result<(), GpuError> {
        // Relaxed: the flag guards no other data.
        if !self.lost.load(Ordering::Relaxed) && self.fault.get().is_none() {
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

    /// Waits until everything that was submitted is done. Never in the frame.
    pub fn finish(&self) {
        // A device that is lost has nothing left to wait for.
        let _ = self.device.poll(wgpu::PollType::wait_indefinitely());
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
    let first = Arc::clone(fault);
    device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
        let _ = first.set(one_line(&error.to_string()));
    }));
}

fn one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

fn choose(instance: &Instance, choice: &Choice) -> Result<wgpu::Adapter, GpuError> {
    let rank = |kind: DeviceType| match kind {
        DeviceType::DiscreteGpu => 0,
        DeviceType::IntegratedGpu => 1,
        DeviceType::VirtualGpu => 2,
        DeviceType::Other => 3,
        DeviceType::Cpu => 4,
    };
    let mut found = block_on(instance.enumerate_adapters(Backends::PRIMARY));
    found.retain(|a| *choice == Choice::Fastest || a.get_info().device_type == DeviceType::Cpu);
    let kind = if *choice == Choice::Software { " that computes on the processor" } else { "" };
    found.into_iter().min_by_key(|a| rank(a.get_info().device_type)).ok_or_else(|| GpuError::NoAdapter(kind.into()))
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
        let limits = Needs { largest: 1 << 20, workgroups: 9 }.limits();
        let least = Limits { max_storage_buffers_per_shader_stage: STORAGE_BUFFERS, ..Limits::downlevel_defaults() };
        assert_eq!(limits, least);
        assert_eq!(enough(&limits, &Limits::default(), "any"), Ok(()));
    }

    #[test]
    fn a_limit_that_is_too_small_is_named() {
        let limits = Needs { largest: 1 << 40, workgroups: 9 }.limits();
        let error = enough(&limits, &Limits::default(), "a small card").expect_err("a terabyte is too much");
        assert!(matches!(&error, GpuError::TooSmall { needs, .. } if *needs == 1 << 40), "{error}");
    }
}
