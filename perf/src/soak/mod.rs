//! Soak: the loop for hours, with shoppers who come and go, garments that are changed, and everything that can go wrong.
//!
//! Reads: a seed, from which all of it follows. Writes: what was checked while it ran, a page, a recording.
//! Budget: about 100 us a step of the light scene, everything included; wall time where it runs in real time.
//! Thread: the caller's, all loops one after the other against a simulated clock; or the loop's own threads.
//!
//! Scenes are made outside of the physics' turn and handed over whole. What a fault does and when it counts as recovered
//! stands with [`fault_kind::FaultKind`].

mod camera;
mod depth_camera;
mod error;
pub mod fault_kind;
mod fault_monitor;
mod html;
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
pub use html::page;
pub use memory::MemorySample;
pub use options::{LEAST_APART_S, SceneWeight, SoakCamera, SoakOptions, SoakPlan};
pub use report::{FaultFigures, FaultKindFigures, MemoryFigures, RecoveryTicks, Soak, SoakCheck};
pub use run::{SoakRun, SoakTools, run};
pub use scene_maker::SceneMaker;
