//! The kiosk's window.
//!
//! Reads: snapshots of the loop, the guest's [`Screen`](crate::guest::screen::Screen), touch, mouse and keys. Writes: pictures on the
//! display, what was pressed.
//! Budget: nothing of the physics' core: on a driver that draws on the processor, half of the first core at most.
//! Thread: main waits for the window system; render paints and presents; the service decides on a thread of its own.
//!
//! ```text
//! main     winit's events            -- Heard, a bounded queue; Frame, the latest value -->  render
//! render   paint, tessellate, present  -- Asked, a bounded queue -->  service
//! service  the guest's model           -- Screen, the latest value -->  render
//! physics  steps                       -- Snapshot, the latest value -->  render
//! ```
//!
//! egui lives on the render thread whole, and main hands it plain events. Were its context on main, each change of a texture would have to
//! cross over in order and none might be lost, though shapes may; here the thread that makes them uploads them, whether or not
//! the picture is shown. Main sleeps in the window system, so that a close, a resize or a signal is answered while a slow
//! driver draws.

mod canvas;
mod glass;
mod hosted;
mod input;
pub mod look;
mod open;
mod pace;
pub mod paint;
mod podium;
mod report;
mod shell;
mod varnish;
mod view;
mod wall;

pub use crate::kiosk::report::WindowReport;
pub use glass::{Asked, Glass};
pub use hosted::seen;
