//! Soak: the loop for hours, with shoppers who come and go, garments that are changed, and everything that can go wrong.
//!
//! Scenes are made outside of the physics' turn and handed over whole. What a fault does and when it counts as recovered
//! stands with [`fault_kind::FaultKind`].

mod camera;
mod depth_camera;
mod error;
pub mod fault_kind;
mod fault_monitor;
mod memory;
mod observed_loops;
mod options;
mod recorder;
mod report;
mod run;
pub mod scenario;
mod scene_loop;
mod scene_maker;

pub use error::SoakError;
pub use memory::MemorySample;
pub use options::{LEAST_APART_S, SceneWeight, SoakCamera, SoakOptions, SoakOutfit, SoakPlan};
pub use report::{FaultFigures, FaultKindFigures, MemoryFigures, RecoveryTicks, Soak, SoakCheck};
pub use run::{SoakRun, SoakTools, run};
pub use scene_maker::SceneMaker;
