//! Input: the window system's events as the render thread is told them.

use egui::{Pos2, pos2};
use winit::event::{ElementState, KeyEvent, MouseButton, MouseScrollDelta, TouchPhase, WindowEvent};
use winit::keyboard::{Key as Pressed, ModifiersState, NamedKey};

use super::paint::touch::Touch;
use crate::guest::model::Button;

/// Events that wait for the render thread: a second of a fast mouse.
pub const HEARD: usize = 1024;

/// The name of the bound, as warnings give it.
pub const HEARD_NAME: &str = "HEARD (engine/app/src/window/input.rs)";

/// Pixels of a notch of a mouse's wheel.
const NOTCH: f32 = 60.0;

/// What somebody did at the display.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Heard {
    /// A finger or the mouse.
    Touch(Touch),
    /// A key went down.
    Key(Button),
}

/// The window as it is: the latest value counts.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Frame {
    /// Its pixels; 0 where it is minimized.
    pub size: [u32; 2],
    /// Whether nothing of it is seen.
    pub hidden: bool,
}

/// Puts together what events mean.
#[derive(Debug, Default)]
pub struct Ears {
    /// Where the mouse is.
    mouse: Pos2,
    /// Whether its button is down.
    held: bool,
    /// The finger that counts: the first one down.
    finger: Option<u64>,
    modifiers: ModifiersState,
}

impl Ears {
    /// What an event means, if anything.
    pub fn hear(&mut self, event: &WindowEvent) -> Option<Heard> {
        match event {
            WindowEvent::CursorMoved { position, .. } => {
                self.mouse = pos2(position.x as f32, position.y as f32);
                self.held.then_some(Heard::Touch(Touch::Move(self.mouse)))
            }
            WindowEvent::MouseInput { state, button: MouseButton::Left, .. } => {
                self.held = *state == ElementState::Pressed;
                let touch = if self.held { Touch::Down(self.mouse) } else { Touch::Up(self.mouse) };
                Some(Heard::Touch(touch))
            }
            WindowEvent::CursorLeft { .. } | WindowEvent::Focused(false) => {
                self.finger = None;
                std::mem::take(&mut self.held).then_some(Heard::Touch(Touch::Cancel))
            }
            WindowEvent::MouseWheel { delta, .. } => {
                let down = match delta {
                    MouseScrollDelta::LineDelta(_, lines) => -lines * NOTCH,
                    MouseScrollDelta::PixelDelta(pixels) => -pixels.y as f32,
                };
                Some(Heard::Touch(Touch::Wheel(down)))
            }
            WindowEvent::Touch(touch) => self.finger(touch),
            WindowEvent::ModifiersChanged(modifiers) => {
                self.modifiers = modifiers.state();
                None
            }
            WindowEvent::KeyboardInput { event, is_synthetic: false, .. } => self.key(event),
            _ => None,
        }
    }

    fn finger(&mut self, touch: &winit::event::Touch) -> Option<Heard> {
        let at = pos2(touch.location.x as f32, touch.location.y as f32);
        if *self.finger.get_or_insert(touch.id) != touch.id {
            return None;
        }
        Some(Heard::Touch(match touch.phase {
            TouchPhase::Started => Touch::Down(at),
            TouchPhase::Moved => Touch::Move(at),
            TouchPhase::Ended => {
                self.finger = None;
                Touch::Up(at)
            }
            TouchPhase::Cancelled => {
                self.finger = None;
                Touch::Cancel
            }
        }))
    }

    fn key(&self, event: &KeyEvent) -> Option<Heard> {
        if event.state != ElementState::Pressed {
            return None;
        }
        let Pressed::Named(named) = &event.logical_key else { return None };
        let key = match named {
            NamedKey::Tab if self.modifiers.shift_key() => Button::BackTab,
            NamedKey::Tab => Button::Tab,
            NamedKey::ArrowLeft => Button::Left,
            NamedKey::ArrowRight => Button::Right,
            NamedKey::ArrowUp => Button::Up,
            NamedKey::ArrowDown => Button::Down,
            // A key that is held down presses once.
            NamedKey::Enter | NamedKey::Space if !event.repeat => Button::Enter,
            NamedKey::Escape if !event.repeat => Button::Escape,
            _ => return None,
        };
        Some(Heard::Key(key))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use winit::dpi::PhysicalPosition;
    use winit::event::{DeviceId, Touch as Finger};

    fn finger(id: u64, phase: TouchPhase, x: f64) -> WindowEvent {
        let location = PhysicalPosition::new(x, 20.0);
        WindowEvent::Touch(Finger { device_id: DeviceId::dummy(), phase, location, force: None, id })
    }

    fn mouse(state: ElementState) -> WindowEvent {
        WindowEvent::MouseInput { device_id: DeviceId::dummy(), state, button: MouseButton::Left }
    }

    #[test]
    fn the_first_finger_counts_until_it_is_lifted() {
        let mut ears = Ears::default();
        let at = |x: f32| pos2(x, 20.0);
        assert_eq!(ears.hear(&finger(7, TouchPhase::Started, 10.0)), Some(Heard::Touch(Touch::Down(at(10.0)))));
        assert_eq!(ears.hear(&finger(8, TouchPhase::Started, 90.0)), None, "a palm");
        assert_eq!(ears.hear(&finger(8, TouchPhase::Ended, 90.0)), None);
        assert_eq!(ears.hear(&finger(7, TouchPhase::Ended, 12.0)), Some(Heard::Touch(Touch::Up(at(12.0)))));
        assert_eq!(ears.hear(&finger(8, TouchPhase::Started, 5.0)), Some(Heard::Touch(Touch::Down(at(5.0)))));
        assert_eq!(ears.hear(&finger(8, TouchPhase::Cancelled, 5.0)), Some(Heard::Touch(Touch::Cancel)));
        assert_eq!(ears.hear(&WindowEvent::Focused(false)), None, "nothing is held");
    }

    #[test]
    fn the_mouse_is_told_while_its_button_is_down() {
        let mut ears = Ears::default();
        let moved =
            |x: f64| WindowEvent::CursorMoved { device_id: DeviceId::dummy(), position: PhysicalPosition::new(x, 1.0) };
        assert_eq!(ears.hear(&moved(3.0)), None);
        assert_eq!(ears.hear(&mouse(ElementState::Pressed)), Some(Heard::Touch(Touch::Down(pos2(3.0, 1.0)))));
        assert_eq!(ears.hear(&moved(4.0)), Some(Heard::Touch(Touch::Move(pos2(4.0, 1.0)))));
        assert_eq!(ears.hear(&WindowEvent::Focused(false)), Some(Heard::Touch(Touch::Cancel)));
        assert_eq!(ears.hear(&mouse(ElementState::Pressed)), Some(Heard::Touch(Touch::Down(pos2(4.0, 1.0)))));
        assert_eq!(ears.hear(&mouse(ElementState::Released)), Some(Heard::Touch(Touch::Up(pos2(4.0, 1.0)))));
    }
}
