//! The garments' vertices on the device, for a renderer there.

use glam::Vec3A;

use super::Offload;
use super::read::vectors;
use crate::device::GpuError;
use crate::vertex_source::VertexSource;

impl Offload {
    /// Where a garment's places and normals lie on the device at the end of the newest step that was sent; none where it was
    /// made by [`Offload::new`] or [`Offload::on`], without normals. Ask once: a step writes where the one before has written, until garments are uploaded again.
    pub fn source(&self, garment: usize) -> Option<VertexSource> {
        if self.flat.faces.starts.is_empty() {
            return None;
        }
        let span = self.flat.spans[self.own[garment].place];
        VertexSource::new(&self.opened.device, [&self.buffers.good, &self.buffers.normals], span.first, span.len)
    }

    /// Reads a garment's unit normals `[particles]`, and waits for them; none for garments that are not drawn. Never in the frame.
    ///
    /// # Errors
    /// [`GpuError::Lost`].
    pub fn normals(&self, garment: usize) -> Result<Vec<Vec3A>, GpuError> {
        if self.flat.faces.starts.is_empty() {
            return Ok(Vec::new());
        }
        let numbers = self.numbers(&self.buffers.normals)?;
        Ok(vectors(&numbers, self.flat.spans[self.own[garment].place]))
    }
}
