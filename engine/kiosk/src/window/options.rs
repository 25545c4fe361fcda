//! Options of the window.

use std::time::Instant;

use toile_engine::clock::RealClock;

use crate::service::service_manager::StopSignal;
use crate::visitor::screen::Screen;

/// How the window is opened and what it shows first.
#[derive(Debug, Clone)]
pub struct WindowOptions {
    /// Size of the window (pixels); none covers the display.
    pub windowed: Option<[u32; 2]>,
    /// Height of the display (mm).
    pub height_mm: f32,
    /// When the program was started.
    pub begun: Instant,
    /// The loop's clock.
    pub clock: RealClock,
    /// Whether anything moves by itself, such as a mannequin that turns.
    pub motion: bool,
    /// The first screen.
    pub first: Screen,
    /// Requested when the window is closed, or when nothing can draw on it any more.
    pub stop: StopSignal,
}
