//! What makes joints more believable before the engine poses a body with them.

use crate::frame::Joints;

/// A filter of joints, frame by frame, with a memory of a fixed size and no allocation.
pub trait Filter {
    /// Takes a frame and returns the filtered one of the same time. Frames may come at any interval, twice, or late, and
    /// may hold positions that are NaN. The result is finite wherever its confidence is not 0. Hand states pass through.
    fn push(&mut self, frame: &Joints) -> Joints;

    /// Forgets the shopper.
    fn reset(&mut self);
}
