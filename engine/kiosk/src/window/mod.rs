//! The kiosk's window.
//!
//! The main thread waits for the window system. The render thread paints and presents. The service decides on a thread of its own.
//!
//! ```text
//! main     winit's events            -- InputEvent, a bounded queue; WindowState, the latest value -->  render
//! render   paint, tessellate, present  -- UserEvent, a bounded queue -->  service
//! service  the visitor's model         -- Screen, the latest value -->  render
//! physics  steps                       -- Snapshot, the latest value -->  render
//! ```
//!
//! egui lives on the render thread whole, and main hands it plain events. Were its context on main, each change of a texture would have to
//! cross over in order and none might be lost, though shapes may; here the thread that makes them uploads them, whether or not
//! the picture is shown. Main sleeps in the window system, so that a close, a resize or a signal is answered while a slow
//! driver draws.

pub mod body_model;
mod body_renderer;
mod camera;
mod event_loop;
mod frame_pacing;
mod frame_stats;
mod input;
mod open;
mod options;
mod overlay;
mod own_picture;
pub mod paint;
mod render_target;
mod renderer;
mod run;
mod surface;

pub use crate::service::report::WindowReport;
pub use renderer::{UserEvent, WindowRenderer};
pub use run::run;
