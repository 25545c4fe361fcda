//! Messages: the inputs of the visitor's model and its effects, with the times that it keeps.

use toile_sensors::source::live::CameraState;
use toile_track::gesture::Gesture;
use toile_track::tape_readings::TapeReadings;

use super::own_face::FaceTrouble;
use super::picture_store::OfferedPicture;
use super::presence::Presence;
use super::screen::Action;
use super::size_fit::VisitorMeasures;
use super::texts::Language;
use super::wardrobe::Outfit;
use crate::service::session;

/// Effects of one input, at most.
const EFFECTS: usize = 8;

/// The effects of one input.
pub type Effects = heapless::Vec<Effect, EFFECTS>;

/// Times of a visit (ns).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct VisitTimes {
    /// Stepping in, stepping out, wiping.
    pub session: session::SessionTimes,
    /// They stand as they should for so long before measuring begins.
    pub ready_ns: u64,
    /// Who has pressed something at the display is given so long to walk back.
    pub walk_ns: u64,
    /// Measuring takes so long, without what comes of it.
    pub measure_ns: u64,
    /// Time that another person is in view before they are asked who they are.
    pub stranger_ns: u64,
    /// Who is asked answers within that, or everything is forgotten.
    pub answer_ns: u64,
    /// Who touched something is there for so long, seen or not.
    pub touch_ns: u64,
    /// Time to wait for a visitor who has touched something while no person is in view.
    pub begin_ns: u64,
    /// A picture is kept for so long.
    pub picture_ns: u64,
}

const SECOND: u64 = 1_000_000_000;

impl VisitTimes {
    /// The usual times, around those that are configured.
    pub const fn usual(session: session::SessionTimes, measure_ns: u64, picture_ns: u64) -> Self {
        Self {
            session,
            ready_ns: 3 * SECOND / 2,
            walk_ns: 4 * SECOND,
            measure_ns,
            stranger_ns: SECOND,
            answer_ns: 20 * SECOND,
            touch_ns: 10 * SECOND,
            begin_ns: 30 * SECOND,
            picture_ns,
        }
    }
}

/// How every visit begins.
#[derive(Debug, Clone, PartialEq)]
pub struct VisitDefaults {
    /// Times of a visit.
    pub times: VisitTimes,
    /// The language before the visitor chooses one.
    pub language: Language,
    /// Whether type is large before the visitor chooses.
    pub large: bool,
    /// What every visitor wears first, by name, inner first; those that the wardrobe does not have are left out.
    pub wear: Vec<String>,
    /// The size that every visitor wears first, where a garment is made in it; else each gets the one that fits.
    pub size: Option<String>,
    /// Measures by tape that are known beforehand, for a fitting by appointment.
    pub tape: TapeReadings,
    /// Whether anything moves by itself.
    pub motion: bool,
    /// Whether shoppers see themselves first, where a camera's picture can be shown.
    pub own_picture: bool,
}

/// A key of a keyboard, or of a row of buttons.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum NavigationKey {
    /// To the next control.
    Tab,
    /// To the control before: Tab with Shift.
    BackTab,
    /// To the control on the left, or before.
    Left,
    /// To the control on the right, or after.
    Right,
    /// To the control above, or before.
    Up,
    /// To the control below, or after.
    Down,
    /// Presses what has the focus.
    Enter,
    /// Goes back a page.
    Escape,
}

/// An input of the model. Replies carry the number of the effect; a reply that is no longer awaited is ignored.
#[derive(Debug, Clone, PartialEq)]
pub enum Input {
    /// Time has passed: timers are looked at.
    Tick,
    /// What is seen; it holds until the next.
    Presence(Presence),
    /// How the camera stands; it holds until the next. Without a live camera it never comes.
    Camera(CameraState),
    /// The camera's picture can be shown, and what became of the last ([`super::plain::code`]); it holds until the next. Without a camera
    /// whose pictures can be shown it never comes.
    OwnPicture(u8),
    /// A control was pressed by finger or mouse. One that is not on the page is ignored.
    Pressed(Action),
    /// A navigation key was pressed.
    Key(NavigationKey),
    /// A key of a keypad was pressed at a keyboard. One that is not on the page is ignored.
    Typed(Action),
    /// A gesture was recognised.
    Gesture(Gesture),
    /// A person was measured.
    Measured(u32, Box<VisitorMeasures>),
    /// A body of theirs stands dressed.
    Dressed(u32),
    /// Both sizes are draped.
    Draped(u32),
    /// The picture is taken.
    PictureTaken(u32, OfferedPicture),
    /// The shopper's face was taken and is ready for the dressing worker, or why not.
    FaceTaken(u32, Result<(), FaceTrouble>),
    /// What was asked for cannot be done.
    Failed(u32),
}

/// An effect, which others carry out. Each that is replied to has a number.
#[derive(Debug, Clone, PartialEq)]
pub enum Effect {
    /// Measure the person in view; [`Input::Measured`].
    Measure {
        /// Number of the effect, which its reply carries.
        number: u32,
        /// Whether they sit: nothing is to be taken from their legs and hips.
        seated: bool,
    },
    /// Measure them again with all that was seen since, of a turn; [`Input::Measured`].
    MeasureTurn {
        /// Number of the effect, which its reply carries.
        number: u32,
    },
    /// Dress a body of the measures that were taken and show it; [`Input::Dressed`].
    Dress {
        /// Number of the effect, which its reply carries.
        number: u32,
        /// Garments and sizes, inner first.
        outfit: Outfit,
    },
    /// Drape the outfit in two sizes of one garment, for both to be shown; [`Input::Draped`].
    DrapeTwo {
        /// Number of the effect, which its reply carries.
        number: u32,
        /// The outfit on the left and the one on the right.
        outfits: Box<[Outfit; 2]>,
    },
    /// Take a picture of the dressed body; [`Input::PictureTaken`].
    Snap {
        /// Number of the effect, which its reply carries.
        number: u32,
        /// Garments and sizes that the body wears.
        outfit: Outfit,
        /// From where it is looked at (rad).
        yaw: f32,
    },
    /// Take the shopper's face from the next picture; [`Input::FaceTaken`].
    TakeFace {
        /// Number of the effect, which its reply carries.
        number: u32,
        /// What the body wears, for whom its drawing may be.
        outfit: Outfit,
    },
    /// Show the mannequin at once, without a face: another person is in view, or the shopper takes their face away.
    Hide,
    /// The shopper has left: nothing of them is to stay anywhere.
    Forget,
}
