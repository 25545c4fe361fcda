//! Time of the skinning kernels by the device's own clock (timestamp queries), where it has one.

use toile_engine::skin::Blend;
use wgpu::{
    BufferDescriptor, BufferUsages, CommandEncoderDescriptor, ComputePassDescriptor, ComputePassTimestampWrites,
    Features, QuerySetDescriptor, QueryType,
};

use super::Skinning;
use crate::cloth::readback::ReadbackRing;
use crate::device::{Device, GpuError};

impl Skinning {
    /// Time of one dispatch over all bodies by the device's own clock (ns), with the palettes of the last step: the mean of
    /// `dispatches` that follow each other; none where the adapter has no such clock. Makes buffers and waits: never in the
    /// frame.
    ///
    /// # Errors
    /// [`GpuError::Lost`].
    pub fn device_ns(&self, device: &Device, blend: Blend, dispatches: u32) -> Result<Option<f64>, GpuError> {
        device.sound()?;
        if !device.device.features().contains(Features::TIMESTAMP_QUERY) || dispatches == 0 {
            return Ok(None);
        }
        let clock = QuerySetDescriptor { label: Some("skin"), ty: QueryType::Timestamp, count: 2 };
        let clock = device.device.create_query_set(&clock);
        let resolved = device.device.create_buffer(&BufferDescriptor {
            label: Some("skin's clock"),
            size: size_of::<[u64; 2]>() as u64,
            usage: BufferUsages::QUERY_RESOLVE | BufferUsages::COPY_SRC,
            mapped_at_creation: false,
        });
        let mut back = ReadbackRing::new(&device.device, resolved.size());
        let mut encoder = device.device.create_command_encoder(&CommandEncoderDescriptor { label: Some("skin") });
        let mut pass = encoder.begin_compute_pass(&ComputePassDescriptor {
            label: Some("skin"),
            timestamp_writes: Some(ComputePassTimestampWrites {
                query_set: &clock,
                beginning_of_pass_write_index: Some(0),
                end_of_pass_write_index: Some(1),
            }),
        });
        (0..dispatches).for_each(|_| self.dispatch(&mut pass, blend, self.bodies()));
        drop(pass);
        encoder.resolve_query_set(&clock, 0..2, &resolved, 0);
        let place = back.send(&mut encoder, &[resolved.slice(..)]);
        device.queue.submit([encoder.finish()]);
        if let Some(place) = place {
            back.ask(place);
        }
        device.done()?;
        let mut ticks = None;
        back.take(|bytes| ticks = bytemuck::cast_slice::<_, [u64; 2]>(bytes).first().copied());
        let period = f64::from(device.queue.get_timestamp_period());
        Ok(ticks.map(|[begun, ended]| ended.saturating_sub(begun) as f64 * period / f64::from(dispatches)))
    }
}
