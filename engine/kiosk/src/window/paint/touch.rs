//! Touch: presses, scrolls and turns by a finger or the mouse. One finger at a time counts; a second one is a palm.

use egui::{Pos2, Vec2};

use super::layout::ScreenLayout;
use super::shapes::TouchFeedback;
use crate::visitor::screen::{Action, BodyView, Screen};

/// How far a finger may wander and still press (in heights of a line).
const STILL: f32 = 0.8;

/// Turns of a drag over the whole display's width (eighths of a circle).
const EIGHTHS: f32 = 8.0;

/// What a finger or the mouse did, in pixels from the display's upper left corner.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum TouchEvent {
    /// The finger went down here.
    Down(Pos2),
    /// The finger moved to here.
    Move(Pos2),
    /// Up: what is under it is pressed, where it went down.
    Up(Pos2),
    /// It was taken away by the system: nothing is pressed.
    Cancel,
    /// A wheel, pixels down.
    Wheel(f32),
}

/// A finger that is down.
#[derive(Debug, Clone, Copy, PartialEq)]
struct ActiveTouch {
    began: Pos2,
    at: Pos2,
    on: Option<usize>,
    /// The scroll when it came down.
    scrolled: f32,
    /// Whether it wandered.
    drags: bool,
    /// Eighths that it has turned so far.
    turned: i32,
}

/// Follows one finger, or the mouse, from down to up.
#[derive(Debug, Clone, Default)]
pub struct TouchTracker {
    down: Option<ActiveTouch>,
    scrolled: f32,
    /// The control that the view has followed last, by which a new focus is noticed.
    focus: Option<(usize, usize)>,
}

impl TouchTracker {
    /// State of the touch as it is painted.
    pub fn feedback(&self) -> TouchFeedback {
        let pressed = self.down.filter(|d| !d.drags).and_then(|d| d.on);
        TouchFeedback { pressed, scrolled: self.scrolled }
    }

    /// Keeps what has the focus in sight when the focus moves, and the scroll within a layout that has changed.
    pub fn follow(&mut self, laid: &ScreenLayout, screen: &Screen) {
        let focus = (screen.focus, screen.controls.len());
        if self.focus != Some(focus) {
            self.focus = Some(focus);
            self.scrolled = laid.scroll_to(screen.focus, self.scrolled);
        }
        self.scrolled = self.scrolled.clamp(0.0, laid.scrolls);
    }

    /// Takes in what it did; gives what that asks for.
    pub fn touch(&mut self, touch: TouchEvent, laid: &ScreenLayout, screen: &Screen) -> Option<Action> {
        match touch {
            TouchEvent::Down(at) => {
                let on = laid.hit(at, self.scrolled);
                let scrolled = self.scrolled;
                self.down = Some(ActiveTouch { began: at, at, on, scrolled, drags: false, turned: 0 });
                None
            }
            TouchEvent::Move(at) => self.moved(at, laid, screen),
            TouchEvent::Up(at) => {
                let down = self.down.take()?;
                let same = laid.hit(at, self.scrolled) == down.on && !down.drags;
                same.then(|| screen.controls.get(down.on?).map(|c| c.action))?
            }
            TouchEvent::Cancel => {
                self.down = None;
                None
            }
            TouchEvent::Wheel(down) => {
                self.scrolled = (self.scrolled + down).clamp(0.0, laid.scrolls);
                None
            }
        }
    }

    fn moved(&mut self, at: Pos2, laid: &ScreenLayout, screen: &Screen) -> Option<Action> {
        let down = self.down.as_mut()?;
        let way: Vec2 = at - down.began;
        down.at = at;
        let on_panel = laid.panel.contains(down.began);
        // On a button that cannot scroll away a finger may wander as it likes.
        down.drags |= way.length() > laid.look.body * STILL && (laid.scrolls > 0.0 || !on_panel);
        if !down.drags {
            return None;
        }
        if on_panel {
            self.scrolled = (down.scrolled - way.y).clamp(0.0, laid.scrolls);
            return None;
        }
        let turns = matches!(screen.body_view, BodyView::Shopper { .. } | BodyView::Two { .. });
        let eighths = (way.x / laid.look.display[0] * EIGHTHS).trunc() as i32;
        let by = (eighths - down.turned).clamp(-1, 1);
        down.turned += by;
        (turns && by != 0).then_some(Action::Turn(by as i8))
    }
}
