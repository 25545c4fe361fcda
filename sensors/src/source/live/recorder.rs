//! Frames of a camera as they come, kept for a session: the same images as those of a file that the camera's own recorder would
//! have written.

use super::error::CameraError;
use super::frame_check::{CameraCounts, FrameCheck, FrameVerdict};
use super::live_camera::{CameraFrame, CameraInfo};
use crate::limits::MAX_DEPTH_FRAMES;
use crate::session::Session;
use crate::source::sequence::Sequence;

/// Collects frames.
pub struct CameraRecorder {
    sequence: Sequence,
    check: FrameCheck,
    device: String,
    taken: usize,
}

impl CameraRecorder {
    /// Of a camera.
    ///
    /// # Errors
    /// A camera whose lens cannot be straightened.
    pub fn new(info: &CameraInfo) -> Result<Self, CameraError> {
        let notes = vec![format!("recorded live from {}", info.device)];
        let sequence = Sequence::new(info.camera, notes)
            .map_err(|fault| CameraError::Recording(fault.at(&info.device).to_string()))?;
        let check = FrameCheck::new(info.sensor().pixels(), info.rate_hz);
        Ok(Self { sequence, check, device: info.device.clone(), taken: 0 })
    }

    /// Takes a frame that arrived then (ns); says whether it is kept: it is whole, new, shows something, and there is room for it.
    ///
    /// # Errors
    /// A recording that has grown too long.
    pub fn take(&mut self, frame: &CameraFrame, arrived_ns: u64) -> Result<bool, CameraError> {
        let FrameVerdict::Good(time_ns) = self.check.judge(frame, arrived_ns) else { return Ok(false) };
        if self.taken >= MAX_DEPTH_FRAMES {
            return Ok(false);
        }
        self.taken += 1;
        let samples = frame.depth.iter().copied();
        self.sequence
            .push(time_ns, samples)
            .map_err(|fault| CameraError::Recording(fault.at(&self.device).to_string()))?;
        Ok(true)
    }

    /// Frames that are kept.
    pub fn frames(&self) -> usize {
        self.taken
    }

    /// The counts.
    pub fn counts(&self) -> CameraCounts {
        self.check.counts
    }

    /// All of them as a session of this name.
    ///
    /// # Errors
    /// If nothing was seen.
    pub fn finish(self, name: &str) -> Result<Session, CameraError> {
        let told = |fault: crate::error::ReaderFault| CameraError::Recording(fault.at(&self.device).to_string());
        let mut session = self.sequence.finish().map_err(told)?;
        name.clone_into(&mut session.name);
        session.check().map_err(told)?;
        Ok(session)
    }
}
