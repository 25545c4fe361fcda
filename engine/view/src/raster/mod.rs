//! The rasteriser: pictures by a GPU, or by a driver that draws on the processor, on a display or off it.
//!
//! Runs on the render thread, which may wait for the display; the physics thread never does. A picture takes at most a
//! display's frame (16 ms) on hardware, and 540 x 960 at `RenderQuality::LOW` at most 100 ms on the processor.

mod display_state;
mod interpolation;
mod model;
mod offscreen;
mod pipelines;
mod presenter;
mod render_quality;
mod renderer;
mod shaders;
mod split_vertices;
mod surface_buffers;
mod textures;
mod view_uniforms;
mod weave_relief;
mod weave_textures;

pub use crate::video;
pub use display_state::{DisplayState, SurfaceAction, SurfaceEvent};
pub use interpolation::SurfaceInterpolation;
pub use model::{ClothAppearance, Model, ModelError, RenderMaterial, RenderSurface};
pub use offscreen::{Offscreen, OffscreenError};
pub use presenter::{HIDDEN_RETRY, PresentOutcome, PresentPacing, Presenter};
pub use render_quality::{MOST_BEAMS, RenderQuality};
pub use renderer::{Backdrop, MOST_VIEWS, Renderer, Viewport};
pub use toile_base::fabric::Weave;
pub use toile_engine::lines::Line;
/// The device that draws: the same kind that the cloth is stepped on, so that one may do both.
pub use toile_gpu::device::{AdapterChoice, Device as Gpu, DeviceNeeds, GpuError};
/// A surface's vertices in buffers on the device, drawn without a copy to the CPU.
pub use toile_gpu::vertex_source::VertexSource;
/// The graphics library itself, for callers that hand over display surfaces and targets.
pub use wgpu;
