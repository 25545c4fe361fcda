//! Wall: the display as it is drawn on: a device, the window's surface, the picture and what is painted over it. All of it
//! is made anew where the device is lost.

use std::sync::Arc;

use toile_engine::frame::Snapshot;
use wgpu::{
    CompositeAlphaMode, CurrentSurfaceTexture, Device, Instance, InstanceDescriptor, PresentMode, Queue, Surface,
    SurfaceConfiguration, TextureFormat, TextureUsages, TextureViewDescriptor,
};
use winit::window::Window;

use super::paint::Painted;
use super::varnish::Varnish;
use crate::guest::screen::Stage;

/// What became of a picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shown {
    /// It is on the display.
    Yes,
    /// The display takes none at the moment.
    No,
    /// The device is lost: everything has to be made anew.
    Lost,
}

/// A device with a surface.
pub struct Wall {
    device: Device,
    queue: Queue,
    surface: Surface<'static>,
    config: SurfaceConfiguration,
    varnish: Varnish,
    /// The adapter's name.
    pub name: String,
    /// Whether the processor draws.
    pub software: bool,
    configured: bool,
}

impl Wall {
    /// Opens the best adapter that can show on the window.
    ///
    /// # Errors
    /// Why there is none, with the cure.
    pub fn open(window: &Arc<Window>) -> Result<Self, String> {
        let instance = Instance::new(InstanceDescriptor::new_without_display_handle());
        let surface = instance.create_surface(window.clone()).map_err(|e| e.to_string())?;
        let options = wgpu::RequestAdapterOptions { compatible_surface: Some(&surface), ..Default::default() };
        let adapter = toile_gpu::wait::block_on(instance.request_adapter(&options)).map_err(|e| e.to_string())?;
        let limits = wgpu::Limits::downlevel_defaults().using_resolution(adapter.limits());
        let wanted = wgpu::DeviceDescriptor { required_limits: limits, ..Default::default() };
        let (device, queue) = toile_gpu::wait::block_on(adapter.request_device(&wanted)).map_err(|e| e.to_string())?;
        let info = adapter.get_info();
        let caps = surface.get_capabilities(&adapter);
        let plain = [TextureFormat::Bgra8Unorm, TextureFormat::Rgba8Unorm];
        let format = plain.into_iter().find(|f| caps.formats.contains(f)).or(caps.formats.first().copied());
        let format = format.ok_or("the display takes no format")?;
        let config = SurfaceConfiguration {
            usage: TextureUsages::RENDER_ATTACHMENT,
            format,
            width: 0,
            height: 0,
            present_mode: PresentMode::AutoVsync,
            desired_maximum_frame_latency: 2,
            alpha_mode: CompositeAlphaMode::Auto,
            view_formats: vec![],
            color_space: Default::default(),
        };
        let varnish = Varnish::new(&device, format);
        let software = info.device_type == wgpu::DeviceType::Cpu;
        Ok(Self { device, queue, surface, config, varnish, name: info.name, software, configured: false })
    }

    /// Takes in a painting's textures, which no picture may skip.
    pub fn take_in(&mut self, painted: &Painted) {
        self.varnish.take_in(&self.device, &self.queue, painted);
    }

    /// Draws and shows a picture.
    pub fn show(&mut self, size: [u32; 2], _stage: &Stage, _snapshot: Option<&Snapshot>, painted: &Painted) -> Shown {
        let [w, h] = size;
        if w == 0 || h == 0 {
            return Shown::No;
        }
        if !self.configured || [self.config.width, self.config.height] != size {
            (self.config.width, self.config.height, self.configured) = (w, h, true);
            self.surface.configure(&self.device, &self.config);
        }
        let texture = match self.surface.get_current_texture() {
            CurrentSurfaceTexture::Success(texture) => texture,
            CurrentSurfaceTexture::Suboptimal(texture) => {
                self.configured = false;
                texture
            }
            CurrentSurfaceTexture::Lost => return Shown::Lost,
            _ => {
                self.configured = false;
                return Shown::No;
            }
        };
        let view = texture.texture.create_view(&TextureViewDescriptor::default());
        let mut encoder = self.device.create_command_encoder(&Default::default());
        self.varnish.draw((&self.device, &self.queue), &mut encoder, (&view, size), painted, true);
        self.queue.submit([encoder.finish()]);
        self.queue.present(texture);
        self.varnish.let_go(painted);
        if self.software {
            _ = self.device.poll(wgpu::PollType::wait_indefinitely());
        }
        Shown::Yes
    }
}
