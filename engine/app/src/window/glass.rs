//! Glass: the render thread's eye. It hears what was done at the display, paints the newest screen over the newest
//! snapshot, and shows both.

use std::sync::{Arc, OnceLock};
use std::time::Instant;

use toile_engine::clock::Clock;
use toile_engine::frame::Snapshot;
use toile_engine::pace::queue::{Capacity, Receiver, Sender};
use toile_engine::pace::render::Eye;
use toile_engine::relay::Reader;
use toile_view::mirror::Shown;
use winit::window::Window;

use super::input::{Frame, Heard};
use super::look::{Look, Pair};
use super::open::Wanted;
use super::pace::Pace;
use super::paint::{Display, Easel};
use super::podium::Scene;
use super::report::Figures;
use super::wall::Wall;
use crate::guest::model::Button;
use crate::guest::screen::{Action, Screen};
use crate::kiosk::report::WindowReport;

/// What was asked for that waits for the service.
pub const ASKED: usize = 64;

/// The name of the bound, as warnings give it.
pub const ASKED_NAME: &str = "ASKED (engine/app/src/window/glass.rs)";

/// Most devices that are lost one after the other, with no picture between them.
const MOST_LOST: u32 = 3;

/// What somebody asks for at the display.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Asked {
    /// A control was pressed.
    Pressed(Action),
    /// A key went down.
    Key(Button),
}

/// The ends that the eye holds.
pub struct Ends {
    /// What was done at the display.
    pub heard: Receiver<Heard>,
    /// The window as it is.
    pub frame: Reader<Frame>,
    /// What is to be shown.
    pub screens: Reader<Screen>,
    /// What is asked for.
    pub asked: Sender<Asked>,
    /// Two sizes to be compared, or none any more.
    pub pairs: Receiver<Option<Box<Pair>>>,
}

/// The eye.
pub struct Glass {
    window: Arc<Window>,
    ends: Ends,
    easel: Easel,
    wall: Option<Wall>,
    pace: Pace,
    figures: Figures,
    wanted: Wanted,
    /// Who stands there.
    look: Look,
    pair: Option<Box<Pair>>,
    /// Whether the wall has yet to be told of them.
    changed: bool,
    /// Why nothing can be drawn any more, told once.
    fault: Arc<OnceLock<String>>,
    lost_in_a_row: u32,
    /// What the adapter was, when it is gone.
    adapter: (String, bool),
}

impl Glass {
    /// Looks at a window. Opens the device.
    ///
    /// # Errors
    /// Why nothing can draw, with the cure.
    pub fn open(window: Arc<Window>, ends: Ends, wanted: Wanted, fault: Arc<OnceLock<String>>) -> Result<Self, String> {
        let wall = Wall::open(&window)?;
        let adapter = (wall.name.clone(), wall.software);
        Ok(Self {
            window,
            ends,
            easel: Easel::default(),
            wall: Some(wall),
            pace: Pace::default(),
            figures: Figures::new(wanted.begun),
            wanted,
            look: Look::default(),
            pair: None,
            changed: false,
            fault,
            lost_in_a_row: 0,
            adapter,
        })
    }

    /// Compiles what bodies are drawn with, behind the first picture.
    pub fn prepare(&mut self) {
        if let Some(wall) = &mut self.wall {
            wall.prepare();
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

    /// Who stands there first.
    #[must_use]
    pub fn seeing(self, look: Look) -> Self {
        Self { look, changed: true, ..self }
    }

    /// What it came to, and what did not go as it should.
    pub fn report(&mut self) -> (WindowReport, Vec<String>) {
        let size = self.ends.frame.latest().size;
        let report = self.figures.report(self.adapter.0.clone(), self.adapter.1, size);
        let capacities = [self.ends.heard.capacity(), self.ends.pairs.capacity()];
        (report, capacities.iter().filter_map(Capacity::warning).collect())
    }

    /// Takes in what was done at the display, and hands on what it asks for.
    fn hear(&mut self) {
        while let Some(heard) = self.ends.heard.pop() {
            self.pace.hurry();
            let asked = match heard {
                Heard::Key(key) => Some(Asked::Key(key)),
                Heard::Touch(touch) => self.easel.touch(touch, self.ends.screens.latest()).map(Asked::Pressed),
            };
            if let Some(asked) = asked {
                self.ends.asked.push(asked);
            }
        }
    }

    /// Draws a picture, if one is due.
    pub fn draw(&mut self, snapshot: Option<&Snapshot>) {
        self.hear();
        while let Some(pair) = self.ends.pairs.pop() {
            (self.pair, self.changed) = (pair, true);
        }
        let begun = Instant::now();
        if !self.pace.is_due(begun) {
            self.figures.rested += 1;
            return;
        }
        if self.wall.is_none() {
            self.open_anew();
        }
        let (shown, software) = self.paint(snapshot);
        let now = Instant::now();
        self.pace.drawn(begun, now, software);
        match shown {
            Shown::Yes => {
                self.lost_in_a_row = 0;
                self.figures.presented(begun, now);
            }
            Shown::Resting => {
                self.pace.hidden(now);
                self.figures.paused();
            }
            Shown::NewDevice => self.lose(),
            Shown::Skipped | Shown::NewSurface => {
                self.figures.refused += 1;
                self.figures.paused();
            }
        }
    }

    /// Paints the newest screen over the newest snapshot; says also whether the processor did.
    fn paint(&mut self, snapshot: Option<&Snapshot>) -> (Shown, bool) {
        let Some(wall) = &mut self.wall else { return (Shown::Resting, false) };
        if std::mem::take(&mut self.changed) {
            wall.dress(&self.look, self.pair.as_deref());
        }
        if let Some(snapshot) = snapshot {
            wall.take(snapshot, self.wanted.clock.now_ns());
        }
        let (frame, screen) = (*self.ends.frame.latest(), self.ends.screens.latest());
        let display = Display { size: frame.size, pixel_mm: self.wanted.height_mm / frame.size[1].max(1) as f32 };
        let painted = self.easel.paint(screen, display);
        wall.take_in(&painted);
        let time_s = self.wanted.motion.then(|| self.wanted.begun.elapsed().as_secs_f64());
        let scene = Scene { stage: &screen.stage, colours: &screen.colours, free: painted.free, time_s };
        (wall.show(frame, &scene, painted), wall.software)
    }

    /// The device is gone, and with it every texture: the easel begins anew, so that it hands out all of them again.
    fn lose(&mut self) {
        self.figures.lost += 1;
        self.figures.paused();
        self.lost_in_a_row += 1;
        (self.wall, self.easel, self.changed) = (None, Easel::default(), true);
        if self.lost_in_a_row > MOST_LOST {
            self.give_up("its device was lost again and again; update its driver or check the card".to_owned());
        }
    }

    fn open_anew(&mut self) {
        match Wall::open(&self.window) {
            Ok(wall) => {
                self.adapter = (wall.name.clone(), wall.software);
                self.wall = Some(wall);
            }
            Err(why) => self.give_up(why),
        }
    }

    fn give_up(&self, why: String) {
        // Only the first reason counts.
        _ = self.fault.set(why);
        self.wanted.ending.ask();
    }
}

impl Eye for Glass {
    type Outfit = Look;

    fn put_on(&mut self, outfit: &mut Look) {
        std::mem::swap(&mut self.look, outfit);
        // Two sizes were those of whoever stood there before.
        (self.pair, self.changed) = (None, true);
    }

    fn look(&mut self, snapshot: &Snapshot) {
        self.draw(Some(snapshot));
    }
}
