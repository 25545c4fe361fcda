//! What is recognised, and the longest gap between frames that a gesture survives.

use super::trunk::Side;

/// A silence or a loss longer than this ends every gesture (ns): at 15 Hz four frames may be dropped.
pub(crate) const LONGEST_GAP_NS: u64 = 350_000_000;

/// What a hand did.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Gesture {
    /// A stroke to the shopper's own left.
    SwipeLeft,
    /// A stroke to the shopper's own right.
    SwipeRight,
    /// A stroke upwards.
    SwipeUp,
    /// A hand held out towards the mirror for a second.
    Confirm,
    /// A closed hand opened.
    Opened,
    /// An open hand closed.
    Closed,
}

impl Gesture {
    /// The word for reports.
    pub const fn name(self) -> &'static str {
        match self {
            Self::SwipeLeft => "swipe left",
            Self::SwipeRight => "swipe right",
            Self::SwipeUp => "swipe up",
            Self::Confirm => "confirm",
            Self::Opened => "opened",
            Self::Closed => "closed",
        }
    }
}

/// A gesture that has been recognised.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct GestureEvent {
    /// When it was recognised (ns), the time of the frame.
    pub time_ns: u64,
    /// Whose hand: the shopper's own side.
    pub side: Side,
    /// The gesture that was recognised.
    pub gesture: Gesture,
}

/// The events of one frame: at most one stroke and one grip a hand.
pub type GestureEvents = [Option<GestureEvent>; 4];
