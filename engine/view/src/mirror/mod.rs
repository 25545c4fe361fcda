//! The mirror: pictures by a GPU, or by a driver that draws on the processor, on a display or off it.
//!
//! Reads: positions and normals of each surface, here or on the device, lines, the camera's picture. Writes: a part of any target, sRGB.
//! Budget: a picture within a display's frame (16 ms) on hardware; 540 x 960 within 100 ms by the processor, at `Quality::LOW`.
//! Thread: render; it may wait for the display, which the physics thread never does.

mod blend;
mod light;
mod model;
mod offscreen;
mod pipelines;
mod presenter;
mod quality;
mod renderer;
mod shaders;
mod surface_state;
mod surfaces;
mod textures;
mod threads;
mod weave;

pub use crate::film;
pub use blend::Blend;
pub use model::{Cloth, Material, Model, ModelError, Shape};
pub use offscreen::{Offscreen, OffscreenError};
pub use presenter::{Pace, Presenter, REST, Shown};
pub use quality::{MOST_BEAMS, Quality};
pub use renderer::{Backdrop, MOST_VIEWS, Renderer, Viewport};
pub use surface_state::{Event, Step, SurfaceState};
pub use toile_assets::fabric::Weave;
pub use toile_engine::lines::Line;
/// The device that draws: the same kind that the cloth is stepped on, so that one may do both.
pub use toile_gpu::device::{Choice, Device as Gpu, GpuError, Needs};
/// What a surface is drawn from without a way over the CPU.
pub use toile_gpu::source::Source;
/// The graphics library itself, for whoever hands over surfaces and targets.
pub use wgpu;
