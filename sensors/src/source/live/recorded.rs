//! A recording that is played in time as if it were a camera, again and again: for a demonstration, and for tests. It holds no picture of
//! a person: where colour is asked for, its depth is shown as one, shaded as if a lamp stood beside the camera.

use std::path::Path;
use std::thread;
use std::time::{Duration, Instant};

use super::error::CameraError;
use super::live_camera::{Arrival, CameraFrame, CameraInfo, CameraOptions, ColourImage, ColourPlace, LiveCamera};
use crate::source::camera::DepthCamera;
use crate::source::{self, OpenOptions};
use toile_base::clock::SECOND_NS;
use toile_base::frame::DepthFrame;

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
    /// Whether depth is shown as a picture.
    colour: bool,
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
        let camera = DepthCamera { quarter_turns: options.quarter_turns, ..DepthCamera::pinhole(first.intrinsics) };
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
            colour: ColourPlace::AsDepth,
        };
        Ok(Self {
            info,
            round_ns: last_ns + gap.max(1),
            depth: session.depth,
            next: 0,
            begun: Instant::now(),
            colour: options.colour,
        })
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
        if self.colour {
            shade(image, &mut frame.colour);
        }
        self.next += 1;
        Ok(Arrival::Frame)
    }
}

/// Brightness of what faces the lamp, and what nothing was measured of.
const LIGHT: f32 = 205.0;
const UNSEEN: u8 = 70;

/// A picture of a depth image: each pixel as bright as the surface there faces a lamp above the camera, in the tone of wood.
fn shade(depth: &DepthFrame, picture: &mut ColourImage) {
    let k = &depth.intrinsics;
    let (width, height) = (k.width as usize, k.height as usize);
    (picture.width, picture.height) = (k.width, k.height);
    picture.rgb.clear();
    let at = |u: usize, v: usize| f32::from(depth.depth_mm[v.min(height - 1) * width + u.min(width - 1)]);
    for v in 0..height {
        for u in 0..width {
            let (z, right, below) = (at(u, v), at(u + 2, v), at(u, v + 2));
            if z == 0.0 || right == 0.0 || below == 0.0 {
                picture.rgb.extend([UNSEEN; 3]);
                continue;
            }
            // Slopes across two pixels; edges are no surface.
            let step = 2.0 * z / k.fx;
            let (dx, dy) = (((right - z) / step).clamp(-2.0, 2.0), ((below - z) / step).clamp(-2.0, 2.0));
            let facing = (1.0 + 0.35 * dy + 0.15 * dx) / (1.0 + dx * dx + dy * dy).sqrt();
            let light = (LIGHT * facing.clamp(0.15, 1.1)).min(255.0);
            picture.rgb.extend([1.0, 0.93, 0.86].map(|tone| (light * tone) as u8));
        }
    }
}
