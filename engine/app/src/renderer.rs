//! Renderer of a try-on's pictures: the processor by rays, or a GPU by triangles.

use toile_base::garment::Garment;
use toile_cli::exit::AppError;
use toile_engine::lines::Line;
use toile_view::figure::Figure;
use toile_view::image::{Image, Size};
use toile_view::scene::{Bounds, OrbitCamera, PictureScene, PictureSurface};
use toile_view::trace::{TraceQuality, TracedScene};

#[cfg(feature = "view")]
mod gpu;

toile_base::named! {
    /// Choice of the renderer on the command line.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
    pub enum RendererChoice {
        /// The ray tracer, on every core.
        #[default]
        Cpu = "cpu",
        /// Rasterised on a GPU, or by a driver that draws on the processor.
        Gpu = "gpu",
    }
}

/// Draws pictures of one shopper and what they wear.
pub enum PictureRenderer {
    /// Ray tracing, on the processor.
    RayTracer,
    /// Rasterised triangles, on a graphics device.
    #[cfg(feature = "view")]
    Gpu(Box<gpu::GpuRenderer>),
}

impl PictureRenderer {
    /// Opens the renderer, before any long work.
    ///
    /// # Errors
    /// [`AppError::Usage`] where a GPU is asked for that was not built in, [`AppError::Device`] where there is none.
    pub fn open(renderer: RendererChoice) -> Result<Self, AppError> {
        match renderer {
            RendererChoice::Cpu => Ok(Self::RayTracer),
            #[cfg(feature = "view")]
            RendererChoice::Gpu => Ok(Self::Gpu(Box::new(gpu::GpuRenderer::open()?))),
            #[cfg(not(feature = "view"))]
            RendererChoice::Gpu => Err(AppError::Usage(
                "this build cannot draw on a GPU; build it with `cargo build --release --features view`, or leave out \
                 `--renderer gpu`"
                    .to_owned(),
            )),
        }
    }

    /// Gets ready for a figure and what it wears.
    pub fn prepare(&mut self, figure: &Figure, garments: &[Garment]) {
        match self {
            // Rays need nothing but the surfaces of each picture.
            Self::RayTracer => {
                let (_, _) = (figure, garments);
            }
            #[cfg(feature = "view")]
            Self::Gpu(gpu) => gpu.prepare(figure, garments),
        }
    }

    /// Its name and device, for reports.
    pub fn describe(&self) -> String {
        match self {
            Self::RayTracer => RendererChoice::Cpu.name().to_owned(),
            #[cfg(feature = "view")]
            Self::Gpu(gpu) => format!("{}: {}", RendererChoice::Gpu.name(), gpu.adapter()),
        }
    }

    /// Draws surfaces, the body first and then the garments in their order, from each camera that `look` chooses for
    /// the box around them; calls `done` after each picture. `lines` are drawn by a GPU alone.
    ///
    /// # Errors
    /// [`AppError::Device`] where a GPU fails.
    pub fn draw(
        &mut self,
        surfaces: &[PictureSurface<'_>],
        lines: &[Line],
        (size, quality): (Size, TraceQuality),
        look: impl Fn(&Bounds) -> Vec<OrbitCamera>,
        mut done: impl FnMut(),
    ) -> Result<Vec<Image>, AppError> {
        match self {
            // Lines are refused where rays draw.
            Self::RayTracer if lines.is_empty() => {
                let stage = TracedScene::build(PictureScene { surfaces, floor: true });
                let shot = |camera: &OrbitCamera| {
                    let image = stage.render(camera, size, quality);
                    done();
                    image
                };
                Ok(look(&stage.bounds()).iter().map(shot).collect())
            }
            Self::RayTracer => Err(AppError::internal("lines were asked of the ray tracer")),
            #[cfg(feature = "view")]
            Self::Gpu(gpu) => {
                gpu.update(surfaces, lines, quality)?;
                let bounds = surfaces.iter().fold(Bounds::EMPTY, |b, s| b.union(Bounds::of(s.positions)));
                let mut images = Vec::new();
                for camera in look(&bounds) {
                    images.push(gpu.picture(&camera, size, quality)?);
                    done();
                }
                Ok(images)
            }
        }
    }
}
