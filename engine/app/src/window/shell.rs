//! Shell: the main thread, which opens the window and waits for the window system.

use std::sync::Arc;
use std::sync::mpsc::SyncSender;

use toile_engine::pace::queue::Sender;
use toile_engine::relay::Writer;
use winit::application::ApplicationHandler;
use winit::dpi::PhysicalSize;
use winit::event::WindowEvent;
use winit::event_loop::{ActiveEventLoop, ControlFlow, EventLoop, EventLoopProxy};
use winit::window::{Fullscreen, Window, WindowAttributes, WindowId};

use super::input::{Ears, Frame, Heard};
use crate::exit::AppError;
use crate::kiosk::manager::Ending;

/// What the service tells the window.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Told {
    /// It has ended: the window closes.
    Ended,
}

/// The main thread's side.
pub struct Shell {
    /// Pixels of a window; none covers the display.
    pub windowed: Option<[u32; 2]>,
    /// Where events go.
    pub heard: Sender<Heard>,
    /// Where the window's state goes.
    pub frame: Writer<Frame>,
    /// Who is told when the window is closed.
    pub ending: Ending,
    /// Who waits for the window.
    pub opened: Option<SyncSender<Result<Arc<Window>, String>>>,
    state: Frame,
    ears: Ears,
    window: Option<Arc<Window>>,
}

/// The window system's loop.
///
/// # Errors
/// Where no display is there.
pub fn event_loop() -> Result<EventLoop<Told>, AppError> {
    EventLoop::with_user_event().build().map_err(|e| {
        AppError::Device(format!(
            "no display can be opened ({e}); set DISPLAY or WAYLAND_DISPLAY, or run without a window by `--headless`"
        ))
    })
}

impl Shell {
    /// At load.
    pub fn new(
        windowed: Option<[u32; 2]>,
        heard: Sender<Heard>,
        frame: Writer<Frame>,
        ending: Ending,
        opened: SyncSender<Result<Arc<Window>, String>>,
    ) -> Self {
        let (state, ears, opened) = (Frame::default(), Ears::default(), Some(opened));
        Self { windowed, heard, frame, ending, opened, state, ears, window: None }
    }

    /// Runs until the service has ended.
    ///
    /// # Errors
    /// Where the display went away.
    pub fn run(mut self, events: EventLoop<Told>) -> Result<(), AppError> {
        events.set_control_flow(ControlFlow::Wait);
        let gone =
            |e| AppError::Device(format!("the display has gone away ({e}); start the kiosk again when it is back"));
        events.run_app(&mut self).map_err(gone)
    }

    fn open(&self, on: &ActiveEventLoop) -> Result<Arc<Window>, String> {
        let wanted = Window::default_attributes().with_title("Toile");
        let wanted = match self.windowed {
            Some([w, h]) => wanted.with_inner_size(PhysicalSize::new(w, h)),
            None => covering(on, wanted.with_decorations(false)),
        };
        let window = on.create_window(wanted).map_err(|e| format!("no window can be opened ({e})"))?;
        // A shop's screen shows no arrow until somebody moves a mouse.
        window.set_cursor_visible(self.windowed.is_some());
        Ok(Arc::new(window))
    }

    fn publish(&mut self) {
        self.frame.publish(self.state);
    }
}

/// A window over the whole display. Its place and size are said too: without a window manager nobody else sees to them.
fn covering(on: &ActiveEventLoop, wanted: WindowAttributes) -> WindowAttributes {
    let wanted = wanted.with_fullscreen(Some(Fullscreen::Borderless(None)));
    match on.primary_monitor().or_else(|| on.available_monitors().next()) {
        Some(display) => wanted.with_inner_size(display.size()).with_position(display.position()),
        None => wanted,
    }
}

impl ApplicationHandler<Told> for Shell {
    fn resumed(&mut self, on: &ActiveEventLoop) {
        let Some(opened) = self.opened.take() else { return };
        let window = self.open(on);
        if let Ok(window) = &window {
            let size = window.inner_size();
            self.state.size = [size.width, size.height];
            self.window = Some(window.clone());
            self.publish();
        }
        // The service may have ended already.
        _ = opened.send(window);
    }

    fn user_event(&mut self, on: &ActiveEventLoop, told: Told) {
        match told {
            Told::Ended => on.exit(),
        }
    }

    fn window_event(&mut self, _on: &ActiveEventLoop, _id: WindowId, event: WindowEvent) {
        match &event {
            WindowEvent::CloseRequested | WindowEvent::Destroyed => self.ending.ask(),
            WindowEvent::Resized(size) => {
                self.state.size = [size.width, size.height];
                self.publish();
            }
            WindowEvent::Occluded(hidden) => {
                self.state.hidden = *hidden;
                self.publish();
            }
            WindowEvent::CursorMoved { .. } => self.cursor(true),
            WindowEvent::Touch(_) => self.cursor(false),
            _ => {}
        }
        if let Some(heard) = self.ears.hear(&event) {
            self.heard.push(heard);
        }
    }
}

impl Shell {
    fn cursor(&self, visible: bool) {
        if let Some(window) = &self.window {
            window.set_cursor_visible(visible);
        }
    }
}

/// Tells the window that the service has ended, also where it panicked.
pub struct Farewell(pub EventLoopProxy<Told>);

impl Drop for Farewell {
    fn drop(&mut self) {
        // The loop may be gone already.
        _ = self.0.send_event(Told::Ended);
    }
}
