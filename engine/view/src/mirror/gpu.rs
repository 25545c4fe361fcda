//! The device that draws: hardware where there is any, else a driver that draws on the processor.

use std::fmt;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, OnceLock};

use toile_gpu::wait::block_on;
use wgpu::{Adapter, Backends, Device, DeviceType, Instance, InstanceDescriptor, Limits, Queue, Surface};

/// Why nothing can draw.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum GpuError {
    /// No driver answers, or none that can show on the given surface.
    #[error(
        "no graphics adapter was found {0}; install a Vulkan driver, for example the package mesa-vulkan-drivers, \
         which draws on the processor"
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
    /// The adapter does not open.
    #[error("the graphics adapter {name} cannot be opened ({reason}); update its driver or choose another")]
    Refused {
        /// The adapter.
        name: String,
        /// What the driver says.
        reason: String,
    },
}

/// Which adapter is wanted.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub enum Choice {
    /// The fastest kind: a card of its own, a processor's graphics, a virtual one, a driver on the processor.
    #[default]
    Fastest,
    /// The first whose name contains this, whatever its case.
    Named(String),
    /// One that draws on the processor: the same pictures on every machine.
    Software,
}

/// An open device, and the queue that it is fed by.
#[derive(Debug)]
pub struct Gpu {
    /// Where surfaces are made.
    pub instance: Instance,
    /// What the device was opened on.
    pub adapter: Adapter,
    /// What makes buffers, textures and pipelines.
    pub device: Device,
    /// What takes commands.
    pub queue: Queue,
    lost: Arc<AtomicBool>,
    fault: Arc<OnceLock<String>>,
}

impl Gpu {
    /// An instance without a window system of its own: it sees every driver of this machine.
    pub fn instance() -> Instance {
        Instance::new(InstanceDescriptor::new_without_display_handle())
    }

    /// Opens a device for pictures off the screen.
    ///
    /// # Errors
    /// As [`Gpu::open`].
    pub fn offscreen(choice: &Choice) -> Result<Self, GpuError> {
        Self::open(Self::instance(), None, choice)
    }

    /// Opens the chosen adapter of an instance, one that can show on `surface` where one is given. The limits that are
    /// asked for are the least that any driver has, but for the size of pictures, which is the adapter's.
    ///
    /// # Errors
    /// [`GpuError`]: no adapter, none of that name, or one that does not open.
    pub fn open(instance: Instance, surface: Option<&Surface<'_>>, choice: &Choice) -> Result<Self, GpuError> {
        let adapter = choose(&instance, surface, choice)?;
        let limits = Limits::downlevel_defaults().using_resolution(adapter.limits());
        let request = adapter.request_device(&wgpu::DeviceDescriptor {
            label: Some("mirror"),
            required_limits: limits,
            memory_hints: wgpu::MemoryHints::MemoryUsage,
            ..Default::default()
        });
        let refused = |e: wgpu::RequestDeviceError| GpuError::Refused {
            name: adapter.get_info().name,
            reason: e.to_string().replace('\n', " "),
        };
        let (device, queue) = block_on(request).map_err(refused)?;
        let lost = Arc::new(AtomicBool::new(false));
        let flag = Arc::clone(&lost);
        // Relaxed: the flag guards no other data; whoever draws asks for it at the next picture.
        device.set_device_lost_callback(move |_, _| flag.store(true, Ordering::Relaxed));
        let fault = Arc::new(OnceLock::new());
        let (flag, first) = (Arc::clone(&lost), Arc::clone(&fault));
        // Without this a driver that refuses something would end the program.
        device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
            if matches!(error, wgpu::Error::OutOfMemory { .. }) {
                flag.store(true, Ordering::Relaxed);
            }
            // Only the first tells the cause; what follows from it is not kept.
            let _ = first.set(error.to_string().split_whitespace().collect::<Vec<_>>().join(" "));
        }));
        Ok(Self { instance, adapter, device, queue, lost, fault })
    }

    /// What the adapter says of itself.
    pub fn describe(&self) -> toile_gpu::Adapter {
        toile_gpu::describe(&self.adapter.get_info())
    }

    /// True where the processor draws.
    pub fn is_software(&self) -> bool {
        self.adapter.get_info().device_type == DeviceType::Cpu
    }

    /// True once the device is gone: unplugged, reset by its driver, destroyed, or out of memory. Everything made by it has to be made
    /// anew by another.
    pub fn lost(&self) -> bool {
        // Relaxed: see above.
        self.lost.load(Ordering::Relaxed)
    }

    /// The first thing that the driver refused, if any: what was asked of it then was not drawn.
    pub fn fault(&self) -> Option<&str> {
        self.fault.get().map(String::as_str)
    }

    /// Waits until everything that was submitted is done, so that time is measured whole.
    pub fn finish(&self) {
        // A device that is lost has nothing left to wait for.
        let _ = self.device.poll(wgpu::PollType::wait_indefinitely());
    }
}

impl fmt::Display for Gpu {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let it = self.describe();
        write!(f, "{} ({}, {})", it.name, it.backend, it.kind)
    }
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

fn choose(instance: &Instance, surface: Option<&Surface<'_>>, choice: &Choice) -> Result<Adapter, GpuError> {
    let mut found = block_on(instance.enumerate_adapters(Backends::PRIMARY));
    found.sort_by_key(|a| rank(a.get_info().device_type));
    found.retain(|a| surface.is_none_or(|s| a.is_surface_supported(s)));
    let known: Vec<String> = found.iter().map(|a| a.get_info().name).collect();
    let matches = |a: &Adapter| match choice {
        Choice::Fastest => true,
        Choice::Named(name) => a.get_info().name.to_lowercase().contains(&name.to_lowercase()),
        Choice::Software => a.get_info().device_type == DeviceType::Cpu,
    };
    let chosen = found.into_iter().find(matches);
    chosen.ok_or_else(|| match choice {
        Choice::Named(asked) if !known.is_empty() => {
            GpuError::Unknown { asked: asked.clone(), known: known.join(", ") }
        }
        Choice::Software => GpuError::NoAdapter("that draws on the processor"),
        _ if surface.is_some() => GpuError::NoAdapter("that can show on this display"),
        _ => GpuError::NoAdapter("on this machine"),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

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
        let errors = [
            GpuError::NoAdapter("on this machine"),
            GpuError::Unknown { asked: "x".into(), known: "y".into() },
            GpuError::Refused { name: "x".into(), reason: "y".into() },
        ];
        for (error, cure) in errors.iter().zip(["install", "choose", "update"]) {
            assert!(error.to_string().contains(cure), "{error}");
        }
    }
}
