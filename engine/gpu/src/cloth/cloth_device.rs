//! A device with the pipelines of all kernels, to be shared by any number of scenes: another garment needs buffers
//! only.

use wgpu::{
    BindGroup, BindGroupDescriptor, BindGroupEntry, BindGroupLayout, BindGroupLayoutDescriptor, BindingResource,
    Buffer, BufferBinding, BufferBindingType, BufferUsages, ComputePipeline,
};

use super::kernels::{Kernel, SHADERS};
use crate::buffer_builder::bound;
use crate::device::{AdapterChoice, Device, DeviceNeeds, GpuError};
use crate::shader::pipeline;

/// An open device and its pipelines.
#[derive(Debug)]
pub struct ClothDevice {
    /// The graphics device that is open.
    pub device: Device,
    pub(super) pipelines: Pipelines,
}

impl ClothDevice {
    /// Opens the chosen adapter, for scenes that need no more than that. At load: some tenths of a second, most of them for the
    /// pipelines.
    ///
    /// # Errors
    /// [`GpuError`]: none there, limits below the needs, or one that does not open.
    pub fn new(choice: &AdapterChoice, needs: DeviceNeeds) -> Result<Self, GpuError> {
        Self::on(Device::open(choice, needs)?)
    }

    /// On a device that is open already.
    ///
    /// # Errors
    /// [`GpuError::TooSmall`] where it was opened for pictures alone, on an adapter that has no room for more;
    /// [`GpuError::Lost`] where the driver refuses a kernel.
    pub fn on(device: Device) -> Result<Self, GpuError> {
        // Before anything is asked of it: a refusal would count as an error of the renderer there.
        device.takes(DeviceNeeds::default())?;
        let pipelines = Pipelines::new(&device.device);
        device.sound()?;
        Ok(Self { device, pipelines })
    }
}

/// The pipelines, and the layouts of what they are bound to.
#[derive(Debug)]
pub struct Pipelines {
    scene: BindGroupLayout,
    /// Pipeline and bind group layout of each kernel, by [`Kernel::number`].
    kernels: Vec<(ComputePipeline, BindGroupLayout)>,
}

impl Pipelines {
    fn new(device: &wgpu::Device) -> Self {
        let scene = scene_layout(device);
        let shaders: Vec<_> = SHADERS.iter().map(|s| s.module(device)).collect();
        let pipeline = |kernel: Kernel| {
            let (shader, entry) = kernel.entry();
            let (module, layout) = &shaders[shader];
            (pipeline(device, &[Some(&scene), Some(layout)], module, entry), layout.clone())
        };
        let kernels = Kernel::ALL.map(pipeline).into();
        Self { scene, kernels }
    }

    /// A kernel's pipeline.
    pub fn of(&self, kernel: Kernel) -> &ComputePipeline {
        &self.kernels[kernel.number()].0
    }

    /// What every kernel is bound to.
    pub fn scene(&self, device: &wgpu::Device, buffers: [&Buffer; 5]) -> BindGroup {
        let entries: Vec<_> = (0u32..)
            .zip(buffers)
            .map(|(binding, buffer)| {
                // Of the uniforms one of many.
                let size = if buffer.usage().contains(BufferUsages::UNIFORM) { Some(16) } else { None };
                let size = size.and_then(std::num::NonZeroU64::new);
                BindGroupEntry { binding, resource: BindingResource::Buffer(BufferBinding { buffer, offset: 0, size }) }
            })
            .collect();
        let descriptor = BindGroupDescriptor { label: Some("scene"), layout: &self.scene, entries: &entries };
        device.create_bind_group(&descriptor)
    }

    /// What a kernel alone is bound to.
    pub fn own(&self, device: &wgpu::Device, kernel: Kernel, buffers: &[&Buffer]) -> BindGroup {
        let (_, layout) = &self.kernels[kernel.number()];
        let entries: Vec<_> = (0u32..)
            .zip(buffers)
            .map(|(binding, buffer)| BindGroupEntry { binding, resource: buffer.as_entire_binding() })
            .collect();
        device.create_bind_group(&BindGroupDescriptor { label: Some(kernel.entry().1), layout, entries: &entries })
    }
}

fn scene_layout(device: &wgpu::Device) -> BindGroupLayout {
    let storage = |binding, read_only| bound(binding, BufferBindingType::Storage { read_only }, false);
    let uniform = |binding| bound(binding, BufferBindingType::Uniform, true);
    device.create_bind_group_layout(&BindGroupLayoutDescriptor {
        label: Some("scene"),
        entries: &[uniform(0), storage(1, true), storage(2, true), storage(3, false), uniform(4)],
    })
}
