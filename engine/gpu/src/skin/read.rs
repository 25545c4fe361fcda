//! Results that come back from the device.

use glam::Vec3;

use super::{Skinning, encoder};
use crate::device::{Device, GpuError};

impl Skinning {
    /// World positions (m) of a body at the newest step that has come back, in the order of its mesh `[vertices]`.
    ///
    /// # Panics
    /// Where there is no such body.
    pub fn positions(&self, body: usize) -> &[Vec3] {
        &self.positions[self.span(body)]
    }

    /// Unit normals of a body, as of the same step `[vertices]`; zero where a blend has collapsed one.
    ///
    /// # Panics
    /// Where there is no such body.
    pub fn normals(&self, body: usize) -> &[Vec3] {
        &self.normals[self.span(body)]
    }

    /// Takes in the newest step that has come back, if any; waits for nothing.
    ///
    /// # Errors
    /// [`GpuError::Lost`].
    pub fn take(&mut self, device: &Device) -> Result<(), GpuError> {
        device.sound()?;
        // What a driver has to say about it comes by way of the device's own callbacks.
        let _ = device.device.poll(wgpu::PollType::Poll);
        let (positions, normals) = (&mut self.positions, &mut self.normals);
        let half = self.buffers.positions.size() as usize;
        self.ring.take(|bytes| {
            let (first, second) = bytes.split_at(half.min(bytes.len()));
            for (to, from) in [(positions, first), (normals, second)] {
                let from: &[[f32; 4]] = bytemuck::cast_slice(from);
                to.iter_mut().zip(from).for_each(|(to, n)| *to = Vec3::new(n[0], n[1], n[2]));
            }
        });
        device.answers(self.ring.waiting())
    }

    /// Waits for everything that was sent, and takes in the newest step that was to be sent back, also where the ring had no
    /// place for it. Never in the frame.
    ///
    /// # Errors
    /// [`GpuError::Lost`].
    pub fn finish(&mut self, device: &Device) -> Result<(), GpuError> {
        self.arrive(device)?;
        if self.ring.behind {
            // All places are free now.
            let encoder = encoder(device);
            self.send(device, encoder, true);
            self.arrive(device)?;
        }
        Ok(())
    }

    /// Waits for what is on its way back, and takes it in.
    fn arrive(&mut self, device: &Device) -> Result<(), GpuError> {
        device.done()?;
        // Another thread that polled the device may be about to say that it has come back.
        while self.ring.waiting().is_some() {
            device.answers(self.ring.waiting())?;
            std::thread::yield_now();
        }
        self.take(device)
    }
}
