//! The presenter: shows pictures on a display surface and recovers it after errors. `display_state` decides, this file calls wgpu.

use std::time::Duration;

use wgpu::{
    CompositeAlphaMode, CurrentSurfaceTexture, PresentMode, Surface, SurfaceConfiguration, SurfaceTexture,
    TextureFormat, TextureUsages, TextureView,
};

use super::Gpu;
use super::display_state::{DisplayState, SurfaceAction, SurfaceEvent};
use crate::image::Size;

/// Time between two attempts to present on a hidden window.
pub const HIDDEN_RETRY: Duration = Duration::from_millis(200);

/// Pictures that may wait for the display: one is shown while the next is drawn.
const LATENCY: u32 = 2;

/// Set-ups tried within one picture before the next one's turn.
const TRIES: usize = 3;

/// Outcome of presenting a picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum PresentOutcome {
    /// It was drawn and handed to the display.
    Yes,
    /// Not this time; try at the next picture's time.
    Skipped,
    /// The window is hidden: try again after [`HIDDEN_RETRY`].
    Resting,
    /// The surface is gone: call [`Presenter::replace`] with a new one on the same window.
    NewSurface,
    /// The device is lost: create [`Gpu`], surface, presenter and renderer again.
    NewDevice,
}

/// How pictures are paced to the display.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum PresentPacing {
    /// With its refresh, without tearing: what every driver has.
    #[default]
    Display,
    /// The newest at each refresh, the others dropped; as [`PresentPacing::Display`] where the driver has it not.
    Newest,
    /// At once, torn or not, for measurements; as [`PresentPacing::Newest`] where the driver has it not.
    AtOnce,
}

/// A display surface and its state.
#[derive(Debug)]
pub struct Presenter<'window> {
    surface: Surface<'window>,
    config: SurfaceConfiguration,
    state: DisplayState,
}

impl<'window> Presenter<'window> {
    /// Sets a surface up for pictures of this size (pixels). `None` where the adapter cannot show on it.
    pub fn new(gpu: &Gpu, surface: Surface<'window>, size: Size, pace: PresentPacing) -> Option<Self> {
        let can = surface.get_capabilities(&gpu.opened_on);
        let config = SurfaceConfiguration {
            usage: TextureUsages::RENDER_ATTACHMENT,
            format: format(&can.formats)?,
            color_space: wgpu::SurfaceColorSpace::Auto,
            width: size.width,
            height: size.height,
            present_mode: mode(&can.present_modes, pace),
            desired_maximum_frame_latency: LATENCY,
            alpha_mode: CompositeAlphaMode::Auto,
            view_formats: Vec::new(),
        };
        Some(Self { surface, config, state: DisplayState::new(size) })
    }

    /// The format that is drawn in: bytes are taken as they are, so that words painted over it look as elsewhere.
    pub fn format(&self) -> TextureFormat {
        self.config.format
    }

    /// Width and height (pixels).
    pub fn size(&self) -> Size {
        self.state.size()
    }

    /// The window has another size; 0 in either is a window that is minimised.
    pub fn resize(&mut self, size: Size) {
        self.state.resized(size);
        (self.config.width, self.config.height) = (size.width, size.height);
    }

    /// The window system says whether the window can be seen.
    pub fn set_hidden(&mut self, hidden: bool) {
        self.state.hidden(hidden);
    }

    /// Puts a new surface of the same window in the place of one that was lost.
    pub fn replace(&mut self, surface: Surface<'window>) {
        self.surface = surface;
        self.state.surface_made();
    }

