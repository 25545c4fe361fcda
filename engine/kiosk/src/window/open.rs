//! Opening the window. The main thread opens it and waits; the service starts on a thread of its own, and beside it the device
//! is opened and shows its first picture while the mannequin is being dressed.

use std::sync::mpsc::{Receiver, sync_channel};
use std::sync::{Arc, OnceLock};
use std::thread;
use std::time::Duration;

use toile_engine::frame_loop::queue::{self, Sender, bounded};
use toile_engine::frame_loop::thread_roles::{self, ThreadRole};
use toile_engine::triple_buffer::{TripleBuffer, Writer};
use winit::window::Window;

use super::body_model::ModelPair;
use super::event_loop::{self, CloseOnDrop, WindowApp};
use super::input::{INPUT_EVENTS, INPUT_EVENTS_NAME, WindowState};
use super::options::WindowOptions;
use super::renderer::{RendererChannels, USER_EVENTS, USER_EVENTS_NAME, UserEvent, WindowRenderer};
use crate::error::KioskError;
use crate::visitor::screen::Screen;

/// Longest that the window system may take to open a window.
const LONGEST_OPEN: Duration = Duration::from_secs(10);

/// Pairs of sizes that wait to be shown.
const PAIRS: usize = 4;

/// Name of this capacity in reports and warnings.
const PAIRS_NAME: &str = "PAIRS (queue of pairs of sizes to show)";

/// The ends of the window's channels that the service holds.
pub struct ServiceChannels {
    /// Screens to show; the latest counts.
    pub screens: Writer<Screen>,
    /// What the visitor asks for.
    pub user_events: queue::Receiver<UserEvent>,
    /// Two sizes to be compared, or none any more.
    pub pairs: Sender<Option<Box<ModelPair>>>,
    /// The renderer, which is being opened.
    pub opening: OpeningRenderer,
}

/// A device that is being opened.
pub struct OpeningRenderer(thread::JoinHandle<Result<WindowRenderer, String>>);

impl OpeningRenderer {
    /// Waits until its device is open.
    ///
    /// # Errors
    /// Why nothing can draw, with the cure.
    pub fn finish(self) -> Result<WindowRenderer, KioskError> {
        let renderer = self.0.join().map_err(|_| KioskError::Internal("the display's device panicked".into()))?;
        renderer.map_err(KioskError::Device)
    }
}

/// Opens the window on this thread and runs `serve` on another until it returns; it receives the other ends of the window's channels.
///
/// # Errors
/// Those of `serve`; where there is no display, where it went away, or where nothing can draw on it any more.
pub fn run<T: Send>(
    options: WindowOptions,
    serve: impl FnOnce(ServiceChannels) -> Result<T, KioskError> + Send,
) -> Result<T, KioskError> {
    let events = event_loop::event_loop()?;
    let close = CloseOnDrop(events.create_proxy());
    let (events_in, input_events) = bounded(INPUT_EVENTS_NAME, INPUT_EVENTS);
    let (user_in, user_events) = bounded(USER_EVENTS_NAME, USER_EVENTS);
    let window_state = TripleBuffer::new(&WindowState::default());
    let screens = TripleBuffer::new(&options.first);
    let (show, pairs) = bounded(PAIRS_NAME, PAIRS);
    let (opened, window) = sync_channel(1);
    let stop = options.stop.clone();
    let app = WindowApp::new(options.windowed, events_in, window_state.writer, stop.clone(), opened);
    let fault = Arc::new(OnceLock::new());
    let channels = RendererChannels {
        input_events,
        window_state: window_state.reader,
        screens: screens.reader,
        user_events: user_in,
        pairs,
    };
    thread::scope(|scope| {
        let renderer = {
            let fault = fault.clone();
            thread::Builder::new().name("toile-opening".into()).spawn(move || open(&window, channels, options, fault))
        };
        let opening = OpeningRenderer(renderer.map_err(KioskError::internal)?);
        let channels = ServiceChannels { screens: screens.writer, user_events, pairs: show, opening };
        let service = thread::Builder::new().name("toile-service".into()).spawn_scoped(scope, move || {
            // Dropped last, and also where the service panics: the window never outlives it.
            let _close = close;
            serve(channels)
        });
        let service = service.map_err(KioskError::internal)?;
        thread_roles::apply(ThreadRole::Service);
        let seen = app.run(events);
        stop.request();
        let served = service.join().unwrap_or_else(|_| Err(KioskError::Internal("the service panicked".into())));
        match fault.get() {
            Some(why) => Err(KioskError::Device(format!("the display can be drawn on no more: {why}"))),
            None => seen.and(served),
        }
    })
}

/// Waits for the window and makes its first picture. On the core of the render thread: a driver that draws on the processor
/// starts threads of its own, which inherit it.
fn open(
    window: &Receiver<Result<Arc<Window>, String>>,
    channels: RendererChannels,
    options: WindowOptions,
    fault: Arc<OnceLock<String>>,
) -> Result<WindowRenderer, String> {
    thread_roles::apply(ThreadRole::Render);
    let window = window.recv_timeout(LONGEST_OPEN).map_err(|_| "the window system opened no window; restart it")??;
    let mut renderer = WindowRenderer::open(window, channels, options, fault)?;
    renderer.draw(None);
    renderer.prepare();
    Ok(renderer)
}
