//! Number and times of the exported frames.

/// The frames of a motion, evenly spaced from time 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FrameRate {
    /// How many.
    pub frames: usize,
    /// Frames a second.
    pub hz: f64,
}

impl FrameRate {
    /// When a frame is (s).
    pub fn time(&self, frame: usize) -> f32 {
        (frame as f64 / self.hz) as f32
    }
}
