//! Events of gestures, and the longest gap between frames that a gesture survives.

use super::trunk::Side;

/// A silence or a loss longer than this ends every gesture (ns): at 15 Hz four frames may be dropped.
pub(crate) const LONGEST_GAP_NS: u64 = 350_000_000;

toile_base::named! {
    /// What a hand did.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
    pub enum Gesture {
        /// A stroke to the shopper's own left.
        SwipeLeft = "swipe left",
        /// A stroke to the shopper's own right.
        SwipeRight = "swipe right",
        /// A stroke upwards.
        SwipeUp = "swipe up",
        /// A hand held out towards the mirror for a second.
        Confirm = "confirm",
        /// A closed hand opened.
        Opened = "opened",
        /// An open hand closed.
        Closed = "closed",
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
