//! What to do when a display surface is anything but well: pure decisions, made from what happened.

use crate::image::Size;

/// What the attempt to get a picture from the surface came to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Event {
    /// A picture to draw on.
    Good,
    /// A picture to draw on, but the surface could be set up better.
    Suboptimal,
    /// No picture in time.
    Timeout,
    /// Nobody can see the window.
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

/// What to do about it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Step {
    /// Draw and present.
    Draw,
    /// Draw and present, then set the surface up again.
    DrawThenConfigure,
    /// Set the surface up and try at once.
    Configure,
    /// Leave this picture out; try again at the next one's time.
    Skip,
    /// Nothing can be seen: try again after a while, so that nothing is burnt on a dark window.
    Rest,
    /// Make a new surface on the same window and device.
    NewSurface,
    /// Make everything anew: instance, surface, device, renderer.
    NewDevice,
}

/// Set-ups in a row without a picture after which the surface is made anew.
const MOST_CONFIGURES: u32 = 3;

/// New surfaces in a row without a picture after which the device is made anew.
const MOST_SURFACES: u32 = 3;

/// Timeouts in a row after which the surface is set up again: a display that was switched off and on.
const MOST_TIMEOUTS: u32 = 30;

/// How the surface is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SurfaceState {
    size: Size,
    configured: bool,
    hidden: bool,
    configures: u32,
    surfaces: u32,
    timeouts: u32,
    device_lost: bool,
}

impl SurfaceState {
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
    pub fn before(&self) -> Option<Step> {
        if self.device_lost {
            return Some(Step::NewDevice);
        }
        if self.size.width == 0 || self.size.height == 0 || self.hidden {
            return Some(Step::Rest);
        }
        (!self.configured).then_some(Step::Configure)
    }

    /// The surface was set up.
    pub fn configured(&mut self) {
        self.configured = true;
        self.configures += 1;
    }

    /// What to do after the attempt to get a picture.
    pub fn after(&mut self, event: Event) -> Step {
        match event {
            Event::Good | Event::Suboptimal => {
                (self.configures, self.surfaces, self.timeouts) = (0, 0, 0);
                self.configured = event == Event::Good;
                if event == Event::Good { Step::Draw } else { Step::DrawThenConfigure }
            }
            Event::Timeout => {
                self.timeouts += 1;
                if self.timeouts >= MOST_TIMEOUTS {
                    self.timeouts = 0;
                    self.again()
                } else {
                    Step::Skip
                }
            }
            Event::Occluded => Step::Rest,
            Event::Outdated => self.again(),
            Event::Lost | Event::Refused => self.surface(),
            Event::DeviceLost => self.device(),
        }
    }

    /// Sets up again, or gives the surface up where that has not helped.
    fn again(&mut self) -> Step {
        self.configured = false;
        if self.configures >= MOST_CONFIGURES { self.surface() } else { Step::Configure }
    }

    fn surface(&mut self) -> Step {
        self.configured = false;
        if self.surfaces >= MOST_SURFACES { self.device() } else { Step::NewSurface }
    }

    fn device(&mut self) -> Step {
        self.device_lost = true;
        Step::NewDevice
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: Size = Size::new(540, 960);

    fn set_up() -> SurfaceState {
        let mut state = SurfaceState::new(SIZE);
        assert_eq!(state.before(), Some(Step::Configure));
        state.configured();
        assert_eq!(state.before(), None);
        state
    }

    #[test]
    fn a_surface_is_set_up_once_and_then_draws() {
        let mut state = set_up();
        for _ in 0..100 {
            assert_eq!((state.before(), state.after(Event::Good)), (None, Step::Draw));
        }
    }

    #[test]
    fn resizing_sets_up_again_and_a_minimised_window_rests() {
        let mut state = set_up();
        state.resized(SIZE);
        assert_eq!(state.before(), None, "the same size is no news");
        state.resized(Size::new(0, 960));
        assert_eq!(state.before(), Some(Step::Rest));
        state.resized(SIZE);
        assert_eq!(state.before(), Some(Step::Configure));
    }

    #[test]
    fn what_comes_out_of_hiding_is_set_up_again() {
        let mut state = set_up();
        state.hidden(true);
        assert_eq!(state.before(), Some(Step::Rest));
        state.hidden(false);
        assert_eq!(state.before(), Some(Step::Configure));
        let mut never = set_up();
        never.hidden(false);
        assert_eq!(never.before(), None);
    }

    #[test]
    fn a_suboptimal_picture_is_shown_and_the_next_is_better() {
        let mut state = set_up();
        assert_eq!(state.after(Event::Suboptimal), Step::DrawThenConfigure);
        assert_eq!(state.before(), Some(Step::Configure));
    }

    #[test]
    fn an_occluded_window_rests_without_being_made_anew() {
        let mut state = set_up();
        for _ in 0..1_000 {
            assert_eq!(state.after(Event::Occluded), Step::Rest);
        }
        assert_eq!((state.before(), state.after(Event::Good)), (None, Step::Draw));
    }

    #[test]
    fn a_display_that_was_off_for_long_is_set_up_again() {
        let mut state = set_up();
        let steps: Vec<Step> = (0..MOST_TIMEOUTS).map(|_| state.after(Event::Timeout)).collect();
        assert!(steps[..29].iter().all(|s| *s == Step::Skip));
        assert_eq!(steps[29], Step::Configure);
        state.configured();
        assert_eq!(state.after(Event::Good), Step::Draw);
    }

    /// Outdated over and over goes from set-ups to new surfaces to a new device, and always ends.
    #[test]
    fn what_does_not_help_is_not_done_for_ever() {
        let mut state = set_up();
        let (mut configures, mut surfaces) = (0, 0);
        for _ in 0..100 {
            match state.after(Event::Outdated) {
                Step::Configure => {
                    configures += 1;
                    state.configured();
                }
                Step::NewSurface => {
                    surfaces += 1;
                    state.surface_made();
                    state.configured();
                }
                Step::NewDevice => break,
                other => panic!("{other:?}"),
            }
        }
        assert_eq!(state.before(), Some(Step::NewDevice));
        assert!(configures > 3 && surfaces == MOST_SURFACES, "{configures} {surfaces}");
    }

    #[test]
    fn a_lost_surface_is_made_anew_and_a_lost_device_with_everything() {
        let mut state = set_up();
        assert_eq!(state.after(Event::Lost), Step::NewSurface);
        state.surface_made();
        assert_eq!(state.before(), Some(Step::Configure));
        state.configured();
        assert_eq!(state.after(Event::Good), Step::Draw);
        assert_eq!(state.after(Event::DeviceLost), Step::NewDevice);
        assert_eq!(state.before(), Some(Step::NewDevice));
        assert_eq!(SurfaceState::new(SIZE).before(), Some(Step::Configure), "everything anew begins anew");
    }
}
