//! A recording that is played in time as if it were a camera, again and again: for a demonstration, and for tests.

use std::path::Path;
use std::thread;
use std::time::{Duration, Instant};

use super::error::CameraError;
use super::live_camera::{Arrival, CameraFrame, CameraInfo, CameraOptions, LiveCamera};
use crate::clock::SECOND_NS;
use crate::frame::DepthFrame;
use crate::source::camera::Camera;
use crate::source::{self, OpenOptions};

/// Frames a second that are assumed of a single image (Hz).
const ASSUMED_HZ: f32 = 30.0;

/// Depth of a recording, as a camera gives it.
pub(super) struct RecordedCamera {
    info: CameraInfo,
    depth: Vec<DepthFrame>,
    /// From the first frame of a round to the first of the next (ns).
    round_ns: u64,
    next: u64,
    begun: Instant,
}

impl RecordedCamera {
    pub fn open(path: &str, options: &CameraOptions) -> Result<Self, CameraError> {
        let session = source::open(Path::new(path), &OpenOptions::default());
        let session = session.map_err(|e| CameraError::Recording(e.to_string()))?;
        let first = session.depth.first().ok_or_else(|| {
            CameraError::Recording(format!(
                "{path} holds no depth, so that it cannot be played as a camera; give another"
            ))
        })?;
        let camera = Camera { quarter_turns: options.quarter_turns, ..Camera::pinhole(first.intrinsics) };
        let last_ns = session.depth.last().map_or(0, |f| f.time_ns - first.time_ns);
        let gap = if session.depth.len() > 1 {
            last_ns / (session.depth.len() as u64 - 1)
        } else {
            (SECOND_NS as f32 / ASSUMED_HZ) as u64
        };
        let info = CameraInfo {
            device: format!("recording {}", session.name),
            camera,
            rate_hz: SECOND_NS as f32 / gap.max(1) as f32,
            placed: (options.quarter_turns == 0).then_some(first.camera_to_world),
        };
        Ok(Self { info, round_ns: last_ns + gap.max(1), depth: session.depth, next: 0, begun: Instant::now() })
    }

    /// The next frame, and its time since the begin (ns).
    fn due(&self) -> (&DepthFrame, u64) {
        let count = self.depth.len() as u64;
        let frame = &self.depth[(self.next % count) as usize];
        (frame, self.next / count * self.round_ns + frame.time_ns - self.depth[0].time_ns)
    }
}

impl LiveCamera for RecordedCamera {
    fn info(&self) -> &CameraInfo {
        &self.info
    }

    fn read(&mut self, frame: &mut CameraFrame, patience: Duration) -> Result<Arrival, CameraError> {
        frame.clear();
        let (image, due_ns) = self.due();
        let wait = Duration::from_nanos(due_ns).saturating_sub(self.begun.elapsed());
        thread::sleep(wait.min(patience));
        if wait > patience {
            return Ok(Arrival::Nothing);
        }
        frame.device_ns = due_ns;
        frame.depth.extend_from_slice(&image.depth_mm);
        self.next += 1;
        Ok(Arrival::Frame)
    }
}
