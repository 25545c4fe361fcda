//! The GPU renderer, off the screen, for the pictures of a try-on.

use toile_base::garment::Garment;
use toile_cli::exit::AppError;
use toile_engine::lines::Line;
use toile_view::figure::Figure;
use toile_view::image::{Image, Size};
use toile_view::raster::{
    AdapterChoice, Backdrop, Gpu, GpuError, Model, ModelError, Offscreen, RenderQuality, Renderer,
};
use toile_view::scene::{Colours, OrbitCamera, PictureSurface};
use toile_view::trace::TraceQuality;

/// A device, and what draws stills and frames on it; each is made when it is first asked for.
pub struct GpuRenderer {
    gpu: Gpu,
    model: Model,
    still: Option<Renderer>,
    motion: Option<Renderer>,
    targets: Vec<Offscreen>,
}

/// A GPU that is not there or gives up is a device's fault, with its cure.
fn device(error: impl std::fmt::Display) -> AppError {
    AppError::Device(error.to_string())
}

impl GpuRenderer {
    /// Opens the fastest adapter.
    ///
    /// # Errors
    /// [`AppError::Device`].
    pub fn open() -> Result<Self, AppError> {
        let gpu = Gpu::offscreen(&AdapterChoice::Fastest)
            .map_err(|e: GpuError| device(format!("{e}; or leave out `--renderer gpu`")))?;
        Ok(Self { gpu, model: Model::default(), still: None, motion: None, targets: Vec::new() })
    }

    /// Prepares for a figure and what it wears.
    pub fn prepare(&mut self, figure: &Figure, garments: &[Garment]) {
        self.model = Model::of_outfit(figure, garments);
        (self.still, self.motion) = (None, None);
    }

    /// Name and device of the adapter.
    pub fn adapter(&self) -> String {
        self.gpu.to_string()
    }

    /// Updates the surfaces, in the model's order.
    pub fn update(
        &mut self,
        surfaces: &[PictureSurface<'_>],
        lines: &[Line],
        quality: TraceQuality,
    ) -> Result<(), AppError> {
        let renderer = self.renderer(quality)?;
        for (i, surface) in surfaces.iter().enumerate() {
            dress(renderer, i, surface).map_err(AppError::internal)?;
        }
        renderer.set_lines(lines);
        Ok(())
    }

    /// Draws one picture of the surfaces as they were last updated.
    pub fn picture(&mut self, camera: &OrbitCamera, size: Size, quality: TraceQuality) -> Result<Image, AppError> {
        let at = match self.targets.iter().position(|t| t.size() == size) {
            Some(at) => at,
            None => {
                self.targets.push(Offscreen::new(&self.gpu, size).map_err(device)?);
                self.targets.len() - 1
            }
        };
        self.renderer(quality)?;
        let renderer = if quality == TraceQuality::Still { &mut self.still } else { &mut self.motion };
        let Some(renderer) = renderer else { return Err(AppError::internal("a renderer is missing")) };
        self.targets[at].shoot(&self.gpu, renderer, camera, Backdrop::Curved).map_err(device)
    }

    fn renderer(&mut self, quality: TraceQuality) -> Result<&mut Renderer, AppError> {
        let frame = RenderQuality { samples: 4, ..RenderQuality::live(self.gpu.is_software()) };
        let (place, plan) = match quality {
            TraceQuality::Still => (&mut self.still, RenderQuality::STILL),
            TraceQuality::Motion => (&mut self.motion, frame),
        };
        let renderer = match place.take() {
            Some(renderer) => renderer,
            None => {
                let mut renderer = Renderer::new(&self.gpu, Offscreen::FORMAT, plan);
                renderer.set_model(&self.model).map_err(AppError::internal)?;
                renderer
            }
        };
        Ok(place.insert(renderer))
    }
}

/// Brings one surface up to date.
fn dress(renderer: &mut Renderer, at: usize, surface: &PictureSurface<'_>) -> Result<(), ModelError> {
    renderer.update(at, surface.positions, surface.normals)?;
    renderer.set_triangles(at, surface.triangles)?;
    match surface.colours {
        Colours::One(colour) => {
            renderer.set_fit(at, None)?;
            renderer.set_colour(at, colour)
        }
        Colours::Tightness(fit) => renderer.set_fit(at, Some(fit)),
        // No picture of a try-on is painted vertex by vertex.
        Colours::PerVertex(_) => Ok(()),
    }
}
