//! A smaller render target: where the processor draws, the body is drawn on a smaller picture and scaled up; words stay as sharp as the display.

use egui::TextureId;
use toile_view::image::Size;
use wgpu::{
    Device, Extent3d, Texture, TextureDescriptor, TextureDimension, TextureFormat, TextureUsages, TextureView,
    TextureViewDescriptor,
};

use super::overlay::Overlay;

/// Most pixels of a picture that the processor draws while physics runs beside it.
const MOST_PIXELS: f32 = 360_000.0;

/// A texture smaller than the display that pictures are rendered to.
pub struct RenderTarget {
    size: Size,
    view: TextureView,
    id: TextureId,
}

/// The size that is drawn for a display of this one.
pub fn drawn(display: Size) -> Size {
    let pixels = display.width as f32 * display.height as f32;
    let share = (MOST_PIXELS / pixels.max(1.0)).sqrt().min(1.0);
    let side = |n: u32| ((n as f32 * share).round() as u32).max(1);
    Size::new(side(display.width), side(display.height))
}

impl RenderTarget {
    /// One that suits a display, in place of one that may suit it already.
    pub fn fit(
        before: Option<Self>,
        display: Size,
        device: &Device,
        format: TextureFormat,
        overlay: &mut Overlay,
    ) -> Self {
        let size = drawn(display);
        let registered = before.as_ref().map(|target| target.id);
        if let Some(target) = before.filter(|target| target.size == size) {
            return target;
        }
        let view = texture(device, size, format).create_view(&TextureViewDescriptor::default());
        let id = overlay.register(device, &view, registered);
        Self { size, view, id }
    }

    /// What is drawn on: the view and its size.
    pub fn attachment(&self) -> (&TextureView, Size) {
        (&self.view, self.size)
    }

    /// Its texture, as the overlay knows it.
    pub fn id(&self) -> TextureId {
        self.id
    }
}

fn texture(device: &Device, size: Size, format: TextureFormat) -> Texture {
    device.create_texture(&TextureDescriptor {
        label: Some("body"),
        size: Extent3d { width: size.width, height: size.height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: TextureDimension::D2,
        format,
        usage: TextureUsages::RENDER_ATTACHMENT | TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_the_processor_draws_is_bounded_and_keeps_its_shape() {
        for (w, h) in [(540, 960), (1080, 1920), (3840, 2160), (200, 300), (8192, 1)] {
            let size = drawn(Size::new(w, h));
            assert!((size.width * size.height) as f32 <= MOST_PIXELS * 1.02 && size.width > 0 && size.height > 0);
            let shape = |w: u32, h: u32| w as f32 / h as f32;
            assert!(h == 1 || (shape(size.width, size.height) / shape(w, h) - 1.0).abs() < 0.01);
        }
        assert_eq!(drawn(Size::new(200, 300)), Size::new(200, 300));
    }
}
