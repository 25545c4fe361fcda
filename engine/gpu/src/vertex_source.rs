//! Vertices that the device has computed, for a renderer on the same device.

use wgpu::{Buffer, BufferSlice};

use crate::device::Device;

/// Bytes of a vertex in each buffer: three numbers and one to spare, as the kernels have them.
pub const STRIDE: u64 = 16;

/// World positions (m) and unit normals of a surface on a device. What is submitted after a step sees all of it, what is
/// submitted before sees nothing of it: a picture never shows half a step. Clones share the buffers.
#[derive(Debug, Clone)]
pub struct VertexSource {
    device: Device,
    /// Positions and normals of the whole scene.
    buffers: [Buffer; 2],
    first: u32,
    vertices: u32,
}

impl VertexSource {
    /// So many vertices from the first on, of positions and normals that lie one behind the other; none where the buffers
    /// have not so many.
    pub(crate) fn new(device: &Device, buffers: [&Buffer; 2], first: u32, vertices: u32) -> Option<Self> {
        let end = STRIDE * (u64::from(first) + u64::from(vertices));
        let there = vertices > 0 && buffers.iter().all(|b| end <= b.size());
        there.then(|| Self { device: device.clone(), buffers: buffers.map(Buffer::clone), first, vertices })
    }

    /// The device that it lies on.
    pub fn device(&self) -> &Device {
        &self.device
    }

    /// Number of its vertices.
    pub fn vertices(&self) -> usize {
        self.vertices as usize
    }

    /// The buffers of positions and normals that it is a part of.
    pub fn buffers(&self) -> [&Buffer; 2] {
        self.buffers.each_ref()
    }

    /// The first of its vertices in them.
    pub fn first(&self) -> u32 {
        self.first
    }

    /// Its own part of the positions and of the normals, [`STRIDE`] bytes a vertex; a normal is zero where there is no area.
    pub fn parts(&self) -> [BufferSlice<'_>; 2] {
        let [from, to] = [u64::from(self.first), u64::from(self.first) + u64::from(self.vertices)].map(|k| STRIDE * k);
        self.buffers.each_ref().map(|buffer| buffer.slice(from..to))
    }
}
