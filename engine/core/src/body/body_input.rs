//! What the parts of the body are posed from at one moment.

use super::ground::Ground;
use super::reliable_joints::ReliableJoints;
use super::smooth::fraction;

/// One moment: what is seen, of what floor, and how long after the last.
#[derive(Debug, Clone, Copy)]
pub struct BodyInput<'a> {
    /// Joints that are seen reliably (m).
    pub seen: &'a ReliableJoints,
    /// The floor that the feet stand on.
    pub ground: &'a Ground,
    /// Time since the last moment (s).
    pub dt: f32,
    /// Whether there was no last moment: everything is then taken over at once.
    pub first: bool,
}

impl BodyInput<'_> {
    /// Share of the way to go with a time constant (s).
    pub fn share(&self, tau: f32) -> f32 {
        if self.first { 1.0 } else { fraction(self.dt, tau) }
    }
}
