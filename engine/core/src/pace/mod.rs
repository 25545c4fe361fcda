//! Pace: the loop of sensor, physics and render threads, and what keeps it in time.
//!
//! Reads: frames of joints as they arrive. Writes: 120 snapshots a second, events, a recording.
//! Budget: 20 us a step beside the frame's own stages; nothing is allocated after the start.
//! Thread: each of the three is a [`Turn`] on a thread of its own, or all of them one after the other against a simulated
//! clock. Between them there is only a [`crate::relay`] or a bounded queue ([`queue`]).

pub mod blackbox;
pub mod change;
pub mod event;
pub mod governor;
pub mod intake;
pub mod physics;
pub mod queue;
pub mod render;
pub mod replay;
pub mod roles;
pub mod schedule;
pub mod sense;
pub mod simulate;
pub mod tape;
pub mod threads;

/// One of the loop's three lives: it does what is due and says when it wants to be called again.
pub trait Turn {
    /// Does what is due; gives the time of the next turn (ns), which may have passed already, or none where it has ended.
    fn turn(&mut self) -> Option<u64>;
}
