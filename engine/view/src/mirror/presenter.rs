//! The presenter: a display surface, kept going whatever happens to it. Decisions are `surface_state`'s, calls are here.

use std::time::Duration;

use wgpu::{
    CompositeAlphaMode, CurrentSurfaceTexture, PresentMode, Surface, SurfaceConfiguration, SurfaceTexture,
    TextureFormat, TextureUsages, TextureView,
};

use super::Gpu;
use super::surface_state::{Event, Step, SurfaceState};
use crate::image::Size;

/// How long to wait before the next look at a window that nobody sees.
pub const REST: Duration = Duration::from_millis(200);

/// Pictures that may wait for the display: one is shown while the next is drawn.
const LATENCY: u32 = 2;

/// Set-ups tried within one picture before the next one's turn.
const TRIES: usize = 3;

/// What became of the attempt to draw a picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Shown {
    /// It was drawn and handed to the display.
    Yes,
    /// Not this time; try at the next picture's time.
    Skipped,
    /// Nobody can see it: try again after [`REST`].
    Resting,
    /// The surface is gone: call [`Presenter::replace`] with a new one on the same window.
    NewSurface,
    /// The device is gone: make [`Gpu`], surface, presenter and renderer anew.
    NewDevice,
}

/// How pictures go to the display.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Pace {
    /// With its refresh, without tearing: what every driver has.
    #[default]
    Display,
    /// The newest at each refresh, the others dropped; as [`Pace::Display`] where the driver has it not.
    Newest,
    /// At once, torn or not, for measurements; as [`Pace::Newest`] where the driver has it not.
    AtOnce,
}

/// A surface and its state.
#[derive(Debug)]
pub struct Presenter<'window> {
    surface: Surface<'window>,
    config: SurfaceConfiguration,
    state: SurfaceState,
}

impl<'window> Presenter<'window> {
    /// Sets a surface up for pictures of this size (pixels). `None` where the adapter cannot show on it.
    pub fn new(gpu: &Gpu, surface: Surface<'window>, size: Size, pace: Pace) -> Option<Self> {
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
        Some(Self { surface, config, state: SurfaceState::new(size) })
    }

    /// The format that is drawn in: bytes are taken as they are, so that words painted over it look as elsewhere.
    pub fn format(&self) -> TextureFormat {
        self.config.format
    }

    /// The mode that pictures are presented in.
    pub fn mode(&self) -> PresentMode {
        self.config.present_mode
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
    pub fn present(&mut self, gpu: &Gpu, draw: impl FnOnce(&TextureView, Size)) -> Shown {
        for _ in 0..TRIES {
            match self.state.before() {
                None => {}
                Some(Step::Configure) => self.configure(gpu),
                Some(Step::NewDevice) => return Shown::NewDevice,
                Some(_) => return Shown::Resting,
            }
            let (event, texture) = self.acquire(gpu);
            match (self.state.after(event), texture) {
                (Step::Draw | Step::DrawThenConfigure, Some(texture)) => {
                    let view = texture.texture.create_view(&wgpu::TextureViewDescriptor::default());
                    draw(&view, self.state.size());
                    gpu.queue.present(texture);
                    return Shown::Yes;
                }
                (Step::Configure, _) => {}
                (Step::Rest, _) => return Shown::Resting,
                (Step::NewSurface, _) => return Shown::NewSurface,
                (Step::NewDevice, _) => return Shown::NewDevice,
                (Step::Skip | Step::Draw | Step::DrawThenConfigure, _) => return Shown::Skipped,
            }
        }
        Shown::Skipped
    }

    fn configure(&mut self, gpu: &Gpu) {
        self.surface.configure(&gpu.device, &self.config);
        self.state.configured();
    }

    fn acquire(&self, gpu: &Gpu) -> (Event, Option<SurfaceTexture>) {
        if gpu.lost() {
            return (Event::DeviceLost, None);
        }
        match self.surface.get_current_texture() {
            CurrentSurfaceTexture::Success(texture) => (Event::Good, Some(texture)),
            CurrentSurfaceTexture::Suboptimal(texture) => (Event::Suboptimal, Some(texture)),
            CurrentSurfaceTexture::Timeout => (Event::Timeout, None),
            CurrentSurfaceTexture::Occluded => (Event::Occluded, None),
            CurrentSurfaceTexture::Outdated => (Event::Outdated, None),
            CurrentSurfaceTexture::Lost => (Event::Lost, None),
            CurrentSurfaceTexture::Validation => (Event::Refused, None),
        }
    }
}

/// The first format whose bytes are taken as they are, else the first at all.
fn format(known: &[TextureFormat]) -> Option<TextureFormat> {
    let plain = [TextureFormat::Bgra8Unorm, TextureFormat::Rgba8Unorm];
    known.iter().find(|f| plain.contains(f)).or(known.first()).copied()
}

/// The mode that comes nearest to the wanted pace.
fn mode(known: &[PresentMode], pace: Pace) -> PresentMode {
    let wanted: &[PresentMode] = match pace {
        Pace::Display => &[],
        Pace::Newest => &[PresentMode::Mailbox],
        Pace::AtOnce => &[PresentMode::Immediate, PresentMode::Mailbox],
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
        assert_eq!(mode(&all, Pace::Display), PresentMode::Fifo);
        assert_eq!(mode(&all, Pace::Newest), PresentMode::Mailbox);
        assert_eq!(mode(&all, Pace::AtOnce), PresentMode::Immediate);
        assert_eq!(mode(&all[..2], Pace::AtOnce), PresentMode::Mailbox);
        assert_eq!(mode(&all[..1], Pace::AtOnce), PresentMode::Fifo);
    }
}