    /// Draws one picture: `draw` records and submits what it wants to show on the view that it is given, and the picture
    /// is presented. It may wait for the display, so never call it on the physics thread.
    pub fn present(&mut self, gpu: &Gpu, draw: impl FnOnce(&TextureView, Size)) -> PresentOutcome {
        for _ in 0..TRIES {
            match self.state.before() {
                None => {}
                Some(SurfaceAction::Configure) => self.configure(gpu),
                Some(SurfaceAction::NewDevice) => return PresentOutcome::NewDevice,
                Some(_) => return PresentOutcome::Resting,
            }
            let (event, texture) = self.acquire(gpu);
            match (self.state.after(event), texture) {
                (SurfaceAction::Draw | SurfaceAction::DrawThenConfigure, Some(texture)) => {
                    let view = texture.texture.create_view(&wgpu::TextureViewDescriptor::default());
                    draw(&view, self.state.size());
                    gpu.queue.present(texture);
                    return PresentOutcome::Yes;
                }
                (SurfaceAction::Configure, _) => {}
                (SurfaceAction::Rest, _) => return PresentOutcome::Resting,
                (SurfaceAction::NewSurface, _) => return PresentOutcome::NewSurface,
                (SurfaceAction::NewDevice, _) => return PresentOutcome::NewDevice,
                (SurfaceAction::Skip | SurfaceAction::Draw | SurfaceAction::DrawThenConfigure, _) => {
                    return PresentOutcome::Skipped;
                }
            }
        }
        PresentOutcome::Skipped
    }

    fn configure(&mut self, gpu: &Gpu) {
        self.surface.configure(&gpu.device, &self.config);
        self.state.configured();
    }

    fn acquire(&self, gpu: &Gpu) -> (SurfaceEvent, Option<SurfaceTexture>) {
        if gpu.lost() {
            return (SurfaceEvent::DeviceLost, None);
        }
        match self.surface.get_current_texture() {
            CurrentSurfaceTexture::Success(texture) => (SurfaceEvent::Good, Some(texture)),
            CurrentSurfaceTexture::Suboptimal(texture) => (SurfaceEvent::Suboptimal, Some(texture)),
            CurrentSurfaceTexture::Timeout => (SurfaceEvent::Timeout, None),
            CurrentSurfaceTexture::Occluded => (SurfaceEvent::Occluded, None),
            CurrentSurfaceTexture::Outdated => (SurfaceEvent::Outdated, None),
            CurrentSurfaceTexture::Lost => (SurfaceEvent::Lost, None),
            CurrentSurfaceTexture::Validation => (SurfaceEvent::Refused, None),
        }
    }
}

/// The first format whose bytes are taken as they are, else the first at all.
fn format(known: &[TextureFormat]) -> Option<TextureFormat> {
    let plain = [TextureFormat::Bgra8Unorm, TextureFormat::Rgba8Unorm];
    known.iter().find(|f| plain.contains(f)).or(known.first()).copied()
}

/// The mode that comes nearest to the wanted pace.
fn mode(known: &[PresentMode], pace: PresentPacing) -> PresentMode {
    let wanted: &[PresentMode] = match pace {
        PresentPacing::Display => &[],
        PresentPacing::Newest => &[PresentMode::Mailbox],
        PresentPacing::AtOnce => &[PresentMode::Immediate, PresentMode::Mailbox],
    };
    wanted.iter().find(|m| known.contains(m)).copied().unwrap_or(PresentMode::Fifo)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_are_taken_as_they_are_where_the_display_can() {
        use TextureFormat::{Bgra8Unorm, Bgra8UnormSrgb, Rgb10a2Unorm, Rgba8Unorm};
        assert_eq!(format(&[Bgra8UnormSrgb, Bgra8Unorm]), Some(Bgra8Unorm));
        assert_eq!(format(&[Rgb10a2Unorm, Rgba8Unorm]), Some(Rgba8Unorm));
        assert_eq!(format(&[Bgra8UnormSrgb]), Some(Bgra8UnormSrgb));
        assert_eq!(format(&[]), None);
    }

    #[test]
    fn every_pace_falls_back_to_what_every_driver_has() {
        let all = [PresentMode::Fifo, PresentMode::Mailbox, PresentMode::Immediate];
        assert_eq!(mode(&all, PresentPacing::Display), PresentMode::Fifo);
        assert_eq!(mode(&all, PresentPacing::Newest), PresentMode::Mailbox);
        assert_eq!(mode(&all, PresentPacing::AtOnce), PresentMode::Immediate);
        assert_eq!(mode(&all[..2], PresentPacing::AtOnce), PresentMode::Mailbox);
        assert_eq!(mode(&all[..1], PresentPacing::AtOnce), PresentMode::Fifo);
    }
}
