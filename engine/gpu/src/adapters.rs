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

fn look() -> Vec<Adapter> {
    let instance = Instance::new(InstanceDescriptor::new_without_display_handle());
    let found = block_on(instance.enumerate_adapters(Backends::PRIMARY));
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
