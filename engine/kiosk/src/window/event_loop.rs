//! The event loop of the main thread, which opens the window and waits for the window system.

use std::sync::Arc;
use std::sync::mpsc::SyncSender;

use toile_engine::frame_loop::queue::Sender;
use toile_engine::triple_buffer::Writer;
use winit::application::ApplicationHandler;
use winit::dpi::PhysicalSize;
use winit::event::WindowEvent;
use winit::event_loop::{ActiveEventLoop, ControlFlow, EventLoop, EventLoopProxy};
use winit::window::{Fullscreen, Window, WindowAttributes, WindowId};

use super::input::{InputEvent, InputMapper, WindowState};
use crate::error::KioskError;
use crate::service::service_manager::StopSignal;

/// An event from the service to the window.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ServiceEvent {
    /// It has ended: the window closes.
    Ended,
}

/// The application on the main thread.
pub struct WindowApp {
    /// Size of the window (pixels); none covers the display.
    pub windowed: Option<[u32; 2]>,
    /// Receives the input events.
    pub input_events: Sender<InputEvent>,
    /// Receives the window's state.
    pub states: Writer<WindowState>,
    /// Requested when the window is closed.
    pub stop: StopSignal,
    /// Receives the window once it is open.
    pub opened: Option<SyncSender<Result<Arc<Window>, String>>>,
    state: WindowState,
    mapper: InputMapper,
    window: Option<Arc<Window>>,
}

/// The window system's loop.
///
/// # Errors
/// Where no display is there.
pub fn event_loop() -> Result<EventLoop<ServiceEvent>, KioskError> {
    EventLoop::with_user_event().build().map_err(|e| {
        KioskError::Device(format!(
            "no display can be opened ({e}); set DISPLAY or WAYLAND_DISPLAY, or run without a window by `--headless`"
        ))
    })
}

impl WindowApp {
    /// A window that is not open yet. Called at load: it allocates.
    pub fn new(
        windowed: Option<[u32; 2]>,
        input_events: Sender<InputEvent>,
        states: Writer<WindowState>,
        stop: StopSignal,
        opened: SyncSender<Result<Arc<Window>, String>>,
    ) -> Self {
        let (state, mapper, opened) = (WindowState::default(), InputMapper::default(), Some(opened));
        Self { windowed, input_events, states, stop, opened, state, mapper, window: None }
    }

    /// Runs until the service has ended.
    ///
    /// # Errors
    /// Where the display went away.
    pub fn run(mut self, events: EventLoop<ServiceEvent>) -> Result<(), KioskError> {
        events.set_control_flow(ControlFlow::Wait);
        let gone =
            |e| KioskError::Device(format!("the display has gone away ({e}); start the kiosk again when it is back"));
        events.run_app(&mut self).map_err(gone)
    }

    fn open(&self, on: &ActiveEventLoop) -> Result<Arc<Window>, String> {
        let attributes = Window::default_attributes().with_title("Toile");
        let attributes = match self.windowed {
            Some([w, h]) => attributes.with_inner_size(PhysicalSize::new(w, h)),
            None => covering(on, attributes.with_decorations(false)),
        };
        let window = on.create_window(attributes).map_err(|e| format!("no window can be opened ({e})"))?;
        // A shop's screen shows no arrow until a mouse moves.
        window.set_cursor_visible(self.windowed.is_some());
        Ok(Arc::new(window))
    }

    fn publish(&mut self) {
        self.states.publish(self.state);
    }
}

/// A window over the whole display. Its place and size are set too, because there may be no window manager to do it.
fn covering(on: &ActiveEventLoop, attributes: WindowAttributes) -> WindowAttributes {
    let attributes = attributes.with_fullscreen(Some(Fullscreen::Borderless(None)));
    match on.primary_monitor().or_else(|| on.available_monitors().next()) {
        Some(display) => attributes.with_inner_size(display.size()).with_position(display.position()),
        None => attributes,
    }
}

impl ApplicationHandler<ServiceEvent> for WindowApp {
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

    fn user_event(&mut self, on: &ActiveEventLoop, event: ServiceEvent) {
        match event {
            ServiceEvent::Ended => on.exit(),
        }
    }

    fn window_event(&mut self, _on: &ActiveEventLoop, _id: WindowId, event: WindowEvent) {
        match &event {
            WindowEvent::CloseRequested | WindowEvent::Destroyed => self.stop.request(),
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
        if let Some(event) = self.mapper.map(&event) {
            self.input_events.push(event);
        }
    }
}

impl WindowApp {
    fn cursor(&self, visible: bool) {
        if let Some(window) = &self.window {
            window.set_cursor_visible(visible);
        }
    }
}

/// Closes the window when the service has ended, also where it panicked.
pub struct CloseOnDrop(pub EventLoopProxy<ServiceEvent>);

impl Drop for CloseOnDrop {
    fn drop(&mut self) {
        // The loop may be gone already.
        _ = self.0.send_event(ServiceEvent::Ended);
    }
}
