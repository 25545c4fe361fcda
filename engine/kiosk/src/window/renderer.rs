//! The renderer of the window, on the render thread: it takes input from the display, paints the newest screen over the newest
//! snapshot, and presents both.

use std::sync::{Arc, OnceLock};
use std::time::Instant;

use toile_engine::clock::Clock;
use toile_engine::frame_loop::queue::{Capacity, Receiver, Sender};
use toile_engine::frame_loop::render_thread::Renderer;
use toile_engine::triple_buffer::Reader;
use toile_engine::world::Snapshot;
use toile_fitting::live::own_picture::PictureReceiver;
use toile_view::raster::PresentOutcome;
use winit::window::Window;

use super::body_model::{BodyModel, ModelPair};
use super::body_renderer::BodyScene;
use super::frame_pacing::FramePacer;
use super::frame_stats::FrameStats;
use super::input::{InputEvent, WindowState};
use super::options::WindowOptions;
use super::own_picture::OwnPictureView;
use super::paint::{DisplayMetrics, ScreenPainter};
use super::surface::WindowSurface;
use crate::service::report::WindowReport;
use crate::visitor::model::NavigationKey;
use crate::visitor::screen::{Action, BodyView, Screen};

/// User events that wait for the service.
pub const USER_EVENTS: usize = 64;

/// Name of this capacity in reports and warnings.
pub const USER_EVENTS_NAME: &str = "USER_EVENTS (queue of what the visitor asks for)";

/// Most devices that are lost one after the other, with no picture between them.
const MOST_LOST: u32 = 3;

/// What the visitor asks for at the display.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum UserEvent {
    /// A control was pressed.
    Pressed(Action),
    /// A key went down.
    Key(NavigationKey),
    /// A key of a keypad went down.
    Typed(Action),
}

/// The ends of the channels that the renderer holds.
pub struct RendererChannels {
    /// Input from the window system.
    pub input_events: Receiver<InputEvent>,
    /// The window as it is.
    pub window_state: Reader<WindowState>,
    /// Screens to show; the latest counts.
    pub screens: Reader<Screen>,
    /// What the visitor asks for.
    pub user_events: Sender<UserEvent>,
    /// Two sizes to be compared, or none any more.
    pub pairs: Receiver<Option<Box<ModelPair>>>,
}

/// Draws the kiosk's window.
pub struct WindowRenderer {
    window: Arc<Window>,
    channels: RendererChannels,
    painter: ScreenPainter,
    surface: Option<WindowSurface>,
    pacer: FramePacer,
    stats: FrameStats,
    options: WindowOptions,
    /// The body that is drawn.
    model: BodyModel,
    pair: Option<Box<ModelPair>>,
    /// The shopper's own picture, where they may see it.
    own: Option<OwnPictureView>,
    /// Whether the surface has yet to take them over.
    changed: bool,
    /// Why nothing can be drawn any more, set once.
    fault: Arc<OnceLock<String>>,
    lost_in_a_row: u32,
    /// What the adapter was, when it is gone.
    adapter: (String, bool),
}

impl WindowRenderer {
    /// Opens a device for a window.
    ///
    /// # Errors
    /// Why nothing can draw, with the cure.
    pub fn open(
        window: Arc<Window>,
        channels: RendererChannels,
        options: WindowOptions,
        fault: Arc<OnceLock<String>>,
    ) -> Result<Self, String> {
        let surface = WindowSurface::open(&window)?;
        let adapter = (surface.name.clone(), surface.software);
        Ok(Self {
            window,
            channels,
            painter: ScreenPainter::default(),
            surface: Some(surface),
            pacer: FramePacer::default(),
            stats: FrameStats::new(options.begun),
            options,
            model: BodyModel::default(),
            pair: None,
            own: None,
            changed: false,
            fault,
            lost_in_a_row: 0,
            adapter,
        })
    }

    /// Compiles what bodies are drawn with, behind the first picture.
    pub fn prepare(&mut self) {
        if let Some(surface) = &mut self.surface {
            surface.prepare();
        }
    }

    /// What is to be known where the processor draws.
    pub fn slowness(&self) -> Option<String> {
        let (name, software) = &self.adapter;
        software.then(|| {
            format!(
                "the processor draws ({name}), so pictures are fewer and plainer; install a driver for a graphics card"
            )
        })
    }

    /// The same, with a camera's pictures to show.
    #[must_use]
    pub fn seeing(self, pictures: Option<PictureReceiver>) -> Self {
        Self { own: pictures.map(OwnPictureView::new), ..self }
    }

    /// The same, with the first body to draw.
    #[must_use]
    pub fn showing(self, model: BodyModel) -> Self {
        Self { model, changed: true, ..self }
    }

