//! Exports of bodies, garments and meshes that move, for other tools.

// Modules in the order of the data.
mod frame_rate;
mod surface;

mod joints;
mod material;
mod part;
mod parts;
mod ply;
mod point_cache;

pub mod glb;
mod obj;
mod usda;

mod moving_glb;

mod motion;
pub mod session;
#[cfg(test)]
mod tests;

pub use frame_rate::FrameRate;
pub use glb::{DressedBody, WornGarment, glb};
pub use motion::motion_glb;
pub use moving_glb::{MAX_GLB_FRAMES, MovingGlb};
pub use part::MovingPart;
pub use ply::{ply, ply_positions};
pub use point_cache::{CacheFormat, PointCache};
pub use session::{ExportFormat, ExportPlan, SessionExport};
pub use surface::SurfaceLook;
pub(crate) use surface::linear;
pub use usda::UsdMesh;
