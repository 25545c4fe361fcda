//! Drawing surface of the window: a device, the window's surface, the body and the overlay. All of it is made anew where the device
//! is lost.

use std::sync::Arc;
use std::thread;

use toile_engine::frame_loop::thread_roles::{self, ThreadRole};
use toile_engine::world::Snapshot;
use toile_view::image::Size;
use toile_view::raster::{AdapterChoice, DeviceNeeds, Gpu, PresentOutcome, PresentPacing, Presenter};
use winit::window::Window;

use super::body_model::{BodyModel, ModelPair};
use super::body_renderer::{BodyRenderer, BodyScene};
use super::input::WindowState;
use super::overlay::Overlay;
use super::paint::PaintedScreen;
use super::render_target::{self, RenderTarget};

/// A device with a surface.
pub struct WindowSurface {
    gpu: Gpu,
    window: Arc<Window>,
    presenter: Presenter<'static>,
    overlay: Overlay,
    body: Option<BodyRenderer>,
    /// The smaller target that bodies are drawn on first, where the processor draws.
    low_res: Option<RenderTarget>,
    /// The adapter's name.
    pub name: String,
    /// Whether the processor draws.
    pub software: bool,
}

impl WindowSurface {
    /// Opens the best adapter that can show on the window. On the core of the render thread: a driver that draws on the processor
    /// has threads of its own, which inherit it.
    ///
    /// # Errors
    /// Why there is none, with the cure.
    pub fn open(window: &Arc<Window>) -> Result<Self, String> {
        let (mut gpu, mut surface) = open(window)?;
        if gpu.is_software() {
            // Its threads are made with the device, and inherit the place of the thread that makes it: once more, by one of
            // lower priority.
            drop((surface, gpu));
            let again = || {
                // Where the system does not let it, the share of `frame_pacing` is all that holds its threads back.
                thread_roles::apply(ThreadRole::Driver);
                open(window)
            };
            let again = thread::scope(|scope| scope.spawn(again).join());
            (gpu, surface) = again.map_err(|_| "the graphics driver panicked; install another one")??;
        }
        let size = window.inner_size();
        let presenter = Presenter::new(&gpu, surface, Size::new(size.width, size.height), PresentPacing::Display);
        let presenter = presenter.ok_or("the graphics adapter cannot show on this display; choose another driver")?;
        let overlay = Overlay::new(&gpu.device, presenter.format());
        let (name, software) = (gpu.to_string(), gpu.is_software());
        Ok(Self { gpu, window: window.clone(), presenter, overlay, body: None, low_res: None, name, software })
    }

    /// Compiles what the body is drawn with, where that was not done yet: a first picture need not wait for it.
    pub fn prepare(&mut self) {
        if self.body.is_none() {
            self.body = Some(BodyRenderer::new(&self.gpu, self.presenter.format()));
        }
    }

    /// The body that is drawn from now on.
    pub fn dress(&mut self, model: &BodyModel, pair: Option<&ModelPair>) {
        self.prepare();
        if let Some(body) = &mut self.body {
            body.dress(model, pair);
        }
    }

    /// Takes in what a snapshot shows, at a time of its clock (ns).
    pub fn take(&mut self, snapshot: &Snapshot, now_ns: u64) {
        if let Some(body) = &mut self.body {
            body.take(snapshot, now_ns);
        }
    }

    /// Uploads a painting's textures, which no picture may skip.
    pub fn update_textures(&mut self, painted: &PaintedScreen) {
        self.overlay.update_textures(&self.gpu.device, &self.gpu.queue, painted);
    }

    /// Size at which bodies are drawn for a window of this state (pixels).
    pub fn drawn_size(&self, window_state: WindowState) -> Size {
        let size = Size::new(window_state.size[0], window_state.size[1]);
        if self.software { render_target::drawn(size) } else { size }
    }

    /// Draws and shows a picture.
    pub fn show(
        &mut self,
        window_state: WindowState,
        scene: &BodyScene<'_>,
        mut painted: PaintedScreen,
    ) -> PresentOutcome {
        let size = Size::new(window_state.size[0], window_state.size[1]);
        if size != self.presenter.size() {
            self.presenter.resize(size);
        }
        self.presenter.set_hidden(window_state.hidden);
        if self.software && self.body.is_some() && size.width > 0 && size.height > 0 {
            let before = self.low_res.take();
            let (device, format) = (&self.gpu.device, self.presenter.format());
            let low_res = RenderTarget::fit(before, size, device, format, &mut self.overlay);
            painted = painted.over(low_res.id(), window_state.size);
            self.low_res = Some(low_res);
        }
        let shown = self.present(scene, &painted);
        self.overlay.free_textures(&painted);
        if self.software {
            // What it costs is known only when it is done.
            self.gpu.finish();
        }
        match shown {
            PresentOutcome::NewSurface => match self.gpu.instance.create_surface(self.window.clone()) {
                Ok(surface) => {
                    self.presenter.replace(surface);
                    PresentOutcome::Skipped
                }
                Err(_) => PresentOutcome::NewDevice,
            },
            shown => shown,
        }
    }

    fn present(&mut self, scene: &BodyScene<'_>, painted: &PaintedScreen) -> PresentOutcome {
        let Self { gpu, presenter, overlay, body, low_res, .. } = self;
        presenter.present(gpu, |view, size| {
            let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
            let mut bare = true;
            if let Some(body) = body {
                let (target, size) = low_res.as_ref().map_or((view, size), RenderTarget::attachment);
                body.draw(&mut encoder, target, size, scene);
                bare = low_res.is_some();
            }
            let device = (&gpu.device, &gpu.queue);
            overlay.draw(device, &mut encoder, (view, [size.width, size.height]), painted, bare);
            gpu.queue.submit([encoder.finish()]);
        })
    }
}

fn open(window: &Arc<Window>) -> Result<(Gpu, wgpu::Surface<'static>), String> {
    let instance = Gpu::instance();
    let surface = instance
        .create_surface(window.clone())
        .map_err(|e| format!("the window gives no surface to draw on ({e}); install a Vulkan driver"))?;
    let gpu = Gpu::open_to_draw(instance, Some(&surface), &AdapterChoice::Fastest, DeviceNeeds::default())
        .map_err(|e| e.to_string())?;
    Ok((gpu, surface))
}
