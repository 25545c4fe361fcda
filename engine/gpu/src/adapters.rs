//! The adapters as wgpu finds them.

use std::sync::OnceLock;

use wgpu::{Backends, DeviceType, Instance, InstanceDescriptor};

use crate::Adapter;
use crate::wait::block_on;

/// All adapters. The drivers are started once only: that takes long, and the hardware stays the same.
pub fn adapters() -> Vec<Adapter> {
    static FOUND: OnceLock<Vec<Adapter>> = OnceLock::new();
    FOUND.get_or_init(look).clone()
}

/// The instance of this process. There is one only: a driver that is unloaded and loaded again with each may not come back;
/// NVIDIA's did not after some thirty times. It asks the drivers of the first choice only, because others speak to a display.
pub fn instance() -> Instance {
    static INSTANCE: OnceLock<Instance> = OnceLock::new();
    let asked =
        || InstanceDescriptor { backends: Backends::PRIMARY, ..InstanceDescriptor::new_without_display_handle() };
    INSTANCE.get_or_init(|| Instance::new(asked())).clone()
}

fn look() -> Vec<Adapter> {
    let found = block_on(instance().enumerate_adapters(Backends::PRIMARY));
    let mut adapters: Vec<Adapter> = found.iter().map(|a| describe(&a.get_info())).collect();
    adapters.sort_by_key(|a| a.kind == "software");
    adapters
}

/// Name, kind, backend and driver of an adapter.
pub fn describe(info: &wgpu::AdapterInfo) -> Adapter {
    let kind = match info.device_type {
        DeviceType::DiscreteGpu => "discrete",
        DeviceType::IntegratedGpu => "integrated",
        DeviceType::VirtualGpu => "virtual",
        DeviceType::Cpu => "software",
        DeviceType::Other => "other",
    };
    let driver = format!("{} {}", info.driver, info.driver_info).trim().to_owned();
    Adapter { name: info.name.clone(), backend: info.backend.to_str().to_owned(), kind, driver }
}
