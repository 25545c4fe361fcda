//! Frame loop: the loop of sensor, physics and render threads, and the quality control that keeps it in time.
//!
//! It may add 20 us a step to the world's own stages, and allocates nothing after the start. Each of the three loops is a
//! [`ThreadLoop`] on a thread of its own, or all of them run one after the other against a simulated clock. They share only a
//! [`crate::triple_buffer`] or a bounded queue ([`queue`]).

pub mod event;
pub mod flight_recorder;
pub mod handover;
pub mod loop_meters;
pub mod motion_input;
pub mod physics_thread;
pub mod quality_control;
pub mod queue;
pub mod recording;
pub mod render_thread;
pub mod replay;
pub mod schedule;
pub mod sensor_thread;
pub mod simulate;
pub mod thread_roles;
pub mod threads;

/// One of the loop's three threads: it does what is due and says when it wants to be called again.
pub trait ThreadLoop {
    /// Opens what belongs to the calling thread. Called once on the loop's thread, before its first turn.
    fn begin(&mut self) {}

    /// Does what is due; gives the time of the next turn (ns), which may have passed already, or none where it has ended.
    fn run_due(&mut self) -> Option<u64>;
}
