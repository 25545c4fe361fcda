//! Depth images that go round: made at load, lent out, and filled again once nobody has them any more.

use std::sync::Arc;

use glam::Affine3A;

use crate::frame::{DepthFrame, Intrinsics};

/// Depth images of a camera: on their way to the tracker, to the loop, and waiting in the queue of whoever observes the sensor.
pub const POOL_FRAMES: usize = 16;

/// Name of this capacity in reports and warnings.
pub const POOL_FRAMES_NAME: &str = "POOL_FRAMES (depth images of a camera on their way)";

/// The images.
#[derive(Debug)]
pub struct FramePool {
    frames: Vec<Arc<DepthFrame>>,
    next: usize,
    /// Images for which there was no room, and which were lost.
    pub lost: u64,
}

impl FramePool {
    /// For images of a camera. Called at load: it allocates.
    pub fn new(intrinsics: Intrinsics) -> Self {
        let empty = || {
            let depth_mm = vec![0; intrinsics.pixels()].into_boxed_slice();
            Arc::new(DepthFrame { time_ns: 0, intrinsics, camera_to_world: Affine3A::IDENTITY, depth_mm })
        };
        Self { frames: (0..POOL_FRAMES).map(|_| empty()).collect(), next: 0, lost: 0 }
    }

    /// Fills an image that nobody has, and lends it; none, which is counted, where all are lent.
    pub fn fill(&mut self, fill: impl FnOnce(&mut DepthFrame)) -> Option<Arc<DepthFrame>> {
        let count = self.frames.len();
        for step in 0..count {
            let at = (self.next + step) % count;
            if let Some(frame) = Arc::get_mut(&mut self.frames[at]) {
                fill(frame);
                self.next = (at + 1) % count;
                return Some(self.frames[at].clone());
            }
        }
        self.lost += 1;
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_image_comes_back_once_nobody_has_it_and_what_finds_no_room_is_counted() {
        let mut pool = FramePool::new(Intrinsics { width: 2, height: 1, fx: 1.0, fy: 1.0, cx: 0.0, cy: 0.0 });
        let mut lent: Vec<_> = (0..POOL_FRAMES as u64).map(|i| pool.fill(|f| f.time_ns = i).unwrap()).collect();
        assert!(pool.fill(|_| ()).is_none() && pool.lost == 1);
        let storage = lent.remove(3).depth_mm.as_ptr();
        let again = pool.fill(|f| f.time_ns = 99).unwrap();
        assert_eq!((again.depth_mm.as_ptr(), again.time_ns, lent[0].time_ns), (storage, 99, 0));
    }
}
