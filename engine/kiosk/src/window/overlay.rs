//! The overlay: the painted screen over the picture, on the GPU.

use egui::TextureId;
use egui_wgpu::{RendererOptions, ScreenDescriptor};
use wgpu::{
    Color, CommandEncoder, Device, FilterMode, LoadOp, Operations, Queue, RenderPassColorAttachment,
    RenderPassDescriptor, StoreOp, TextureFormat, TextureView,
};

use super::paint::PaintedScreen;

/// What is behind where no picture is: the panel's own grey, darker.
const GROUND: Color = Color { r: 0.11, g: 0.115, b: 0.125, a: 1.0 };

/// egui's triangles and textures on a device.
pub struct Overlay {
    renderer: egui_wgpu::Renderer,
}

impl Overlay {
    /// On a device whose pictures have this format.
    pub fn new(device: &Device, format: TextureFormat) -> Self {
        let options = RendererOptions { dithering: false, ..RendererOptions::default() };
        Self { renderer: egui_wgpu::Renderer::new(device, format, options) }
    }

    /// Makes a picture known that is painted like any other texture, smoothly scaled.
    pub fn register(&mut self, device: &Device, picture: &TextureView, before: Option<TextureId>) -> TextureId {
        if let Some(before) = before {
            self.renderer.free_texture(&before);
        }
        self.renderer.register_native_texture(device, picture, FilterMode::Linear)
    }

    /// Uploads the changes of textures: for each painting, in order, whether or not it is drawn.
    pub fn update_textures(&mut self, device: &Device, queue: &Queue, painted: &PaintedScreen) {
        for (id, deltas) in &painted.textures.set {
            deltas.iter().for_each(|delta| self.renderer.update_texture(device, queue, *id, delta));
        }
    }

    /// Draws over what a view of this size shows; over a plain ground where `bare`.
    pub fn draw(
        &mut self,
        (device, queue): (&Device, &Queue),
        encoder: &mut CommandEncoder,
        (view, size): (&TextureView, [u32; 2]),
        painted: &PaintedScreen,
        bare: bool,
    ) {
        let screen = ScreenDescriptor { size_in_pixels: size, pixels_per_point: 1.0 };
        // There are no callbacks, and so no buffers of theirs.
        self.renderer.update_buffers(device, queue, encoder, &painted.shapes, &screen);
        let load = if bare { LoadOp::Clear(GROUND) } else { LoadOp::Load };
        let target = RenderPassColorAttachment {
            view,
            depth_slice: None,
            resolve_target: None,
            ops: Operations { load, store: StoreOp::Store },
        };
        let pass = RenderPassDescriptor {
            label: Some("screen"),
            color_attachments: &[Some(target)],
            ..RenderPassDescriptor::default()
        };
        let mut pass = encoder.begin_render_pass(&pass).forget_lifetime();
        self.renderer.render(&mut pass, &painted.shapes, &screen);
    }

    /// Frees textures that nothing shows any more: after drawing.
    pub fn free_textures(&mut self, painted: &PaintedScreen) {
        painted.textures.free.iter().for_each(|id| self.renderer.free_texture(id));
    }
}
