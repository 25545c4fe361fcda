//! Pictures without a window: drawn on a texture and read back.

use std::sync::mpsc;

use wgpu::{Buffer, BufferUsages, Texture, TextureFormat, TextureUsages};

use super::Gpu;
use super::renderer::{Backdrop, Renderer, Viewport};
use super::textures;
use crate::image::{Image, Size};
use crate::scene::OrbitCamera;

/// Rows of a buffer that a texture is copied into begin at multiples of this (bytes).
const ROW: u32 = wgpu::COPY_BYTES_PER_ROW_ALIGNMENT;

/// Why there is no picture.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum OffscreenError {
    /// No side, or one longer than the adapter draws.
    #[error("a picture of {size} cannot be drawn by this adapter; choose sides of 1 to {most} pixels")]
    Size {
        /// The requested size.
        size: Size,
        /// The longest side that the adapter draws (pixels).
        most: u32,
    },
    /// The device is gone.
    #[error("the graphics device was lost while a picture was drawn ({0}); start again or choose another adapter")]
    Lost(String),
    /// The driver refused something.
    #[error("the graphics driver refused to draw ({0}); update it or choose another adapter")]
    Refused(String),
}

/// A texture to draw on, and the buffer that it is read through.
#[derive(Debug)]
pub struct Offscreen {
    size: Size,
    target: Texture,
    buffer: Buffer,
}

impl Offscreen {
    /// The format of its pictures; a renderer for it is made with this.
    pub const FORMAT: TextureFormat = TextureFormat::Rgba8Unorm;

    /// Room for pictures of one size.
    ///
    /// # Errors
    /// [`OffscreenError::Size`].
    pub fn new(gpu: &Gpu, size: Size) -> Result<Self, OffscreenError> {
        let most = gpu.device.limits().max_texture_dimension_2d;
        if size.width == 0 || size.height == 0 || size.width > most || size.height > most {
            return Err(OffscreenError::Size { size, most });
        }
        let usage = TextureUsages::RENDER_ATTACHMENT | TextureUsages::COPY_SRC;
        let target = textures::plain(&gpu.device, size, Self::FORMAT, 1, usage);
        let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("readback"),
            size: u64::from(row_bytes(size)) * u64::from(size.height),
            usage: BufferUsages::COPY_DST | BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        Ok(Self { size, target, buffer })
    }

    /// Width and height (pixels).
    pub fn size(&self) -> Size {
        self.size
    }

    /// The texture, to draw on with other commands as well.
    pub fn target(&self) -> &Texture {
        &self.target
    }

    /// One view over the whole picture.
    ///
    /// # Errors
    /// [`OffscreenError::Lost`] or [`OffscreenError::Refused`].
    pub fn shoot(
        &self,
        gpu: &Gpu,
        renderer: &mut Renderer,
        camera: &OrbitCamera,
        backdrop: Backdrop,
    ) -> Result<Image, OffscreenError> {
        self.draw(gpu, renderer, Viewport::whole(self.size), camera, backdrop);
        self.read(gpu)
    }

    /// Draws one view into a part of the picture and leaves the rest as it is.
    pub fn draw(&self, gpu: &Gpu, renderer: &mut Renderer, part: Viewport, camera: &OrbitCamera, backdrop: Backdrop) {
        let view = self.target.create_view(&wgpu::TextureViewDescriptor::default());
        let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        renderer.draw(&mut encoder, &view, part, camera, backdrop);
        gpu.queue.submit([encoder.finish()]);
    }

    /// Reads back what was drawn.
    ///
    /// # Errors
    /// [`OffscreenError::Lost`] or [`OffscreenError::Refused`].
    pub fn read(&self, gpu: &Gpu) -> Result<Image, OffscreenError> {
        let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let layout =
            wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(row_bytes(self.size)), rows_per_image: None };
        encoder.copy_texture_to_buffer(
            self.target.as_image_copy(),
            wgpu::TexelCopyBufferInfo { buffer: &self.buffer, layout },
            self.target.size(),
        );
        gpu.queue.submit([encoder.finish()]);
        let (sender, result_receiver) = mpsc::channel();
        self.buffer.map_async(wgpu::MapMode::Read, .., move |result| {
            // The receiver is gone if the wait below has failed.
            let _ = sender.send(result);
        });
        let lost = |e: &dyn std::fmt::Display| OffscreenError::Lost(e.to_string().replace('\n', " "));
        gpu.device.poll(wgpu::PollType::wait_indefinitely()).map_err(|e| lost(&e))?;
        result_receiver.recv().map_err(|e| lost(&e))?.map_err(|e| lost(&e))?;
        if let Some(fault) = gpu.fault() {
            return Err(OffscreenError::Refused(fault.to_owned()));
        }
        let mapped = self.buffer.get_mapped_range(..).map_err(|e| lost(&e))?;
        let mut image = Image::filled(self.size, [0; 3]);
        for (row, line) in image.rows_mut().zip(mapped.chunks_exact(row_bytes(self.size) as usize)) {
            for (to, from) in row.chunks_exact_mut(3).zip(line.chunks_exact(4)) {
                to.copy_from_slice(&from[..3]);
            }
        }
        drop(mapped);
        self.buffer.unmap();
        Ok(image)
    }
}

/// Bytes from one row to the next.
fn row_bytes(size: Size) -> u32 {
    (4 * size.width).next_multiple_of(ROW)
}
