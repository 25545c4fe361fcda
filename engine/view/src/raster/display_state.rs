//! The state of a display surface: which action each event (outdated, lost, hidden) calls for, without any graphics call.

use crate::image::Size;

/// Outcome of acquiring a picture from the surface.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum SurfaceEvent {
    /// A picture to draw on.
    Good,
    /// A picture to draw on, but the surface could be set up better.
    Suboptimal,
    /// No picture in time.
    Timeout,
    /// The window is hidden.
    Occluded,
    /// The window is not as the surface was set up for.
    Outdated,
    /// The surface is gone; the window may still be there.
    Lost,
    /// The driver refused the set-up.
    Refused,
    /// The device is gone.
    DeviceLost,
}

/// The action that follows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum SurfaceAction {
    /// Draw and present.
    Draw,
    /// Draw and present, then set the surface up again.
    DrawThenConfigure,
    /// Set the surface up and try at once.
    Configure,
    /// Leave this picture out; try again at the next one's time.
    Skip,
    /// The window is hidden: try again after a while, to spare power.
    Rest,
    /// Make a new surface on the same window and device.
    NewSurface,
    /// Create everything again: instance, surface, device, renderer.
    NewDevice,
}

/// Set-ups in a row without a picture after which a new surface is made.
const MOST_CONFIGURES: u32 = 3;

/// New surfaces in a row without a picture after which a new device is made.
const MOST_SURFACES: u32 = 3;

/// Timeouts in a row after which the surface is set up again: a display that was switched off and on.
const MOST_TIMEOUTS: u32 = 30;

/// State of the surface.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct DisplayState {
    size: Size,
    configured: bool,
    hidden: bool,
    configures: u32,
    surfaces: u32,
    timeouts: u32,
    device_lost: bool,
}

impl DisplayState {
    /// A surface that has not been set up.
    pub const fn new(size: Size) -> Self {
        Self { size, configured: false, hidden: false, configures: 0, surfaces: 0, timeouts: 0, device_lost: false }
    }

    /// The size that the surface is set up for (pixels).
    pub const fn size(&self) -> Size {
        self.size
    }

    /// The window has another size; 0 in either is a window that is minimised.
    pub fn resized(&mut self, size: Size) {
        self.configured &= self.size == size;
        self.size = size;
    }

    /// The window system says whether the window can be seen.
    pub fn hidden(&mut self, hidden: bool) {
        // What was hidden may come back on another display.
        self.configured &= !self.hidden || hidden;
        self.hidden = hidden;
    }

    /// A new surface stands on the window.
    pub fn surface_made(&mut self) {
        self.configured = false;
        self.surfaces += 1;
        self.configures = 0;
    }

    /// Before a picture: what has to be done first. `None` is nothing; then a picture is asked for.
    pub fn before(&self) -> Option<SurfaceAction> {
        if self.device_lost {
            return Some(SurfaceAction::NewDevice);
        }
        if self.size.width == 0 || self.size.height == 0 || self.hidden {
            return Some(SurfaceAction::Rest);
        }
        (!self.configured).then_some(SurfaceAction::Configure)
    }

    /// The surface was set up.
    pub fn configured(&mut self) {
        self.configured = true;
        self.configures += 1;
    }

    /// What to do after the attempt to get a picture.
    pub fn after(&mut self, event: SurfaceEvent) -> SurfaceAction {
        match event {
            SurfaceEvent::Good | SurfaceEvent::Suboptimal => {
                (self.configures, self.surfaces, self.timeouts) = (0, 0, 0);
                self.configured = event == SurfaceEvent::Good;
                if event == SurfaceEvent::Good { SurfaceAction::Draw } else { SurfaceAction::DrawThenConfigure }
            }
            SurfaceEvent::Timeout => {
                self.timeouts += 1;
                if self.timeouts >= MOST_TIMEOUTS {
                    self.timeouts = 0;
                    self.again()
                } else {
                    SurfaceAction::Skip
                }
            }
            SurfaceEvent::Occluded => SurfaceAction::Rest,
            SurfaceEvent::Outdated => self.again(),
            SurfaceEvent::Lost | SurfaceEvent::Refused => self.surface(),
            SurfaceEvent::DeviceLost => self.device(),
        }
    }

    /// Sets up again, or gives the surface up where that has not helped.
    fn again(&mut self) -> SurfaceAction {
        self.configured = false;
        if self.configures >= MOST_CONFIGURES { self.surface() } else { SurfaceAction::Configure }
    }

