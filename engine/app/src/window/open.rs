//! Open: `toile kiosk` with a window. Main opens it and waits; the service begins on a thread of its own, and beside it the device
//! is opened and shows its first picture while the mannequin is being dressed.

use std::sync::mpsc::{Receiver, sync_channel};
use std::sync::{Arc, OnceLock};
use std::thread;
use std::time::{Duration, Instant};

use toile_engine::clock::RealClock;
use toile_engine::pace::queue::{self, Sender, bounded};
use toile_engine::pace::roles::{self, Role};
use toile_engine::relay::{Relay, Writer};
use winit::window::Window;

use super::glass::{ASKED, ASKED_NAME, Asked, Ends, Glass};
use super::input::{Frame, HEARD, HEARD_NAME};
use super::look::Pair;
use super::shell::{self, Farewell, Shell};
use crate::exit::AppError;
use crate::guest::screen::Screen;
use crate::kiosk::manager::Ending;

/// Longest that the window system may take to open a window.
const LONGEST_OPEN: Duration = Duration::from_secs(10);

/// Pairs of sizes that wait to be shown.
const PAIRS: usize = 4;

/// The name of the bound, as warnings give it.
const PAIRS_NAME: &str = "PAIRS (engine/app/src/window/open.rs)";

/// What the window is to be.
#[derive(Debug, Clone)]
pub struct Wanted {
    /// Pixels of a window; none covers the display.
    pub windowed: Option<[u32; 2]>,
    /// Height of the display (mm).
    pub height_mm: f32,
    /// When the program began.
    pub begun: Instant,
    /// The loop's clock.
    pub clock: RealClock,
    /// Whether anything moves by itself, such as a mannequin that turns.
    pub motion: bool,
    /// What is shown first.
    pub first: Screen,
    /// Who is told when the window is closed, or when nothing can draw on it any more.
    pub ending: Ending,
}

/// The window's ends that the service holds.
pub struct Front {
    /// What is to be shown.
    pub screens: Writer<Screen>,
    /// What is asked for.
    pub asked: queue::Receiver<Asked>,
    /// Two sizes to be compared, or none any more.
    pub pairs: Sender<Option<Box<Pair>>>,
    /// The eye, which is being opened.
    pub opening: Opening,
}

/// A device that is being opened.
pub struct Opening(thread::JoinHandle<Result<Glass, String>>);

impl Opening {
    /// The eye, when its device is open.
    ///
    /// # Errors
    /// Why nothing can draw, with the cure.
    pub fn eye(self) -> Result<Glass, AppError> {
        let glass = self.0.join().map_err(|_| AppError::Internal("the display's device panicked".into()))?;
        glass.map_err(AppError::Device)
    }
}

/// Opens the window on this thread and runs `serve` on another until it returns; it is handed the window's other ends.
///
/// # Errors
/// Those of `serve`; where there is no display, where it went away, or where nothing can draw on it any more.
pub fn run<T: Send>(wanted: Wanted, serve: impl FnOnce(Front) -> Result<T, AppError> + Send) -> Result<T, AppError> {
    let events = shell::event_loop()?;
    let farewell = Farewell(events.create_proxy());
    let (hear, heard) = bounded(HEARD_NAME, HEARD);
    let (ask, asked) = bounded(ASKED_NAME, ASKED);
    let frame = Relay::new(&Frame::default());
    let screens = Relay::new(&wanted.first);
    let (show, pairs) = bounded(PAIRS_NAME, PAIRS);
    let (opened, window) = sync_channel(1);
    let ending = wanted.ending.clone();
    let shell = Shell::new(wanted.windowed, hear, frame.writer, ending.clone(), opened);
    let fault = Arc::new(OnceLock::new());
    let ends = Ends { heard, frame: frame.reader, screens: screens.reader, asked: ask, pairs };
    thread::scope(|scope| {
        let eye = {
            let fault = fault.clone();
            thread::Builder::new().name("toile-opening".into()).spawn(move || open(&window, ends, wanted, fault))
        };
        let opening = Opening(eye.map_err(AppError::internal)?);
        let front = Front { screens: screens.writer, asked, pairs: show, opening };
        let service = thread::Builder::new().name("toile-service".into()).spawn_scoped(scope, move || {
            // Dropped last, and also where the service panics: the window never outlives it.
            let _farewell = farewell;
            serve(front)
        });
        let service = service.map_err(AppError::internal)?;
        let seen = shell.run(events);
        ending.ask();
        let served = service.join().unwrap_or_else(|_| Err(AppError::Internal("the service panicked".into())));
        match fault.get() {
            Some(why) => Err(AppError::Device(format!("the display can be drawn on no more: {why}"))),
            None => seen.and(served),
        }
    })
}

/// Waits for the window and makes its first picture. On the core of the render thread: a driver that draws on the processor
/// starts threads of its own, which inherit it.
fn open(
    window: &Receiver<Result<Arc<Window>, String>>,
    ends: Ends,
    wanted: Wanted,
    fault: Arc<OnceLock<String>>,
) -> Result<Glass, String> {
    roles::settle(Role::Render);
    let window = window.recv_timeout(LONGEST_OPEN).map_err(|_| "the window system opened no window; restart it")??;
    let mut glass = Glass::open(window, ends, wanted, fault)?;
    glass.draw(None);
    glass.prepare();
    Ok(glass)
}
