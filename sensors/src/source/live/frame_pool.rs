//! A pool of depth images: made at load, lent out, and filled again after the last borrower has dropped them.

use std::sync::Arc;

use glam::Affine3A;

use toile_base::frame::{DepthFrame, Intrinsics};

/// Depth images of a camera: on their way to the tracker, to the loop, and waiting in the queue of an observer of the sensor.
pub const POOL_FRAMES: usize = 16;

/// The images.
#[derive(Debug)]
pub struct FramePool {
    frames: Vec<Arc<DepthFrame>>,
    /// Images for which there was no room, and which were lost.
    pub lost: u64,
}

impl FramePool {
    /// A pool for images of a camera, with room for `kept` images beyond those on their way. Called at load: it allocates,
    /// and the system gives the memory of an image when it is filled for the first time.
    pub fn new(intrinsics: Intrinsics, kept: usize) -> Self {
        let empty = || {
            let depth_mm = vec![0; intrinsics.pixels()].into_boxed_slice();
            Arc::new(DepthFrame { time_ns: 0, intrinsics, camera_to_world: Affine3A::IDENTITY, depth_mm })
        };
        Self { frames: (0..POOL_FRAMES + kept).map(|_| empty()).collect(), lost: 0 }
    }

    /// Fills a free image and lends it; none, which is counted, if all are lent. The first that is free is taken, so
    /// that memory is touched for as many as are in use.
    pub fn fill(&mut self, fill: impl FnOnce(&mut DepthFrame)) -> Option<Arc<DepthFrame>> {
        for frame in &mut self.frames {
            if let Some(free) = Arc::get_mut(frame) {
                fill(free);
                return Some(frame.clone());
            }
        }
        self.lost += 1;
        None
    }
}

impl FramePool {
    /// Wipes all free images.
    pub fn wipe(&mut self) {
        for free in self.frames.iter_mut().filter_map(Arc::get_mut) {
            // One that was never filled is left alone: the system has given no memory for it.
            if free.time_ns != 0 {
                free.depth_mm.fill(0);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dropped_images_come_back_and_lost_ones_are_counted() {
        let mut pool = FramePool::new(Intrinsics { width: 2, height: 1, fx: 1.0, fy: 1.0, cx: 0.0, cy: 0.0 }, 0);
        let mut lent: Vec<_> = (0..POOL_FRAMES as u64).map(|i| pool.fill(|f| f.time_ns = i).unwrap()).collect();
        assert!(pool.fill(|_| ()).is_none() && pool.lost == 1);
        let storage = lent.remove(3).depth_mm.as_ptr();
        let again = pool.fill(|f| f.time_ns = 99).unwrap();
        assert_eq!((again.depth_mm.as_ptr(), again.time_ns, lent[0].time_ns), (storage, 99, 0));
    }

    #[test]
    fn free_images_are_wiped_and_lent_ones_are_not() {
        let mut pool = FramePool::new(Intrinsics { width: 1, height: 1, fx: 1.0, fy: 1.0, cx: 0.0, cy: 0.0 }, 1);
        let kept = [1, 2].map(|i| {
            pool.fill(|frame| {
                frame.time_ns = i;
                frame.depth_mm[0] = 1_234;
            })
        });
        let [kept, gone] = kept.map(Option::unwrap);
        drop(gone);
        pool.wipe();
        let mut seen = 1;
        pool.fill(|frame| seen = frame.depth_mm[0]);
        assert_eq!((seen, kept.depth_mm[0]), (0, 1_234));
    }
}