    fn surface(&mut self) -> SurfaceAction {
        self.configured = false;
        if self.surfaces >= MOST_SURFACES { self.device() } else { SurfaceAction::NewSurface }
    }

    fn device(&mut self) -> SurfaceAction {
        self.device_lost = true;
        SurfaceAction::NewDevice
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: Size = Size::new(540, 960);

    fn set_up() -> DisplayState {
        let mut state = DisplayState::new(SIZE);
        assert_eq!(state.before(), Some(SurfaceAction::Configure));
        state.configured();
        assert_eq!(state.before(), None);
        state
    }

    #[test]
    fn a_surface_is_set_up_once_and_then_draws() {
        let mut state = set_up();
        for _ in 0..100 {
            assert_eq!((state.before(), state.after(SurfaceEvent::Good)), (None, SurfaceAction::Draw));
        }
    }

    #[test]
    fn resizing_sets_up_again_and_a_minimised_window_rests() {
        let mut state = set_up();
        state.resized(SIZE);
        assert_eq!(state.before(), None, "the same size is no news");
        state.resized(Size::new(0, 960));
        assert_eq!(state.before(), Some(SurfaceAction::Rest));
        state.resized(SIZE);
        assert_eq!(state.before(), Some(SurfaceAction::Configure));
    }

    #[test]
    fn what_comes_out_of_hiding_is_set_up_again() {
        let mut state = set_up();
        state.hidden(true);
        assert_eq!(state.before(), Some(SurfaceAction::Rest));
        state.hidden(false);
        assert_eq!(state.before(), Some(SurfaceAction::Configure));
        let mut never = set_up();
        never.hidden(false);
        assert_eq!(never.before(), None);
    }

    #[test]
    fn a_suboptimal_picture_is_shown_and_the_next_is_better() {
        let mut state = set_up();
        assert_eq!(state.after(SurfaceEvent::Suboptimal), SurfaceAction::DrawThenConfigure);
        assert_eq!(state.before(), Some(SurfaceAction::Configure));
    }

    #[test]
    fn an_occluded_window_rests_without_being_made_anew() {
        let mut state = set_up();
        for _ in 0..1_000 {
            assert_eq!(state.after(SurfaceEvent::Occluded), SurfaceAction::Rest);
        }
        assert_eq!((state.before(), state.after(SurfaceEvent::Good)), (None, SurfaceAction::Draw));
    }

    #[test]
    fn a_display_that_was_off_for_long_is_set_up_again() {
        let mut state = set_up();
        let steps: Vec<SurfaceAction> = (0..MOST_TIMEOUTS).map(|_| state.after(SurfaceEvent::Timeout)).collect();
        assert!(steps[..29].iter().all(|s| *s == SurfaceAction::Skip));
        assert_eq!(steps[29], SurfaceAction::Configure);
        state.configured();
        assert_eq!(state.after(SurfaceEvent::Good), SurfaceAction::Draw);
    }

    /// Outdated over and over goes from set-ups to new surfaces to a new device, and always ends.
    #[test]
    fn what_does_not_help_is_not_done_for_ever() {
        let mut state = set_up();
        let (mut configures, mut surfaces) = (0, 0);
        for _ in 0..100 {
            match state.after(SurfaceEvent::Outdated) {
                SurfaceAction::Configure => {
                    configures += 1;
                    state.configured();
                }
                SurfaceAction::NewSurface => {
                    surfaces += 1;
                    state.surface_made();
                    state.configured();
                }
                SurfaceAction::NewDevice => break,
                other => panic!("{other:?}"),
            }
        }
        assert_eq!(state.before(), Some(SurfaceAction::NewDevice));
        assert!(configures > 3 && surfaces == MOST_SURFACES, "{configures} {surfaces}");
    }

    #[test]
    fn a_lost_surface_is_made_anew_and_a_lost_device_with_everything() {
        let mut state = set_up();
        assert_eq!(state.after(SurfaceEvent::Lost), SurfaceAction::NewSurface);
        state.surface_made();
        assert_eq!(state.before(), Some(SurfaceAction::Configure));
        state.configured();
        assert_eq!(state.after(SurfaceEvent::Good), SurfaceAction::Draw);
        assert_eq!(state.after(SurfaceEvent::DeviceLost), SurfaceAction::NewDevice);
        assert_eq!(state.before(), Some(SurfaceAction::NewDevice));
        assert_eq!(DisplayState::new(SIZE).before(), Some(SurfaceAction::Configure), "everything anew begins anew");
    }
}