    /// What it came to, and what did not go as it should.
    pub fn report(&mut self) -> (WindowReport, Vec<String>) {
        let size = self.channels.window_state.latest().size;
        let report = self.stats.report(self.adapter.0.clone(), self.adapter.1, size);
        let capacities = [self.channels.input_events.capacity(), self.channels.pairs.capacity()];
        (report, capacities.iter().filter_map(Capacity::warning).collect())
    }

    /// Takes input from the window system, and hands on what it asks for.
    fn handle_input(&mut self) {
        while let Some(event) = self.channels.input_events.pop() {
            self.pacer.hurry();
            let asked_for = match event {
                InputEvent::Key(key) => Some(UserEvent::Key(key)),
                InputEvent::Typed(action) => Some(UserEvent::Typed(action)),
                InputEvent::Touch(touch) => {
                    self.painter.touch(touch, self.channels.screens.latest()).map(UserEvent::Pressed)
                }
            };
            if let Some(asked_for) = asked_for {
                self.channels.user_events.push(asked_for);
            }
        }
    }

    /// Draws a picture, if one is due.
    pub fn draw(&mut self, snapshot: Option<&Snapshot>) {
        self.handle_input();
        while let Some(pair) = self.channels.pairs.pop() {
            (self.pair, self.changed) = (pair, true);
        }
        let begun = Instant::now();
        if !self.pacer.is_due(begun) {
            self.stats.rested += 1;
            return;
        }
        if self.surface.is_none() {
            self.open_anew();
        }
        let (shown, software) = self.paint(snapshot);
        let now = Instant::now();
        self.pacer.drawn(begun, now, software);
        match shown {
            PresentOutcome::Yes => {
                self.lost_in_a_row = 0;
                self.stats.presented(begun, now);
            }
            PresentOutcome::Resting => {
                self.pacer.hidden(now);
                self.stats.paused();
            }
            PresentOutcome::NewDevice => self.lose_device(),
            PresentOutcome::Skipped | PresentOutcome::NewSurface => {
                self.stats.refused += 1;
                self.stats.paused();
            }
        }
    }

    /// Paints the newest screen over the newest snapshot; says also whether the processor did.
    fn paint(&mut self, snapshot: Option<&Snapshot>) -> (PresentOutcome, bool) {
        let Some(surface) = &mut self.surface else { return (PresentOutcome::Resting, false) };
        if std::mem::take(&mut self.changed) {
            surface.dress(&self.model, self.pair.as_deref());
        }
        if let Some(snapshot) = snapshot {
            surface.take(snapshot, self.options.clock.now_ns());
        }
        let (window_state, screen) = (*self.channels.window_state.latest(), self.channels.screens.latest());
        let display = DisplayMetrics {
            size: window_state.size,
            pixel_mm: self.options.height_mm / window_state.size[1].max(1) as f32,
        };
        let painted = self.painter.paint(screen, display);
        surface.update_textures(&painted);
        let time_s = self.options.motion.then(|| self.options.begun.elapsed().as_secs_f64());
        let looks = matches!(screen.body_view, BodyView::Shopper { own_picture: true, .. });
        let own = match &mut self.own {
            Some(own) if looks => {
                let size = surface.drawn_size(window_state);
                let [left, _, right, _] = painted.free;
                own.show(&self.model, snapshot, &screen.colours, size, [left, right])
            }
            Some(own) => {
                own.rest();
                None
            }
            None => None,
        };
        let (body_view, colours, free) = (&screen.body_view, &screen.colours[..], painted.free);
        let scene = BodyScene { body_view, colours, free, time_s, own };
        (surface.show(window_state, &scene, painted), surface.software)
    }

    /// The device is gone, and with it every texture: the screen painter starts afresh, so that it uploads all of them again.
    fn lose_device(&mut self) {
        self.stats.lost += 1;
        self.stats.paused();
        self.lost_in_a_row += 1;
        (self.surface, self.painter, self.changed) = (None, ScreenPainter::default(), true);
        if self.lost_in_a_row > MOST_LOST {
            self.give_up("its device was lost again and again; update its driver or check the card".to_owned());
        }
    }

    fn open_anew(&mut self) {
        match WindowSurface::open(&self.window) {
            Ok(surface) => {
                self.adapter = (surface.name.clone(), surface.software);
                self.surface = Some(surface);
            }
            Err(why) => self.give_up(why),
        }
    }

    fn give_up(&self, why: String) {
        // Only the first reason counts.
        _ = self.fault.set(why);
        self.options.stop.request();
    }
}

impl Renderer for WindowRenderer {
    type Outfit = BodyModel;

    fn set_outfit(&mut self, outfit: &mut BodyModel) {
        std::mem::swap(&mut self.model, outfit);
        // Two sizes were those of the shopper before.
        (self.pair, self.changed) = (None, true);
    }

    fn draw(&mut self, snapshot: &Snapshot) {
        self.draw(Some(snapshot));
    }
}
