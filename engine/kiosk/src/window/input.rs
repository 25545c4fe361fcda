//! Input: the window system's events as the render thread receives them.

use egui::{Pos2, pos2};
use winit::event::{ElementState, KeyEvent, MouseButton, MouseScrollDelta, TouchPhase, WindowEvent};
use winit::keyboard::{Key as Pressed, ModifiersState, NamedKey};

use super::paint::touch::TouchEvent;
use crate::visitor::model::NavigationKey;
use crate::visitor::screen::Action;

/// Events that wait for the render thread: a second of a fast mouse.
pub const INPUT_EVENTS: usize = 1024;

/// Name of this capacity in reports and warnings.
pub const INPUT_EVENTS_NAME: &str = "INPUT_EVENTS (queue of mouse, touch and keys)";

/// Pixels of a notch of a mouse's wheel.
const NOTCH: f32 = 60.0;

/// An input event at the display.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum InputEvent {
    /// A finger or the mouse.
    Touch(TouchEvent),
    /// A key went down.
    Key(NavigationKey),
    /// A key of a keypad went down.
    Typed(Action),
}

/// The window as it is: the latest value counts.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct WindowState {
    /// Its pixels; 0 where it is minimized.
    pub size: [u32; 2],
    /// Whether nothing of it is seen.
    pub hidden: bool,
}

/// Maps events of the window system to input events.
#[derive(Debug, Default)]
pub struct InputMapper {
    /// Where the mouse is.
    mouse: Pos2,
    /// Whether its button is down.
    held: bool,
    /// The finger that counts: the first one down.
    finger: Option<u64>,
    modifiers: ModifiersState,
}

