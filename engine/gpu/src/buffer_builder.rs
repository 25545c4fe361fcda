//! Creates buffers at load and counts their bytes; bind group layout entries.

use bytemuck::Pod;
use wgpu::{
    BindGroupLayoutEntry, BindingType, Buffer, BufferBindingType, BufferDescriptor, BufferUsages, ShaderStages,
};

use crate::device::Device;

/// Bytes between two of the uniforms that a dispatch picks from: what every driver aligns to.
pub const ALIGNED: u64 = 256;

/// Creates buffers and counts their bytes.
pub struct BufferBuilder<'a> {
    device: &'a Device,
    bytes: u64,
}

impl<'a> BufferBuilder<'a> {
    /// A builder for one device.
    pub fn new(device: &'a Device) -> Self {
        Self { device, bytes: 0 }
    }

    /// Bytes of all buffers created.
    pub fn bytes(&self) -> u64 {
        self.bytes
    }

    /// A storage buffer with these numbers; 64 bytes of zeros where there are none, because no buffer may be empty.
    pub fn with<T: Pod>(&mut self, label: &str, numbers: &[T], more: BufferUsages) -> Buffer {
        const NOTHING: [u8; 64] = [0; 64];
        let bytes: &[u8] = bytemuck::cast_slice(numbers);
        let contents = if bytes.is_empty() { &NOTHING[..] } else { bytes };
        self.filled(label, contents, BufferUsages::STORAGE | more)
    }

    /// A storage buffer of `count` zeroed items of `size` bytes.
    pub fn zeros(&mut self, label: &str, count: usize, size: usize) -> Buffer {
        let len = (count.max(1) * size) as u64;
        self.bytes += len;
        let usage = BufferUsages::STORAGE | BufferUsages::COPY_SRC | BufferUsages::COPY_DST;
        self.device.device.create_buffer(&BufferDescriptor {
            label: Some(label),
            size: len,
            usage,
            mapped_at_creation: false,
        })
    }

    /// Uniforms of which a dispatch picks one.
    pub fn uniforms(&mut self, label: &str, each: impl Iterator<Item = [u32; 4]>) -> Buffer {
        let mut bytes = Vec::new();
        for uniform in each {
            bytes.extend_from_slice(bytemuck::cast_slice(&uniform));
            bytes.resize(bytes.len().next_multiple_of(ALIGNED as usize), 0);
        }
        bytes.resize(bytes.len().max(ALIGNED as usize), 0);
        self.filled(label, &bytes, BufferUsages::UNIFORM)
    }

    /// A buffer with these bytes. Written by way of the queue: to map it at once, as wgpu's own helper does, panics on a device
    /// that is lost or out of memory, where this is an error that [`Device::sound`] reports.
    fn filled(&mut self, label: &str, contents: &[u8], usage: BufferUsages) -> Buffer {
        let size = contents.len() as u64;
        self.bytes += size;
        let usage = usage | BufferUsages::COPY_DST;
        let descriptor = BufferDescriptor { label: Some(label), size, usage, mapped_at_creation: false };
        let buffer = self.device.device.create_buffer(&descriptor);
        self.device.queue.write_buffer(&buffer, 0, contents);
        buffer
    }
}

/// An entry of a layout; with `dynamic`, a uniform of which a dispatch picks one.
pub fn bound(binding: u32, ty: BufferBindingType, dynamic: bool) -> BindGroupLayoutEntry {
    let size = if dynamic { std::num::NonZeroU64::new(16) } else { None };
    let ty = BindingType::Buffer { ty, has_dynamic_offset: dynamic, min_binding_size: size };
    BindGroupLayoutEntry { binding, visibility: ShaderStages::COMPUTE, ty, count: None }
}
