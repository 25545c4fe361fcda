//! The artist: who draws the pictures of a try-on, the processor by rays or a GPU by triangles.

use std::str::FromStr;

use toile_assets::body::Body;
use toile_assets::garment::Garment;
use toile_engine::lines::Line;
use toile_view::image::{Image, Size};
use toile_view::scene::{Bounds, Camera, Scene, Surface};
use toile_view::trace::{Quality, Stage};

use crate::exit::AppError;

#[cfg(feature = "view")]
mod mirror;

/// What draws.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Renderer {
    /// The ray tracer, on every core.
    #[default]
    Cpu,
    /// The mirror, on a GPU or a driver that draws on the processor.
    Gpu,
}

impl Renderer {
    /// All of them.
    pub const ALL: [Self; 2] = [Self::Cpu, Self::Gpu];

    /// Its name on the command line.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Cpu => "cpu",
            Self::Gpu => "gpu",
        }
    }
}

impl FromStr for Renderer {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let of = Self::ALL.into_iter().find(|r| r.name() == text);
        of.ok_or_else(|| format!("`{text}` draws nothing; choose cpu or gpu"))
    }
}

/// Draws one shopper and what they wear.
pub enum Artist {
    /// By rays.
    Tracer,
    /// By triangles.
    #[cfg(feature = "view")]
    Mirror(Box<mirror::Mirror>),
}

impl Artist {
    /// Finds what draws; before any long work.
    ///
    /// # Errors
    /// [`AppError::Usage`] where a GPU is asked for that was not built in, [`AppError::Device`] where there is none.
    pub fn open(renderer: Renderer) -> Result<Self, AppError> {
        match renderer {
            Renderer::Cpu => Ok(Self::Tracer),
            #[cfg(feature = "view")]
            Renderer::Gpu => Ok(Self::Mirror(Box::new(mirror::Mirror::open()?))),
            #[cfg(not(feature = "view"))]
            Renderer::Gpu => Err(AppError::Usage(
                "this build cannot draw on a GPU; build it with `cargo build --release --features view`, or leave out \
                 `--renderer gpu`"
                    .to_owned(),
            )),
        }
    }

    /// Gets ready for a body and what it wears.
    pub fn prepare(&mut self, body: &Body, garments: &[Garment]) {
        match self {
            // Rays need nothing but the surfaces of each picture.
            Self::Tracer => {
                let (_, _) = (body, garments);
            }
            #[cfg(feature = "view")]
            Self::Mirror(mirror) => mirror.prepare(body, garments),
        }
    }

    /// Who it is, for reports.
    pub fn describe(&self) -> String {
        match self {
            Self::Tracer => Renderer::Cpu.name().to_owned(),
            #[cfg(feature = "view")]
            Self::Mirror(mirror) => format!("{}: {}", Renderer::Gpu.name(), mirror.adapter()),
        }
    }

    /// Draws surfaces, the body first and then the garments in their order, from each camera that `look` chooses for
    /// the box around them; calls `done` after each picture. `lines` are drawn by a GPU alone.
    ///
    /// # Errors
    /// [`AppError::Device`] where a GPU fails.
    pub fn draw(
        &mut self,
        surfaces: &[Surface<'_>],
        lines: &[Line],
        (size, quality): (Size, Quality),
        look: impl Fn(&Bounds) -> Vec<Camera>,
        mut done: impl FnMut(),
    ) -> Result<Vec<Image>, AppError> {
        match self {
            // Lines are refused where rays draw.
            Self::Tracer if lines.is_empty() => {
                let stage = Stage::build(Scene { surfaces, floor: true });
                let shot = |camera: &Camera| {
                    let image = stage.render(camera, size, quality);
                    done();
                    image
                };
                Ok(look(&stage.bounds()).iter().map(shot).collect())
            }
            Self::Tracer => Err(AppError::internal("lines were asked of the ray tracer")),
            #[cfg(feature = "view")]
            Self::Mirror(mirror) => {
                mirror.take(surfaces, lines, quality)?;
                let bounds = surfaces.iter().fold(Bounds::EMPTY, |b, s| b.union(Bounds::of(s.positions)));
                let mut images = Vec::new();
                for camera in look(&bounds) {
                    images.push(mirror.shoot(&camera, size, quality)?);
                    done();
                }
                Ok(images)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_renderer_is_found_by_its_name() {
        for renderer in Renderer::ALL {
            assert_eq!(renderer.name().parse(), Ok(renderer));
        }
        assert!("pencil".parse::<Renderer>().unwrap_err().contains("cpu or gpu"));
    }
}