impl InputMapper {
    /// The input event that an event of the window system comes to, if any.
    pub fn map(&mut self, event: &WindowEvent) -> Option<InputEvent> {
        match event {
            WindowEvent::CursorMoved { position, .. } => {
                self.mouse = pos2(position.x as f32, position.y as f32);
                self.held.then_some(InputEvent::Touch(TouchEvent::Move(self.mouse)))
            }
            WindowEvent::MouseInput { state, button: MouseButton::Left, .. } => {
                self.held = *state == ElementState::Pressed;
                let touch = if self.held { TouchEvent::Down(self.mouse) } else { TouchEvent::Up(self.mouse) };
                Some(InputEvent::Touch(touch))
            }
            WindowEvent::CursorLeft { .. } | WindowEvent::Focused(false) => {
                self.finger = None;
                std::mem::take(&mut self.held).then_some(InputEvent::Touch(TouchEvent::Cancel))
            }
            WindowEvent::MouseWheel { delta, .. } => {
                let down = match delta {
                    MouseScrollDelta::LineDelta(_, lines) => -lines * NOTCH,
                    MouseScrollDelta::PixelDelta(pixels) => -pixels.y as f32,
                };
                Some(InputEvent::Touch(TouchEvent::Wheel(down)))
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

    fn finger(&mut self, touch: &winit::event::Touch) -> Option<InputEvent> {
        let at = pos2(touch.location.x as f32, touch.location.y as f32);
        if *self.finger.get_or_insert(touch.id) != touch.id {
            return None;
        }
        Some(InputEvent::Touch(match touch.phase {
            TouchPhase::Started => TouchEvent::Down(at),
            TouchPhase::Moved => TouchEvent::Move(at),
            TouchPhase::Ended => {
                self.finger = None;
                TouchEvent::Up(at)
            }
            TouchPhase::Cancelled => {
                self.finger = None;
                TouchEvent::Cancel
            }
        }))
    }

    fn key(&self, event: &KeyEvent) -> Option<InputEvent> {
        if event.state != ElementState::Pressed {
            return None;
        }
        let named = match &event.logical_key {
            Pressed::Named(NamedKey::Backspace) => return Some(InputEvent::Typed(Action::DeleteDigit)),
            Pressed::Named(named) => named,
            Pressed::Character(text) => return typed(text).map(InputEvent::Typed),
            _ => return None,
        };
        let key = match named {
            NamedKey::Tab if self.modifiers.shift_key() => NavigationKey::BackTab,
            NamedKey::Tab => NavigationKey::Tab,
            NamedKey::ArrowLeft => NavigationKey::Left,
            NamedKey::ArrowRight => NavigationKey::Right,
            NamedKey::ArrowUp => NavigationKey::Up,
            NamedKey::ArrowDown => NavigationKey::Down,
            // A key that is held down presses once.
            NamedKey::Enter | NamedKey::Space if !event.repeat => NavigationKey::Enter,
            NamedKey::Escape if !event.repeat => NavigationKey::Escape,
            _ => return None,
        };
        Some(InputEvent::Key(key))
    }
}

/// What a character is on a keypad; either decimal mark is one.
fn typed(text: &str) -> Option<Action> {
    match text.as_bytes() {
        [digit @ b'0'..=b'9'] => Some(Action::Digit(digit - b'0')),
        [b'.' | b','] => Some(Action::Point),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use winit::dpi::PhysicalPosition;
    use winit::event::{DeviceId, Touch as WinitTouch};

    fn finger(id: u64, phase: TouchPhase, x: f64) -> WindowEvent {
        let location = PhysicalPosition::new(x, 20.0);
        WindowEvent::Touch(WinitTouch { device_id: DeviceId::dummy(), phase, location, force: None, id })
    }

    fn mouse(state: ElementState) -> WindowEvent {
        WindowEvent::MouseInput { device_id: DeviceId::dummy(), state, button: MouseButton::Left }
    }

    #[test]
    fn the_first_finger_counts_until_it_is_lifted() {
        let mut mapper = InputMapper::default();
        let at = |x: f32| pos2(x, 20.0);
        assert_eq!(
            mapper.map(&finger(7, TouchPhase::Started, 10.0)),
            Some(InputEvent::Touch(TouchEvent::Down(at(10.0))))
        );
        assert_eq!(mapper.map(&finger(8, TouchPhase::Started, 90.0)), None, "a palm");
        assert_eq!(mapper.map(&finger(8, TouchPhase::Ended, 90.0)), None);
        assert_eq!(mapper.map(&finger(7, TouchPhase::Ended, 12.0)), Some(InputEvent::Touch(TouchEvent::Up(at(12.0)))));
        assert_eq!(
            mapper.map(&finger(8, TouchPhase::Started, 5.0)),
            Some(InputEvent::Touch(TouchEvent::Down(at(5.0))))
        );
        assert_eq!(mapper.map(&finger(8, TouchPhase::Cancelled, 5.0)), Some(InputEvent::Touch(TouchEvent::Cancel)));
        assert_eq!(mapper.map(&WindowEvent::Focused(false)), None, "nothing is held");
    }

    #[test]
    fn digits_and_either_decimal_mark_are_keys_of_the_keypad() {
        assert_eq!(typed("7"), Some(Action::Digit(7)));
        assert_eq!([typed("."), typed(",")], [Some(Action::Point); 2]);
        assert_eq!([typed("a"), typed("12"), typed("")], [None; 3]);
    }

    #[test]
    fn the_mouse_is_told_while_its_button_is_down() {
        let mut mapper = InputMapper::default();
        let moved =
            |x: f64| WindowEvent::CursorMoved { device_id: DeviceId::dummy(), position: PhysicalPosition::new(x, 1.0) };
        assert_eq!(mapper.map(&moved(3.0)), None);
        assert_eq!(
            mapper.map(&mouse(ElementState::Pressed)),
            Some(InputEvent::Touch(TouchEvent::Down(pos2(3.0, 1.0))))
        );
        assert_eq!(mapper.map(&moved(4.0)), Some(InputEvent::Touch(TouchEvent::Move(pos2(4.0, 1.0)))));
        assert_eq!(mapper.map(&WindowEvent::Focused(false)), Some(InputEvent::Touch(TouchEvent::Cancel)));
        assert_eq!(
            mapper.map(&mouse(ElementState::Pressed)),
            Some(InputEvent::Touch(TouchEvent::Down(pos2(4.0, 1.0))))
        );
        assert_eq!(mapper.map(&mouse(ElementState::Released)), Some(InputEvent::Touch(TouchEvent::Up(pos2(4.0, 1.0)))));
    }
}
