//! The kiosk with a window: the guest's desk decides, the glass sees.

use toile_engine::clock::Clock;
use toile_engine::frame::Frame;
use toile_engine::pace::physics::Staged;

use super::look::Look;
use super::open::{self, Front, Wanted};
use super::{Asked, Glass};
use crate::exit::AppError;
use crate::guest::desk;
use crate::guest::model::Input;
use crate::guest::setup::Setup;
use crate::kiosk::report::KioskReport;
use crate::kiosk::{Given, Hosting, Seeing, serve};

/// Runs `toile kiosk` at a window.
///
/// # Errors
/// As without a window; where there is no display, or nothing that can draw on it.
pub fn seen(given: Given<'_>) -> Result<KioskReport, AppError> {
    let display = &given.config.display;
    let setup = Setup::new(given.config, given.clock.now_ns())?;
    let wanted = Wanted {
        windowed: given.args.windowed,
        height_mm: display.height_mm,
        begun: given.begun,
        clock: given.clock,
        motion: display.motion,
        first: setup.first(),
        ending: given.ending.clone(),
    };
    open::run(wanted, |front| {
        let Front { screens, mut asked, pairs, opening } = front;
        let asked = Box::new(move || asked.pop().map(told));
        let ends = desk::Front { screens, asked, pairs, draped: Look::draped };
        let host = move |played| -> Hosting<'_, Look> { Some(Box::new(setup.desk(ends, played))) };
        let words = given.words;
        let eye = |mannequin: &Frame| {
            let glass = opening.eye()?;
            if let Some(slow) = glass.slowness() {
                words.say(&slow);
            }
            Ok(glass.seeing(Look::of(mannequin)))
        };
        let (mut report, glass) = serve(given, Seeing { eye, stage, host })?;
        if let Some(mut glass) = glass {
            let (window, warnings) = Glass::report(&mut glass);
            report.window = Some(window);
            report.warnings.extend(warnings);
        }
        Ok(report)
    })
}

/// A frame that takes the stage, and what is drawn of it.
fn stage(frame: Frame) -> (Staged, Look) {
    let look = Look::of(&frame);
    (Staged::new(frame), look)
}

/// What was asked for, as the guest's machine is told.
fn told(asked: Asked) -> Input {
    match asked {
        Asked::Pressed(action) => Input::Pressed(action),
        Asked::Key(key) => Input::Key(key),
    }
}
